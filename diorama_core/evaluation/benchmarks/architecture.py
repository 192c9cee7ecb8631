"""The empty room from rendered pictures: with true and noisy depth, as published, and from the picture alone."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from jaxtyping import Float32

from diorama_core.architecture.plainrecon.stage import PlainRecon
from diorama_core.architecture.rac.stage import RenderAndCompareRoom
from diorama_core.artefacts import Inputs
from diorama_core.errors import Cancelled
from diorama_core.evaluation.benchmarks.cases import LeftOut, make_views, recipe
from diorama_core.evaluation.metrics.architecture import ArchitectureScores, architecture_scores
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import Column, Row, Table, bootstrap_interval, paper_rows
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

log = logging.getLogger(__name__)


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
        noisy = replace(view.inputs, depth_m=sense(view.inputs.depth_m, case.seed))
        rows: tuple[tuple[str, Inputs, ArchitectureStage | None], ...] = (
            ("true masks and depth", view.inputs, None),
            ("true masks, depth with 2 % noise", noisy, None),
            ("PlainRecon as published, true masks and depth", view.inputs, PlainRecon()),
            ("PlainRecon as published, true masks, depth with 2 % noise", noisy, PlainRecon()),
            ("PlainRecon as published, depth of the empty room", _empty(view), PlainRecon()),
            ("RaC, true masks and depth", view.inputs, RenderAndCompareRoom()),
            ("RaC, true masks, depth with 2 % noise", noisy, RenderAndCompareRoom()),
            ("RaC without refinement, true masks and depth", view.inputs, RenderAndCompareRoom(refine=False)),
            ("RaC without refinement, true masks, depth with 2 % noise", noisy, RenderAndCompareRoom(refine=False)),
            ("ACDC, true masks and depth", view.inputs, PlainRecon(method=RoomMethod.ACDC)),
            ("ACDC, true masks, depth with 2 % noise", noisy, PlainRecon(method=RoomMethod.ACDC)),
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
    stages = embedded_stages(inputs, library)
    stage = stage or stages.architecture
    begun = time.process_time()
    try:
        artefacts = evaluate(stages, {"given": inputs}, ("objects", "supported_geometry"), Runner(None))
        geometry = artefacts["supported_geometry"]
        begun = time.process_time()
        room = stage.reconstruct(artefacts["inputs"], artefacts["objects"], geometry, Progress())
        spent = time.process_time() - begun
        scores = architecture_scores(
            room.architecture.planes, view.scene.architecture.planes, view.camera, found_camera=geometry.camera
        )
        return RoomResult(case, scores, spent)
    except Cancelled:
        raise
    except Exception as error:  # whatever goes wrong, the room counts as failed
        log.warning("%s failed: %s", case, error)
        return RoomResult(case, None, time.process_time() - begun)


def architecture_table(results: Sequence[tuple[str, Sequence[RoomResult]]]) -> Table:
    """IoU, pixel and edge error, depth error, centred chamfer and time (paper, table 3)."""
    columns = (
        Column("success", ".2f", "↑"), Column("IoU", ".1f", "↑"), Column("PE", ".1f", "↓"), Column("EE", ".1f", "↓"),
        Column("RMSE m", ".2f", "↓"), Column("CDb", ".3f", "↓"), Column("CDb seen", ".3f", "↓"),
        Column("time s", ".2f", "↓"),
    )  # fmt: skip
    rows = []
    for name, rooms in results:
        done = [r.scores for r in rooms if r.scores is not None]
        count = max(len(rooms), 1)
        rows.append(
            Row(
                name,
                (
                    len(done) / count,
                    100 * sum(s.iou for s in done) / count,
                    100 * (sum(s.pixel_error for s in done) + len(rooms) - len(done)) / count,
                    _mean([s.edge_error_px for s in done]),
                    _mean([s.depth_rmse_m for s in done]),
                    _mean([s.cdb_m for s in done]),
                    _mean([s.cdb_seen_m for s in done]),
                    _mean([r.seconds for r in rooms]),
                ),
                intervals=(
                    None,
                    bootstrap_interval([100 * r.scores.iou if r.scores else 0.0 for r in rooms]),
                    bootstrap_interval([100 * r.scores.pixel_error if r.scores else 100.0 for r in rooms]),
                    *(None,) * 5,
                ),
            )
        )
    note = (
        f"{len(results[0][1]) if results else 0} rooms. IoU and PE in percent of pixels, a failed room counting as "
        "0 and 100; EE in pixels of a picture 640 wide (the paper does not state its width); EE, RMSE and CDb over the "
        "rooms that succeeded. CDb compares the whole rooms, with what lies behind the camera; CDb seen what the "
        "picture shows of either. Time: processor seconds of the stage. In brackets the 90 % interval of the mean "
        "(bootstrap over rooms)."
    )
    published = {name: (*values[:-1], None, values[-1]) for name, values in paper.ARCHITECTURE.items()}
    return Table("Architecture", columns, (*rows, *paper_rows(published)), note)


def series_table(results: Sequence[tuple[str, Sequence[RoomResult]]]) -> Table:
    """IoU and PE by series of rooms: how much the choice of rooms decides."""
    seeds = sorted({r.seed for _, rooms in results for r in rooms})
    columns = tuple(Column(f"seed {seed}: {name}", ".1f") for seed in seeds for name in ("IoU", "PE"))
    rows = []
    for name, rooms in results:
        values: list[float | None] = []
        for seed in seeds:
            part = [r for r in rooms if r.seed == seed]
            values.append(_mean([100 * r.scores.iou if r.scores else 0.0 for r in part]))
            values.append(_mean([100 * r.scores.pixel_error if r.scores else 100.0 for r in part]))
        rows.append(Row(name, tuple(values)))
    return Table("Architecture by series of rooms", columns, tuple(rows))


def _mean(values: Sequence[float]) -> float | None:
    finite = [v for v in values if np.isfinite(v)]
    return float(np.mean(finite)) if finite else None
