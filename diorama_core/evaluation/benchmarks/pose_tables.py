"""The pose benchmark's tables, beside the paper's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diorama_core.evaluation.benchmarks.pose_comparison import PoseScores
from diorama_core.evaluation.benchmarks.retrieval import GROUPS
from diorama_core.evaluation.metrics.pose import pool
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import Column, Row, Table, mean, paper_rows

ObjectShares = tuple[float, ...]
"""Of one object's pairs with every other object: rotation, translation, scale and all right; and the object itself."""
Rooms = Mapping[str, Sequence[PoseScores]]
"""By name one entry per room."""
_SHARES = ("rAcc", "tAcc", "sAcc", "Acc")


def comparison_table(title: str, solvers: Rooms, published: paper.Rows | None = None) -> Table:
    """Alignment and collision of every solver before any layout (paper, table 5 and supplement).

    The paper's rows are alignment over pairs, collision and relation.
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
        for name, rooms in solvers.items()
    ]
    beside = {name: (*values[:4], *(None,) * 8, *values[4:6]) for name, values in (published or {}).items()}
    count = max(map(len, solvers.values()), default=0)
    note = (
        f"{count} rooms, true classes and masks. Mean over pairs; strict: against every other object; own: each object "
        "within 20 cm, 20 degrees and 20 % of its truth. Rotations count up to the true shape's symmetry. Collision: "
        "overlap of bounding boxes per object, over the rooms in which anything came out. Relation: true support edges "
        "whose parent and relation are right; all solvers have one graph, so only objects left out make a difference. "
        "The baselines use the embedded hand-made patch features at half resolution, not the networks of their "
        "publications."
    )
    return Table(title, columns, (*rows, *paper_rows(beside)), note)


def groups_table(groups: Mapping[str, Sequence[ObjectShares]], when: str = "before layout") -> Table:
    """Alignment by group of objects (paper, supplement, which has them after the layout)."""
    columns = (Column("instances", "d"), *(Column(n, better="↑") for n in _SHARES))
    rows = [Row(g, (len(groups[g]), *np.mean(groups[g], axis=0)[:4].tolist())) for g in GROUPS if g in groups]
    return Table(f"Groups, true depth, {when}, mean over pairs", columns, (*rows, *paper_rows(paper.GROUPS)))


def retrievals_table(true: Mapping[int, Sequence[PoseScores]], estimated: Mapping[int, Sequence[PoseScores]]) -> Table:
    """Alignment against the number of retrieved shapes, with true and estimated depth (paper, supplement)."""
    names = [f"{n} {d}" for d in ("true depth", "estimated") for n in _SHARES]
    rows = [
        Row(str(k), tuple(v for depth in (true, estimated) for v in pool([s.pairs for s in depth[k]]).shares))
        for k in true
    ]
    columns = tuple(Column(n, better="↑") for n in names)
    return Table("Shapes retrieved, mean over pairs", columns, (*rows, *paper_rows(paper.RETRIEVALS)))


def ablation_table(ablation: Rooms) -> Table:
    """Collision and structure by what of the optimiser runs (paper, table 6)."""
    return _layout_table("Optimiser ablation", {n: r for n, r in ablation.items() if n != "all-in-one"}, paper.ABLATION)


def all_in_one_table(ablation: Rooms) -> Table:
    """All costs at once against stage by stage (paper, supplement)."""
    names = {"all-in-one": "all-in-one", "O, P, S, R": "stage-wise", "feasible": "feasible"}
    rows = {names[n]: r for n, r in ablation.items() if n in names}
    return _layout_table("All-in-one against stage-wise", rows, paper.ALL_IN_ONE)


def _layout_table(title: str, rows: Rooms, published: paper.Rows) -> Table:
    columns = (
        Column("collision cm", ".2f", "↓"), Column("orientation", better="↑"), Column("placement", better="↑"),
        Column("overall", better="↑"),
    )  # fmt: skip
    keys = ("box_overlap_cm", "orientation", "placement", "structure")
    ours = [Row(name, tuple(mean(getattr(s, k) for s in rooms) for k in keys)) for name, rooms in rows.items()]
    return Table(title, columns, (*ours, *paper_rows(published)))


def category_table(groups: Mapping[str, Sequence[ObjectShares]]) -> Table:
    """Percent of objects aligned with their own truth, by Scan2CAD's categories (paper, supplement)."""
    right = [[100 * own for *_, own in groups.get(f"category: {c}", ())] for c in paper.CATEGORIES]
    each, instances = [mean(of_one) for of_one in right], mean(own for of_one in right for own in of_one)
    columns = tuple(Column(c, ".1f", "↑") for c in (*paper.CATEGORIES, "class mean", "instance mean"))
    rows = (Row("embedded, true depth and shapes", (*each, mean(each), instances)), *paper_rows(paper.BY_CATEGORY))
    note = (
        "Ours: rendered rooms with true depth, masks and shapes. The paper's rows: ScanNet25k photographs with a "
        "network's depth; they show the order of magnitude, not a ranking."
    )
    return Table("Alignment by category (20 cm, 20 degrees, 20 %)", columns, rows, note)
