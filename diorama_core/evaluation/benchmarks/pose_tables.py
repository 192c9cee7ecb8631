"""The pose benchmark's tables, beside the paper's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from diorama_core.evaluation.benchmarks.pose_comparison import PoseScores
from diorama_core.evaluation.benchmarks.retrieval import GROUPS
from diorama_core.evaluation.metrics.pose import pool
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import Column, Row, Table, mean, paper_rows


@dataclass(frozen=True)
class GroupCounts:
    """Right answers of one group of objects: pairs with every other object, averaged, and the object itself."""

    instances: int
    r: float
    t: float
    s: float
    every: float
    own: float


_SHARES = ("rAcc", "tAcc", "sAcc", "Acc")


def comparison_table(
    title: str, solvers: Sequence[tuple[str, Sequence[PoseScores]]], published: paper.Rows | None = None
) -> Table:
    """Alignment and collision of every solver before any layout (paper, table 5 and supplement).

    Args:
        title: What was given.
        solvers: (name, one entry per room).
        published: The paper's rows: alignment over pairs, collision, relation.
    """
    columns = (
        *(Column(n, better="↑") for n in _SHARES),
        *(Column(f"strict {n}", better="↑") for n in _SHARES),
        *(Column(f"own {n}", better="↑") for n in _SHARES),
        Column("collision cm", ".2f", "↓"),
        Column("relation", better="↑"),
    )
    rows = [
        Row(
            name,
            (
                *pool([s.pairs for s in rooms]).shares,
                *pool([s.every for s in rooms]).shares,
                *pool([s.own for s in rooms]).shares,
                mean(s.box_overlap_cm for s in rooms),
                mean(s.relation for s in rooms),
            ),
        )
        for name, rooms in solvers
    ]
    beside = {name: (*values[:4], *(None,) * 8, *values[4:6]) for name, values in (published or {}).items()}
    count = len(solvers[0][1]) if solvers else 0
    note = (
        f"{count} rooms, true classes and masks. Mean over pairs; strict: against every other object; own: each object "
        "within 20 cm, 20 degrees and 20 % of its truth. Rotations count up to the true shape's symmetry. Collision: "
        "overlap of bounding boxes per object, over the rooms in which anything came out. Relation: true support edges "
        "whose parent and relation are right; all solvers have one graph, so only objects left out make a difference. "
        "The baselines use the embedded hand-made patch features at half resolution, not the networks of their "
        "publications."
    )
    return Table(title, columns, (*rows, *paper_rows(beside)), note)


def groups_table(groups: Sequence[tuple[str, GroupCounts]], when: str = "before layout") -> Table:
    """Alignment by group of objects (paper, supplement, which has them after the layout)."""
    columns = (Column("instances", "d"), *(Column(n, better="↑") for n in _SHARES))
    known = dict(groups)
    rows = [Row(g, (c.instances, c.r, c.t, c.s, c.every)) for g in GROUPS if (c := known.get(g))]
    return Table(f"Groups, true depth, {when}, mean over pairs", columns, (*rows, *paper_rows(paper.GROUPS)))


def retrievals_table(
    retrievals: Sequence[tuple[int, Sequence[PoseScores], Sequence[PoseScores]]],
) -> Table:
    """Alignment against the number of retrieved shapes (paper, supplement)."""
    names = [f"{n} {d}" for d in ("true depth", "estimated") for n in _SHARES]
    rows = [
        Row(str(k), (*pool([s.pairs for s in a]).shares, *pool([s.pairs for s in b]).shares)) for k, a, b in retrievals
    ]
    columns = tuple(Column(n, better="↑") for n in names)
    return Table("Shapes retrieved, mean over pairs", columns, (*rows, *paper_rows(paper.RETRIEVALS)))


def ablation_table(ablation: Sequence[tuple[str, Sequence[PoseScores]]]) -> Table:
    """Collision and structure by what of the optimiser runs (paper, table 6)."""
    return _layout_table("Optimiser ablation", [(n, r) for n, r in ablation if n != "all-in-one"], paper.ABLATION)


def all_in_one_table(ablation: Sequence[tuple[str, Sequence[PoseScores]]]) -> Table:
    """All costs at once against stage by stage (paper, supplement)."""
    names = {"all-in-one": "all-in-one", "O, P, S, R": "stage-wise", "feasible": "feasible"}
    rows = [(names[n], r) for n, r in ablation if n in names]
    return _layout_table("All-in-one against stage-wise", rows, paper.ALL_IN_ONE)


def _layout_table(title: str, rows: Sequence[tuple[str, Sequence[PoseScores]]], published: paper.Rows) -> Table:
    columns = (
        Column("collision cm", ".2f", "↓"), Column("orientation", better="↑"), Column("placement", better="↑"),
        Column("overall", better="↑"),
    )  # fmt: skip
    keys = ("box_overlap_cm", "orientation", "placement", "structure")
    ours = [Row(name, tuple(mean(getattr(s, k) for s in rooms) for k in keys)) for name, rooms in rows]
    return Table(title, columns, (*ours, *paper_rows(published)))


def category_table(groups: Sequence[tuple[str, GroupCounts]]) -> Table:
    """Percent of objects aligned with their own truth, by Scan2CAD's categories (paper, supplement)."""
    known = dict(groups)
    counts = [known.get(f"category: {c}") for c in paper.CATEGORIES]
    present = [c for c in counts if c is not None]
    total = sum(c.instances for c in present)
    each = [None if c is None else 100 * c.own for c in counts]
    instances = 100 * sum(c.own * c.instances for c in present) / total if total else None
    columns = tuple(Column(c, ".1f", "↑") for c in (*paper.CATEGORIES, "class mean", "instance mean"))
    rows = (Row("embedded, true depth and shapes", (*each, mean(each), instances)), *paper_rows(paper.BY_CATEGORY))
    note = (
        "Ours: rendered rooms with true depth, masks and shapes. The paper's rows: ScanNet25k photographs with a "
        "network's depth; they show the order of magnitude, not a ranking."
    )
    return Table("Alignment by category (20 cm, 20 degrees, 20 %)", columns, rows, note)
