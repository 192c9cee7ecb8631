"""The empty room from rendered pictures: with true and noisy depth, as published, and from the picture alone."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from jaxtyping import Float32

from diorama_core.architecture.plainrecon.stage import PlainRecon
from diorama_core.architecture.rac.stage import RenderAndCompareRoom
from diorama_core.artefacts import Inputs
from diorama_core.evaluation.benchmarks.cases import LeftOut, attempt_one, make_views, recipe
from diorama_core.evaluation.metrics.architecture import ArchitectureScores, architecture_scores
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import Column, Figure, Row, Table, bootstrap_interval, figures_table, mean
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import ArchitectureStage
from diorama_core.provenance import RoomMethod
from diorama_core.synthesis.artefacts import photo_only
from diorama_core.synthesis.truth import TruthView

DEPTH_NOISE = 0.02
"""Relative, per pixel."""
BASELINE_STEPS = 8 * 580 * 0.075
"""A structured-light sensor's focal length in pixels times its baseline in metres, in eighths of a pixel."""


@dataclass(frozen=True)
class RoomResult:
    """One reconstructed room; None where the stage failed."""

    case: str
    scores: ArchitectureScores | None
    seconds: float
    seed: int = 0
    """Seed of the series of rooms that the case belongs to."""


@dataclass(frozen=True)
class ArchitectureBench:
    """Results by what was given."""

    seeds: tuple[int, ...]
    results: tuple[tuple[str, tuple[RoomResult, ...]], ...]
    left_out: tuple[LeftOut, ...] = ()

    def tables(self) -> tuple[Table, ...]:
        """The paper's architecture table, and with several series of rooms how far they differ."""
        tables = (architecture_table(self.results),)
        return (*tables, series_table(self.results)) if len(self.seeds) > 1 else tables

    def to_json(self) -> dict[str, object]:
        """Tables and every case."""
        cases = {name: [asdict(r) for r in rows] for name, rows in self.results}
        return {
            "bench": "architecture",
            "seeds": list(self.seeds),
            "tables": [t.to_json() for t in self.tables()],
            "cases": cases,
            "left_out": [asdict(r) for r in self.left_out],
        }


def run(
    library: ShapeLibrary, scenes: int = 20, seeds: Sequence[int] = (0,), progress: Progress = SILENT
) -> ArchitectureBench:
    """Reconstruct every room of every seed's series from what each row of the table is given.

    Args:
        library: where shapes come from.
        scenes: rooms of each series.
        seeds: one a series.
        progress: reports and cancellation.
    """
    results: dict[str, list[RoomResult]] = {}
    left_out: list[LeftOut] = []
    series = {case.name: seed for seed in seeds for case in recipe(scenes, 1, seed)}
    cases = tuple(case for seed in seeds for case in recipe(scenes, 1, seed))
    for k, (case, view) in enumerate(make_views(cases, library, left_out)):
        progress.report(k / len(cases), case.name)
        true, noisy = view.inputs, replace(view.inputs, depth_m=sense(view.inputs.depth_m, case.seed))
        depths = (("true masks and depth", true), ("true masks, depth with 2 % noise", noisy))
        published = (
            ("PlainRecon as published", PlainRecon(), (*depths, ("depth of the empty room", _empty(view)))),
            ("RaC", RenderAndCompareRoom(), depths),
            ("RaC without refinement", RenderAndCompareRoom(refine=False), depths),
            ("ACDC", PlainRecon(method=RoomMethod.ACDC), depths),
        )
        rows: tuple[tuple[str, Inputs, ArchitectureStage | None], ...] = (
            *((depth, inputs, None) for depth, inputs in depths),
            *((f"{name}, {depth}", inputs, stage) for name, stage, given in published for depth, inputs in given),
            ("picture and boxes", photo_only(view), None),
        )
        for name, inputs, stage in rows:
            result = _room(case.name, view, inputs, library, stage)
            results.setdefault(name, []).append(replace(result, seed=series[case.name]))
    by_name = tuple((name, tuple(rooms)) for name, rooms in results.items())
    return ArchitectureBench(tuple(seeds), by_name, tuple(left_out))


def sense(depth_m: Float32[np.ndarray, "h w"] | None, seed: int) -> Float32[np.ndarray, "h w"]:
    """True depth as a sensor would give it: relative noise at every pixel, and steps of disparity."""
    if depth_m is None:
        raise ValueError("there is no depth to add noise to")
    noise = np.random.default_rng(seed).standard_normal(depth_m.shape)
    depth = depth_m.astype(np.float64) * (1.0 + DEPTH_NOISE * noise)
    steps = np.round(BASELINE_STEPS / np.maximum(depth, 1e-6))
    return np.where(depth_m > 0, BASELINE_STEPS / np.maximum(steps, 1.0), 0.0).astype(np.float32)


def _empty(view: TruthView) -> Inputs:
    """What perfect inpainting and a perfect depth network would give PlainRecon: the room without its objects."""
    return replace(view.inputs, depth_m=view.room_depth_m, instances=None, instance_boxes=(), boxes=())


def _room(
    case: str, view: TruthView, inputs: Inputs, library: ShapeLibrary, stage: ArchitectureStage | None
) -> RoomResult:
    begun = time.process_time()

    def score() -> RoomResult:
        nonlocal begun
        stages = embedded_stages(inputs, library)
        found = evaluate(stages, {"given": inputs}, ("objects", "supported_geometry"), Runner(None))
        geometry = found["supported_geometry"]
        begun = time.process_time()
        room = (stage or stages.architecture).reconstruct(found["inputs"], found["objects"], geometry, Progress())
        spent = time.process_time() - begun
        planes, true = room.architecture.planes, view.scene.architecture.planes
        return RoomResult(case, architecture_scores(planes, true, view.camera, found_camera=geometry.camera), spent)

    result, _ = attempt_one(case, score)
    return result or RoomResult(case, None, time.process_time() - begun)


def _ious(rooms: Sequence[RoomResult]) -> list[float]:
    """In percent; a room that failed counts as 0."""
    return [100 * r.scores.iou if r.scores else 0.0 for r in rooms]


def _pixel_errors(rooms: Sequence[RoomResult]) -> list[float]:
    """In percent; a room that failed counts as 100."""
    return [100 * r.scores.pixel_error if r.scores else 100.0 for r in rooms]


def _mean_score(name: str) -> Callable[[Sequence[RoomResult]], float | None]:
    return lambda rooms: mean(getattr(r.scores, name) for r in rooms if r.scores is not None)


FIGURES = (
    Figure(Column("success", ".2f", "↑"), lambda rooms: mean(float(r.scores is not None) for r in rooms)),
    Figure(Column("IoU", ".1f", "↑"), lambda rooms: mean(_ious(rooms)), lambda rooms: bootstrap_interval(_ious(rooms))),
    Figure(
        Column("PE", ".1f", "↓"),
        lambda rooms: mean(_pixel_errors(rooms)),
        lambda rooms: bootstrap_interval(_pixel_errors(rooms)),
    ),
    Figure(Column("EE", ".1f", "↓"), _mean_score("edge_error_px")),
    Figure(Column("RMSE m", ".2f", "↓"), _mean_score("depth_rmse_m")),
    Figure(Column("CDb", ".3f", "↓"), _mean_score("cdb_m")),
    Figure(Column("CDb seen", ".3f", "↓"), _mean_score("cdb_seen_m")),
    Figure(Column("time s", ".2f", "↓"), lambda rooms: mean(r.seconds for r in rooms)),
)


def architecture_table(results: Sequence[tuple[str, Sequence[RoomResult]]]) -> Table:
    """IoU, pixel and edge error, depth error, centred chamfer and time (paper, table 3)."""
    note = (
        f"{len(results[0][1]) if results else 0} rooms. IoU and PE in percent of pixels, a failed room counting as "
        "0 and 100; EE in pixels of a picture 640 wide (the paper does not state its width); EE, RMSE and CDb over the "
        "rooms that succeeded. CDb compares the whole rooms, with what lies behind the camera; CDb seen what the "
        "picture shows of either. Time: processor seconds of the stage. In brackets the 90 % interval of the mean "
        "(bootstrap over rooms)."
    )
    published = {name: (*values[:-1], None, values[-1]) for name, values in paper.ARCHITECTURE.items()}
    return figures_table("Architecture", results, FIGURES, note, published)


def series_table(results: Sequence[tuple[str, Sequence[RoomResult]]]) -> Table:
    """IoU and PE by series of rooms: how much the choice of rooms decides."""
    seeds = sorted({r.seed for _, rooms in results for r in rooms})
    columns = tuple(Column(f"seed {seed}: {name}", ".1f") for seed in seeds for name in ("IoU", "PE"))
    rows = []
    for name, rooms in results:
        values: list[float | None] = []
        for seed in seeds:
            part = [r for r in rooms if r.seed == seed]
            values += [mean(_ious(part)), mean(_pixel_errors(part))]
        rows.append(Row(name, tuple(values)))
    return Table("Architecture by series of rooms", columns, tuple(rows))
