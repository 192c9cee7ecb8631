"""The system benchmark's tables: alignment beside the paper's, scenes, before and after layout, substitutions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.evaluation.metrics.pose import Alignment, pool
from diorama_core.evaluation.metrics.scene import SceneScores
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import (
    Column,
    Interval,
    Row,
    Table,
    Value,
    bootstrap_interval,
    mean,
    paper_rows,
)


@dataclass(frozen=True)
class CaseResult:
    """One build."""

    case: str
    scores: SceneScores
    seconds: float
    """Processor time of the build."""
    wall_s: float
    failure: str = ""
    """Why the prediction failed."""
    before: SceneScores | None = None
    """Scores of the build before the layout optimiser; None where it failed."""
    seed: int = 0
    """Seed of the series of rooms that the case belongs to."""


Results = Sequence[tuple[str, Sequence[CaseResult]]]
"""(what was given, one result per room)."""

_INTERVALS = "In brackets the 90 % interval of the mean (bootstrap over rooms)."
_ALIGNED = (
    ("mean over pairs", "pairs"),
    ("mean over pairs, symmetry ignored", "headed"),
    ("mean over pairs, size right along each axis", "each_axis"),
    ("against every other", "every"),
)
"""Rows of the system table: its name and the field of `SceneScores`."""


def system_table(results: Results, *, offered: bool = False) -> Table:
    """Alignment, chamfer distance, failures and time (paper, table 2)."""
    columns = (
        Column("rAcc", better="↑"), Column("tAcc", better="↑"), Column("sAcc", better="↑"), Column("Acc", better="↑"),
        Column("CD", ".1f", "↓"), Column("failed", "d", "↓"), Column("time s", ".1f", "↓"),
    )  # fmt: skip
    rows = []
    for name, cases in results:
        tail: tuple[Value, ...] = (
            mean([c.scores.shape_distance for c in cases]),
            sum(bool(c.failure) for c in cases),
            mean([c.seconds for c in cases]),
        )
        for reading, key in _ALIGNED:
            alignments: list[Alignment] = [getattr(c.scores, key) for c in cases]
            spans = (None, None, None, _acc_interval(alignments), None, None, None)
            rows.append(Row(f"{name}, {reading}", (*pool(alignments).shares, *tail), intervals=spans))
    note = (
        f"{len(results[0][1]) if results else 0} rooms; their own shapes are {'' if offered else 'not '}in the library "
        "searched. Scenes that fail count as wrong in every share. Rotations count up to the true shape's symmetry "
        "(round and square objects, half of all, are nearly always right), but for the row that ignores it. Sizes of "
        "pairs are compared in both orders. CD: squared chamfer of normalised shapes, both ways added, x 1000, over "
        f"the objects found. Time: processor seconds a scene. {_INTERVALS} The paper's rows have a network's depth and "
        "boxes found by a detector; ours are given boxes and classes, and where a row says so true masks and depth."
    )
    return Table("System", columns, (*rows, *paper_rows(paper.SYSTEM)), note)


_SCENE = (
    (Column("kind", better="↑"), "kind"),
    (Column("relation", better="↑"), "relation"),
    (Column("structure", better="↑"), "structure"),
    (Column("boxes cm", ".2f", "↓"), "box_overlap_cm"),
    (Column("meshes l", ".2f", "↓"), "mesh_overlap_l"),
    (Column("supported", better="↑"), "supported"),
    (Column("truly supported", better="↑"), "truly_supported"),
    (Column("out of bounds", better="↓"), "out_of_bounds"),
    (Column("stable", better="↑"), "stable"),
    (Column("drift cm", ".1f", "↓"), "drift_cm"),
    (Column("image IoU", better="↑"), "image_iou"),
    (Column("chamfer cm", ".1f", "↓"), "chamfer_cm"),
    (Column("F@10 cm", better="↑"), "f_score"),
)
"""Columns of the scene table and the fields of `SceneScores`."""


def scene_table(results: Results) -> Table:
    """What the paper does not measure, or measures elsewhere; every way before and after the layout."""
    columns = (Column("own Acc", better="↑"), Column("height off", ".2f", "↓"), *(c for c, _ in _SCENE))
    rows = []
    for name, cases in results:
        before = [c.before or SceneScores.failure(c.scores.asked) for c in cases]
        if any(c.before is not None for c in cases):
            rows.append(_scene_row(f"{name}, before layout", before))
        rows.append(_scene_row(name, [c.scores for c in cases]))
    note = (
        "own Acc: each object within 20 cm, 20 degrees and 20 % of its truth, which is the only share here that knows "
        "where objects should be. kind: share of objects whose shape is of the true kind. height off: median "
        "error of the camera's height, as a share. structure and supported "
        "are measured against the scene's own graph and say that it is consistent, not that it is true; relation and "
        "truly supported are measured against the true graph. meshes: litres that meshes share although neither "
        "carries the other. Overlaps, chamfer and F are means over the rooms in which anything came out. out of bounds "
        "as SceneEval, over the scene's own floor; stable and drift: two seconds of gravity (with --physics). chamfer "
        f"(not squared, the mean of both ways) and F: surfaces of all objects, in the true camera's world. {_INTERVALS}"
    )
    return Table("Scenes", columns, tuple(rows), note)


def _scene_row(name: str, scores: Sequence[SceneScores]) -> Row:
    alignments = [s.own for s in scores]
    spans: dict[str, Interval | None] = {
        key: bootstrap_interval([getattr(s, key) for s in scores]) for key in ("image_iou", "chamfer_cm")
    }
    return Row(
        name,
        (pool(alignments).acc, _median_off(scores), *(mean(getattr(s, key) for s in scores) for _, key in _SCENE)),
        intervals=(
            _acc_interval(alignments),
            None,
            *(spans.get(key) for _, key in _SCENE),
        ),
    )


def substitution_table(results: Results) -> Table:
    """Own Acc, chamfer and picture with the truth in place of one input at a time."""
    columns = tuple(
        Column(f"{name} {when}", form, better)
        for name, form, better in (("own Acc", ".2f", "↑"), ("chamfer cm", ".1f", "↓"), ("image IoU", ".2f", "↑"))
        for when in ("before", "after")
    )
    rows = []
    for name, cases in results:
        scores = ([c.before or SceneScores.failure(c.scores.asked) for c in cases], [c.scores for c in cases])
        alignments = [[s.own for s in part] for part in scores]
        others = (mean(getattr(s, k) for s in part) for k in ("chamfer_cm", "image_iou") for part in scores)
        spans = (*map(_acc_interval, alignments), *(None,) * 4)
        rows.append(Row(name, (*(pool(o).acc for o in alignments), *others), intervals=spans))
    note = f"Before and after layout. {_INTERVALS}"
    return Table("The truth in place of one input", columns, tuple(rows), note)


def series_table(results: Results) -> Table:
    """Own Acc and chamfer by series of rooms: how much the choice of rooms decides."""
    seeds = sorted({c.seed for _, cases in results for c in cases})
    columns = tuple(Column(f"seed {s}: {n}", f) for s in seeds for n, f in (("own Acc", ".2f"), ("chamfer cm", ".1f")))
    rows = []
    for name, cases in results:
        values: list[Value] = []
        for seed in seeds:
            part = [c.scores for c in cases if c.seed == seed]
            values += [pool([s.own for s in part]).acc if part else None, mean([s.chamfer_cm for s in part])]
        rows.append(Row(name, tuple(values)))
    return Table("By series of rooms", columns, tuple(rows))


def _acc_interval(alignments: Sequence[Alignment]) -> Interval | None:
    return bootstrap_interval([a.acc for a in alignments], [a.count for a in alignments])


def _median_off(scores: Sequence[SceneScores]) -> float | None:
    known = [abs(s.height_off) for s in scores if s.height_off is not None]
    return float(np.median(known)) if known else None
