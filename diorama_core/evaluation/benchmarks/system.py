"""The whole system on rendered rooms: from a picture with true masks and depth, and from the picture alone.

As in the paper, the shapes that stand in the rooms are not in the library that is searched, unless asked for.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from diorama_core.artefacts import Inputs
from diorama_core.errors import Cancelled
from diorama_core.evaluation.benchmarks.cases import Case, recipe, views_of
from diorama_core.evaluation.metrics.pose import pooled
from diorama_core.evaluation.metrics.scene import SceneScores, scene_scores
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import Column, Row, Table, paper_rows
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.run import Built, build_scene
from diorama_core.progress import Progress
from diorama_core.synthesis.artefacts import photo_only
from diorama_core.synthesis.splits import split_library
from diorama_core.synthesis.truth import TruthView

log = logging.getLogger(__name__)

TRUE_INPUTS = "true masks and depth"
PHOTO_ALONE = "embedded perception"
Show = Callable[[str, TruthView, tuple[Built | None, ...]], None]


@dataclass(frozen=True)
class CaseResult:
    """One build."""

    case: str
    scores: SceneScores
    seconds: float
    """Processor time of the build."""
    wall_s: float
    failure: str = ""
    """Why nothing came out."""


@dataclass(frozen=True)
class SystemBench:
    """Results of both ways."""

    seed: int
    offered: bool
    """Whether the rooms' own shapes were among those searched."""
    results: tuple[tuple[str, tuple[CaseResult, ...]], ...]
    """(what was given, one result per case)."""

    def tables(self) -> tuple[Table, ...]:
        """The paper's system table, and what it does not measure."""
        return system_table(self.results, offered=self.offered), scene_table(self.results)

    def to_json(self) -> dict[str, object]:
        """Tables and every case."""
        cases = {name: [asdict(r) for r in rows] for name, rows in self.results}
        tables = [t.to_json() for t in self.tables()]
        return {"bench": "system", "seed": self.seed, "offered": self.offered, "tables": tables, "cases": cases}


def run(
    library: ShapeLibrary,
    scenes: int = 20,
    seed: int = 0,
    progress: Progress | None = None,
    *,
    offered: bool = False,
    physics: bool = False,
    show: Show | None = None,
) -> SystemBench:
    """Build every room twice. A build that fails counts as a scene in which everything is wrong.

    Args:
        library: rooms are furnished from its test shapes; the others are searched.
        scenes: rooms, one picture each.
        seed: of the rooms.
        progress: reports, and cancels between builds.
        offered: search the whole library, the rooms' own shapes among it.
        physics: whether to measure drift under gravity as well.
        show: called with every case's name, photo, and the results of both ways (None where one failed).
    """
    progress = progress or Progress()
    tested = split_library(library, "test")
    searched = library if offered else split_library(library, "train", "validation")
    ways = {TRUE_INPUTS: list[CaseResult](), PHOTO_ALONE: list[CaseResult]()}
    cases = recipe(scenes, 1, seed)
    for k, (case, view) in enumerate(views_of(cases, tested)):
        results: list[Built | None] = []
        for turn, (name, inputs) in enumerate(((TRUE_INPUTS, view.inputs), (PHOTO_ALONE, photo_only(view)))):
            progress.report((k + turn / 2) / len(cases), f"{case.name}: {name}")
            built, result = build_case(case, view, inputs, library, searched, progress, physics=physics)
            ways[name].append(result)
            results.append(built)
        if show is not None:
            show(case.name, view, tuple(results))
    progress.report(1.0, "done")
    return SystemBench(seed, offered, tuple((name, tuple(results)) for name, results in ways.items()))


def build_case(
    case: Case,
    view: TruthView,
    inputs: Inputs,
    library: ShapeLibrary,
    searched: ShapeLibrary,
    progress: Progress,
    *,
    physics: bool = False,
) -> tuple[Built | None, CaseResult]:
    """Build one scene from what is searched and score it with the library that knows the truth's shapes too."""
    begun, wall = time.process_time(), time.perf_counter()

    def result(scores: SceneScores, failure: str = "") -> CaseResult:
        return CaseResult(case.name, scores, spent, waited, failure)

    try:
        built = build_scene(inputs, searched, progress=Progress(token=progress.token))
        spent, waited = time.process_time() - begun, time.perf_counter() - wall
        scores = scene_scores(view, built.scene, library, physics=physics)
        return built, result(scores, "" if built.scene.objects else "no object came out")
    except Cancelled:
        raise
    except Exception as error:  # whatever goes wrong, the scene counts as failed
        log.warning("%s failed: %s", case.name, error)
        spent, waited = time.process_time() - begun, time.perf_counter() - wall
        return None, result(SceneScores.failed(len(view.asked)), f"{type(error).__name__}: {error}")


def system_table(results: Sequence[tuple[str, Sequence[CaseResult]]], *, offered: bool = False) -> Table:
    """Alignment, chamfer distance, failures and time (paper, table 2)."""
    columns = (
        Column("rAcc", better="↑"), Column("tAcc", better="↑"), Column("sAcc", better="↑"), Column("Acc", better="↑"),
        Column("CD", ".1f", "↓"), Column("failed", "d", "↓"), Column("time s", ".1f", "↓"),
    )  # fmt: skip
    rows = []
    for name, cases in results:
        pairs, every = (pooled([getattr(c.scores, kind) for c in cases]) for kind in ("pairs", "every"))
        tail = (
            _mean([c.scores.shape_distance for c in cases]),
            sum(bool(c.failure) for c in cases),
            _mean([c.seconds for c in cases]),
        )
        rows.append(Row(f"{name}, mean over pairs", (pairs.r_acc, pairs.t_acc, pairs.s_acc, pairs.acc, *tail)))
        rows.append(Row(f"{name}, against every other", (every.r_acc, every.t_acc, every.s_acc, every.acc, *tail)))
    note = (
        f"{len(results[0][1]) if results else 0} rooms; their own shapes are {'' if offered else 'not '}in the library "
        "searched. Scenes that fail count as wrong in every share. CD: chamfer of normalised shapes x 1000, over the "
        "objects found. Time: processor seconds a scene."
    )
    return Table("System", columns, (*rows, *paper_rows(paper.SYSTEM)), note)


def scene_table(results: Sequence[tuple[str, Sequence[CaseResult]]]) -> Table:
    """What the paper does not measure, or measures elsewhere."""
    columns = (
        Column("found", ".2f", "↑"), Column("own Acc", better="↑"), Column("relation", better="↑"),
        Column("structure", better="↑"), Column("boxes cm", ".2f", "↓"), Column("meshes l", ".2f", "↓"),
        Column("supported", better="↑"), Column("out of bounds", better="↓"), Column("stable", better="↑"),
        Column("drift cm", ".1f", "↓"), Column("image IoU", better="↑"), Column("chamfer cm", ".1f", "↓"),
        Column("F@10 cm", better="↑"),
    )  # fmt: skip
    rows = []
    for name, cases in results:
        s = [c.scores for c in cases]
        asked = max(sum(x.asked for x in s), 1)
        own = pooled([x.own for x in s])
        rows.append(
            Row(
                name,
                (
                    sum(x.found for x in s) / asked,
                    own.acc,
                    *(_mean([getattr(x, key) for x in s]) for key in _SCENE_KEYS),
                ),
            )
        )
    note = (
        "own Acc: each object within 20 cm, 20 degrees and 20 % of its truth. meshes: litres that meshes share "
        "although neither holds the other up. supported and out of bounds as SceneEval; stable and drift: two seconds "
        "of gravity (with --physics). chamfer and F: surfaces of all objects, in the true camera's world."
    )
    return Table("Scenes", columns, tuple(rows), note)


_SCENE_KEYS = (
    "relation",
    "structure",
    "box_overlap_cm",
    "mesh_overlap_l",
    "supported",
    "out_of_bounds",
    "stable",
    "drift_cm",
    "image_iou",
    "chamfer_cm",
    "f_score",
)


def _mean(values: Sequence[float | None]) -> float | None:
    known = [v for v in values if v is not None]
    return float(np.mean(known)) if known else None


def without_times(bench: SystemBench) -> SystemBench:
    """The same results with all times 0: what must be equal for equal seeds."""
    return replace(
        bench, results=tuple((n, tuple(replace(r, seconds=0.0, wall_s=0.0) for r in rows)) for n, rows in bench.results)
    )
