"""The published recipes: the paper's four stages, and its all-in-one ablation."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
import torch

from diorama_core.artefacts import LayoutReport
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.layout.gradients import candidate_pairs
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.problem.volumes import Volumes, contact_templates
from diorama_core.layout.published import costs, staged
from diorama_core.layout.published.staged import Edges, Report, StageSchedule, State
from diorama_core.layout.report import measure
from diorama_core.layout.settings import AS_IT_IS, Weights
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.protocols import Preview
from diorama_core.scene import edits
from diorama_core.scene.types import Scene

PUBLISHED = StageSchedule()
TOGETHER = StageSchedule(steps=400, decay_every=100)


@dataclass(frozen=True)
class PaperRecipe:
    """Orientation, placement, space, refinement: each its own parameters, costs and steps."""

    library: ShapeLibrary
    only: frozenset[str] | None = None
    """Ids free to move (with what they hold up); all when None."""
    schedule: StageSchedule = PUBLISHED
    stages: int = 4
    """How many of the four stages to run, for the ablation."""
    adherence_m: float = 0.1
    """Objects on the floor nearer to a wall than this are drawn to it."""
    weights: Weights = AS_IT_IS

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        """Run the stages; raises `Cancelled` when asked to stop.

        Args:
            scene: as observed.
            progress: reports and cancellation.
            preview: called with the layout as it becomes.
        """
        begun = time.perf_counter()
        problem = build_problem(scene, self.library, only=self.only, adherence_m=self.adherence_m)
        state = State(problem.R.copy(), problem.p.copy(), problem.scale.copy())
        report = _reporter(scene, problem, progress, preview, self.schedule.steps * self.stages)
        stages = (staged.orientation_stage, staged.placement_stage, staged.space_stage, staged.refinement_stage)
        for stage in stages[: self.stages]:
            if problem.count:
                stage(problem, state, self.schedule, report, weights=self.weights)
        return _place_and_report("paper", scene, problem, state, begun)


@dataclass(frozen=True)
class AllInOneRecipe:
    """Every term at once, over rotation, position and scale together (torch, one thread)."""

    library: ShapeLibrary
    only: frozenset[str] | None = None
    """Ids free to move (with what they hold up); all when None."""
    schedule: StageSchedule = TOGETHER
    adherence_m: float = 0.1
    """Objects on the floor nearer to a wall than this are drawn to it."""
    weights: Weights = AS_IT_IS

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        """Run the steps; raises `Cancelled` when asked to stop.

        Args:
            scene: as observed.
            progress: reports and cancellation.
            preview: called with the layout as it becomes.
        """
        begun = time.perf_counter()
        problem = build_problem(scene, self.library, only=self.only, adherence_m=self.adherence_m)
        state = State(problem.R.copy(), problem.p.copy(), problem.scale.copy())
        if problem.count:
            report = _reporter(scene, problem, progress, preview, self.schedule.steps)
            with one_thread():
                _all_at_once(problem, state, self.schedule, self.weights, report)
        return _place_and_report("all-in-one", scene, problem, state, begun)


@contextmanager
def one_thread() -> Iterator[None]:
    """Small tensors lose from threads: pin torch to one, and give back what was set."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def _reporter(scene: Scene, problem: Problem, progress: Progress, preview: Preview | None, total: int) -> Report:
    done = 0

    def report(stage: str, step: int, state: State, terms: Mapping[str, float]) -> None:
        """Report a step of the optimiser, and every tenth one's scene to the preview.

        Args:
            stage: name of the stage, for the message.
            step: number of the step within it, from 0.
            state: poses of all objects.
            terms: costs by name.
        """
        nonlocal done
        done += 1
        progress.check()
        if step % 10 == 0:
            progress.report(done / total, f"{stage}, step {step + 1}")
            if preview is not None:
                poses = problem.poses(staged.orthonormal(state.R), state.p, state.scale)
                preview(edits.place(scene, poses), tuple(terms.items()))

    return report


def _place_and_report(
    name: str, scene: Scene, problem: Problem, state: State, begun: float
) -> tuple[Scene, LayoutReport]:
    before = measure(problem, problem.R, problem.p, problem.scale)
    after = measure(problem, state.R, state.p, state.scale)
    report = LayoutReport(name, before, after, time.perf_counter() - begun, problem.reasons)
    placed = edits.place(scene, problem.poses(state.R, state.p, state.scale))
    return edits.set_metrics(placed, after), report


def _all_at_once(problem: Problem, state: State, schedule: StageSchedule, weights: Weights, report: Report) -> None:
    """Steps on every parameter by the sum of all costs; rotations on their manifold."""
    terms = _Terms(problem, state, weights)
    free = torch.tensor(problem.free, dtype=torch.float64)[:, None]
    velocity = [torch.zeros(problem.count, 3, dtype=torch.float64) for _ in range(3)]
    for step, rate in enumerate(schedule.rates()):
        turn = torch.zeros(problem.count, 3, dtype=torch.float64, requires_grad=True)
        p = torch.tensor(state.p, requires_grad=True)
        scale = torch.tensor(state.scale, requires_grad=True)
        values = terms.evaluate(turn, p, scale, state)
        slopes = torch.autograd.grad(torch.stack(list(values.values())).sum(), [turn, p, scale], allow_unused=True)
        for k, slope in enumerate(slopes):
            velocity[k] = schedule.momentum * velocity[k] + (0.0 if slope is None else slope * free)
        state.R = np.matmul(rotation_from_vector(-schedule.rate * rate * velocity[0].numpy()), state.R)
        state.p = state.p - schedule.rate * rate * velocity[1].numpy()
        state.scale = np.maximum(state.scale - schedule.scale_rate * rate * velocity[2].numpy(), 0.05)
        report("all terms", step, state, {name: float(v.detach()) for name, v in values.items()})
    state.R = staged.orthonormal(state.R)


class _Terms:
    """All costs as a function of every pose."""

    def __init__(self, problem: Problem, state: State, weights: Weights) -> None:
        self.weights = weights
        self.problem, self.edges = problem, Edges.of(problem)
        self.observed = torch.tensor(problem.p)
        self.front = torch.tensor(problem.R[:, :, 0])
        self.size = torch.tensor(problem.shape_size)
        self.relations = torch.tensor(problem.relations)
        self.child = torch.tensor(self.edges.child)
        self.supporter = torch.tensor(self.edges.supporter)
        self.contact = torch.tensor(self.edges.contact)
        self.volumes = Volumes.of(problem)
        self.supported = self.volumes.supported
        if len(self.supported):
            self.template = torch.tensor(contact_templates(problem, self.supported)[0])

    def evaluate(
        self, turn: torch.Tensor, p: torch.Tensor, scale: torch.Tensor, state: State
    ) -> Mapping[str, torch.Tensor]:
        """3 e_align, e_sem, 5 e_place, e_rel, e_vol and e_col, weighted; adherence is part of the first and third.

        Args:
            turn: small rotations, (n, 3) in radians about the world's axes, over those of `state`.
            p: centres in the world, (n, 3), metres.
            scale: of every object, (n, 3).
            state: where the rotations began.
        """
        x, y, z = turn.T
        zero = torch.zeros_like(x)
        K = torch.stack([zero, -z, y, z, zero, -x, -y, x, zero], dim=1).reshape(-1, 3, 3)
        R0 = torch.tensor(state.R)
        R = R0 + K @ R0
        on = (self.supporter >= 0)[:, None]
        owner_R = torch.where(on[..., None], R[self.supporter], torch.eye(3, dtype=torch.float64))
        owner_p = torch.where(on, p[self.supporter], 0.0)
        owner_s = torch.where(on, scale[self.supporter], 1.0)
        normal = torch.einsum("eij,ej->ei", owner_R, torch.tensor(self.edges.normal))
        point = owner_p + torch.einsum("eij,ej->ei", owner_R, torch.tensor(self.edges.point) * owner_s)
        half = self.contact * self.size[self.child] * scale[self.child] / 2
        centre = p[self.child] + torch.einsum("eij,ej->ei", R[self.child], half)
        inward = -torch.einsum("eij,ej->ei", R[self.child], self.contact)
        w = self.weights
        return {
            "align": 3.0 * w.align * costs.e_align(inward, normal),
            "heading": w.heading * costs.e_sem(R[:, :, 0], self.front),
            "place": 5.0 * w.place * costs.e_place(centre, point, normal),
            "neighbours": w.neighbours * costs.e_rel(p, self.observed, self.relations),
            "volume": w.volume * self._space(R, p, scale, state),
            "collision": w.collision * self._overlap(p, state),
        }

    def _space(self, R: torch.Tensor, p: torch.Tensor, scale: torch.Tensor, state: State) -> torch.Tensor:
        if not len(self.supported):
            return torch.zeros((), dtype=torch.float64)
        supported = torch.tensor(self.supported)
        here = self.volumes.world_volumes(state.R, state.p, state.scale)
        outward, offset, normal = torch.tensor(here.outward), torch.tensor(here.offset), torch.tensor(here.normal)
        clearance, level = torch.tensor(here.clearance), torch.tensor(here.level)
        corners = p[supported][:, None] + torch.einsum(
            "eck,eik->eci", self.template * scale[supported][:, None], R[supported]
        )
        tilt = torch.einsum("ec,eck->ek", normal, R[supported]).abs() * self.size[supported] * scale[supported] / 2
        top = (normal * p[supported]).sum(dim=1) - level + tilt.sum(dim=1)
        return costs.e_vol(corners, top, outward, offset, clearance)

    def _overlap(self, p: torch.Tensor, state: State) -> torch.Tensor:
        R, centre, size, apart = staged.with_walls(self.problem, state)
        pairs = candidate_pairs(R, centre, size, apart, 0.0)
        if not len(pairs):
            return torch.zeros((), dtype=torch.float64)
        everywhere = torch.cat([p, torch.tensor(centre[self.problem.count :])])
        return costs.e_col(everywhere, torch.tensor(R), torch.tensor(size), torch.tensor(pairs), self.problem.count)
