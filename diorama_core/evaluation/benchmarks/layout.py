"""The layout recipes measured on generated rooms: the paper's ablation, wrong graphs, noise, size and time."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from diorama_core.errors import UnavailableError
from diorama_core.evaluation.speed.eager import our_seconds, pair_by_pair_seconds
from diorama_core.layout.exact import drift, mesh_overlap_m3, stable_share
from diorama_core.layout.feasible.local import DragSolver
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.published.recipes import AllInOneRecipe, PaperRecipe, one_thread
from diorama_core.layout.recipes import recipe
from diorama_core.layout.report import measure
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import LayoutStage
from diorama_core.scene.types import Pose, Scene
from diorama_core.synthesis.layout_rooms import GeneratedRoom, Noise, box_library, generate_room, perturb_graph

ROOM = 20
"""Objects in the rooms of the ablation."""


@dataclass(frozen=True)
class LayoutRow:
    """Means over rooms of one way of arranging them."""

    name: str
    rooms: int
    orientation: float
    placement: float
    structure: float
    in_support: float
    box_overlap_cm: float
    """Overlap of bounding boxes per object."""
    part_overlap_mm: float
    """Deepest overlap of convex parts, mean over rooms."""
    mesh_overlap_share: float
    """Volume shared by meshes, as a share of what it was before."""
    stable: float | None
    """Share of objects that stay put under gravity; None without MuJoCo."""
    offset_cm: float
    """Mean distance from the truth."""
    median_ms: float
    p95_ms: float
    """Processor time of the whole call."""


@dataclass(frozen=True)
class LayoutBench:
    """All tables of one run."""

    seed: int
    ablation: tuple[LayoutRow, ...]
    wrong_graph: tuple[LayoutRow, ...]
    """A tenth of the support edges wrong or missing."""
    noise: tuple[LayoutRow, ...]
    times: tuple[tuple[str, int, float, float], ...]
    """(what, objects, median ms, p95 ms)."""
    growth_exponent: float
    """Exponent of the paper recipe's time from 20 to 200 objects."""
    refinement_speedup: float
    """Stage 4 against a loop over pairs, per step, at 20 objects."""

    def to_json(self) -> dict[str, object]:
        """Plain values for JSON."""
        return asdict(self)

    def to_markdown(self) -> str:
        """The tables for people."""
        parts = [
            _table(f"Ablation: {ROOM} objects, true support graph", self.ablation),
            _table("A tenth of the support edges wrong or missing", self.wrong_graph),
            _table("Noise of observation", self.noise),
            "## Processor time\n\n| what | objects | median ms | p95 ms |\n|---|---|---|---|\n"
            + "\n".join(f"| {what} | {n} | {a:.1f} | {b:.1f} |" for what, n, a, b in self.times),
            f"The paper recipe's time grows with exponent {self.growth_exponent:.2f} from 20 to 200 objects.\n"
            f"A step of its stage 4 is {self.refinement_speedup:.0f} times faster than a loop over pairs.",
        ]
        return "\n\n".join(parts) + "\n"


def _table(title: str, rows: Sequence[LayoutRow]) -> str:
    head = (
        "| recipe | orientation | placement | overall | in support | boxes cm | parts mm | meshes | stable | offset cm "
        "| median ms | p95 ms |\n|---|---|---|---|---|---|---|---|---|---|---|---|"
    )
    lines = [
        f"| {r.name} | {r.orientation:.3f} | {r.placement:.3f} | {r.structure:.3f} | {r.in_support:.3f} "
        f"| {r.box_overlap_cm:.2f} | {r.part_overlap_mm:.2f} | {r.mesh_overlap_share:.1%} "
        f"| {'' if r.stable is None else f'{r.stable:.3f}'} | {r.offset_cm:.1f} | {r.median_ms:.0f} | {r.p95_ms:.0f} |"
        for r in rows
    ]
    return "\n".join([f"## {title} ({rows[0].rooms if rows else 0} rooms)", "", head, *lines])


def run(scenes: int = 40, seed: int = 0, progress: Progress = SILENT) -> LayoutBench:
    """Measure everything. Deterministic but for the times.

    Args:
        scenes: rooms per row (all-in-one, which is slow, gets a quarter).
        seed: of the rooms.
        progress: reports, and cancels between rooms.
    """
    library = box_library()
    rooms = [generate_room(seed + k, ROOM) for k in range(scenes)]
    few = rooms[: max(scenes // 4, 1)]
    feasible, paper = recipe("feasible", library), recipe("paper", library)
    feasible.optimise(rooms[0].observed, Progress())
    stage_names = ("O", "O, P", "O, P, S", "O, P, S, R (paper)")
    with one_thread():
        ablation = [_row("observed", None, rooms, progress.part(0.0, 0.05))]
        for k, name in enumerate(stage_names):
            stages = PaperRecipe(library, stages=k + 1)
            ablation.append(_row(name, stages, rooms, progress.part(0.05 + 0.1 * k, 0.15 + 0.1 * k)))
        ablation.append(_row("all-in-one", AllInOneRecipe(library), few, progress.part(0.45, 0.55)))
        ablation.append(_row("feasible", feasible, rooms, progress.part(0.55, 0.65)))
        wrong = [
            _row(name, stage, [_misread(r, seed + k) for k, r in enumerate(rooms)], progress.part(a, a + 0.08))
            for name, stage, a in (("paper", paper, 0.65), ("feasible", feasible, 0.73))
        ]
        noise = [
            _row(
                f"feasible, noise x{factor:g}",
                feasible,
                [generate_room(seed + k, ROOM, Noise().times(factor)) for k in range(len(few))],
                progress.part(0.81, 0.85),
            )
            for factor in (0.5, 1.0, 2.0)
        ]
        times, exponent = _times(seed, feasible, paper, max(scenes // 8, 2), progress.part(0.85, 1.0))
        one = build_problem(rooms[0].observed, library)
        speedup = pair_by_pair_seconds(one) / our_seconds(one)
    return LayoutBench(seed, tuple(ablation), tuple(wrong), tuple(noise), tuple(times), exponent, speedup)


def _misread(room: GeneratedRoom, seed: int) -> GeneratedRoom:
    return GeneratedRoom(room.truth, perturb_graph(room.observed, 0.1, seed))


def _row(name: str, stage: LayoutStage | None, rooms: Sequence[GeneratedRoom], progress: Progress) -> LayoutRow:
    library = box_library()
    measured, seconds, offsets, stable = [], [], [], []
    overlap_before = overlap_after = 0.0
    for k, room in enumerate(rooms):
        progress.report(k / len(rooms), f"{name}, room {k + 1}")
        begun = time.thread_time()
        scene = room.observed if stage is None else stage.optimise(room.observed, Progress())[0]
        seconds.append(time.thread_time() - begun)
        problem = build_problem(room.observed, library)
        measured.append(measure(problem, problem.with_poses_of(scene)))
        offsets.append(offset_m(room.truth, scene))
        overlap_before += mesh_overlap_m3(room.observed, library)
        overlap_after += mesh_overlap_m3(scene, library)
        stable.append(_stable(scene))
    mean = {key: float(np.mean([m[key] for m in measured])) for key in measured[0]}
    known = [s for s in stable if s is not None]
    return LayoutRow(
        name=name,
        rooms=len(rooms),
        orientation=mean["orientation"],
        placement=mean["placement"],
        structure=mean["structure"],
        in_support=mean["in_support"],
        box_overlap_cm=100 * mean["box_overlap_m"],
        part_overlap_mm=1000 * mean["part_overlap_m"],
        mesh_overlap_share=overlap_after / overlap_before if overlap_before > 0 else 0.0,
        stable=float(np.mean(known)) if known else None,
        offset_cm=100 * float(np.mean(offsets)),
        median_ms=1000 * float(np.median(seconds)),
        p95_ms=1000 * float(np.percentile(seconds, 95)),
    )


def _stable(scene: Scene) -> float | None:
    try:
        return stable_share(drift(scene, box_library()))
    except UnavailableError:
        return None


def offset_m(truth: Scene, scene: Scene) -> float:
    """Mean distance of the objects from where they truly are."""
    gaps = [np.linalg.norm(scene.object(o.id).pose.position - o.pose.position) for o in truth.objects]
    return float(np.mean(gaps)) if gaps else 0.0


def _times(
    seed: int, feasible: LayoutStage, paper: LayoutStage, repeats: int, progress: Progress
) -> tuple[list[tuple[str, int, float, float]], float]:
    rows: list[tuple[str, int, float, float]] = []
    paper_ms: dict[int, float] = {}
    for k, count in enumerate((10, 20, 50, 100, 200)):
        progress.report(k / 5, f"time at {count} objects")
        scenes = [generate_room(seed + 500 + r, count).observed for r in range(repeats)]
        rows.append(("feasible", count, *_milliseconds([_call(feasible, s) for s in scenes])))
        if count in (20, 200):
            spent = _milliseconds([_call(paper, s) for s in scenes])
            paper_ms[count] = spent[0]
            rows.append(("paper", count, *spent))
    rows.append(("drag", 50, *_milliseconds(_drags(seed, feasible))))
    return rows, float(np.log(paper_ms[200] / paper_ms[20]) / np.log(10.0))


def _call(stage: LayoutStage, scene: Scene) -> Callable[[], object]:
    return lambda: stage.optimise(scene, Progress())


def _milliseconds(calls: Sequence[Callable[[], object]]) -> tuple[float, float]:
    spent = []
    for call in calls:
        begun = time.thread_time()
        call()
        spent.append(1000 * (time.thread_time() - begun))
    return float(np.median(spent)), float(np.percentile(spent, 95))


def _drags(seed: int, feasible: LayoutStage) -> list[Callable[[], object]]:
    library = box_library()
    scene = feasible.optimise(generate_room(seed + 900, 50).observed, Progress())[0]
    rng = np.random.default_rng(seed)

    def step(solver: DragSolver, pose: Pose) -> Callable[[], object]:
        return lambda: solver.solve(pose)

    calls = []
    for item in scene.objects[::5]:
        solver = DragSolver.prepare(scene, library, item.id)
        calls += [step(solver, item.pose.move(rng.normal(0.0, 0.2, 3) * [1.0, 1.0, 0.1])) for _ in range(6)]
    return calls
