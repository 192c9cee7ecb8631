"""The published recipes: the paper's four stages, and its all-in-one ablation."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import torch

from diorama_core.artefacts import LayoutReport
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.layout.gradients import candidate_pairs
from diorama_core.layout.problem.problem import build_problem
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
class _Recipe:
    """Steps of a schedule, and the scene and report that they lead to."""

    library: ShapeLibrary
    only: frozenset[str] | None = None
    """Ids free to move (with what they hold up); all when None."""
    schedule: StageSchedule = PUBLISHED
    adherence_m: float = 0.1
    """Objects on the floor nearer to a wall than this are drawn to it."""
    weights: Weights = AS_IT_IS
    _name: ClassVar[str]

    @property
    def _stages(self) -> tuple[Callable[[State], None], ...]:
        """Done one after another."""
        raise NotImplementedError

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        """Run all steps; raises `Cancelled` when asked to stop."""
        begun = time.perf_counter()
        problem = build_problem(scene, self.library, only=self.only, adherence_m=self.adherence_m)
        stages = self._stages
        report = _reporter(scene, progress, preview, self.schedule.steps * len(stages))
        state = State(problem, self.schedule, report, self.weights)
        for stage in stages if problem.count else ():
            stage(state)
        before, after = measure(problem, problem), measure(problem, state.layout)
        made = LayoutReport(self._name, before, after, time.perf_counter() - begun, problem.reasons)
        return edits.set_metrics(edits.place(scene, state.layout.free_poses), after), made


@dataclass(frozen=True)
class PaperRecipe(_Recipe):
    """Orientation, placement, space, refinement: each its own parameters, costs and steps."""

    stages: int = 4
    """How many of the four stages to run, for the ablation."""
    _name: ClassVar[str] = "paper"

    @property
    def _stages(self) -> tuple[Callable[[State], None], ...]:
        stages = (staged.orientation_stage, staged.placement_stage, staged.space_stage, staged.refinement_stage)
        return stages[: self.stages]


@dataclass(frozen=True)
class AllInOneRecipe(_Recipe):
    """Every term at once, over rotation, position and scale together (torch, one thread)."""

    schedule: StageSchedule = TOGETHER
    _name: ClassVar[str] = "all-in-one"

    @property
    def _stages(self) -> tuple[Callable[[State], None], ...]:
        return (_all_at_once,)


@contextmanager
def one_thread() -> Iterator[None]:
    """Small tensors lose from threads: pin torch to one, and give back what was set."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def _reporter(scene: Scene, progress: Progress, preview: Preview | None, total: int) -> Report:
    """Reports each of the steps, and every tenth one's scene to the preview."""
    done = 0

    def report(stage: str, step: int, state: State, terms: Mapping[str, float]) -> None:
        nonlocal done
        done += 1
        progress.check()
        if step % 10 == 0:
            progress.report(done / total, f"{stage}, step {step + 1}")
            if preview is not None:
                now = replace(state.layout, R=staged.orthonormal(state.R))
                preview(edits.place(scene, now.free_poses), tuple(terms.items()))

    return report


@one_thread()
def _all_at_once(state: State) -> None:
    """Steps on every parameter by the sum of all costs; rotations on their manifold."""
    problem, schedule, terms = state.problem, state.schedule, _Terms(state)
    free = torch.tensor(problem.free, dtype=torch.float64)[:, None]
    velocity = [torch.zeros(problem.count, 3, dtype=torch.float64) for _ in range(3)]
    for step, rate in enumerate(schedule.rates()):
        turn = torch.zeros(problem.count, 3, dtype=torch.float64, requires_grad=True)
        p = torch.tensor(state.p, requires_grad=True)
        scale = torch.tensor(state.scale, requires_grad=True)
        values = terms.evaluate(turn, p, scale)
        slopes = torch.autograd.grad(torch.stack(list(values.values())).sum(), [turn, p, scale], allow_unused=True)
        for k, slope in enumerate(slopes):
            velocity[k] = schedule.momentum * velocity[k] + (0.0 if slope is None else slope * free)
        state.R = np.matmul(rotation_from_vector(-schedule.rate * rate * velocity[0].numpy()), state.R)
        state.p = state.p - schedule.rate * rate * velocity[1].numpy()
        state.scale = np.maximum(state.scale - schedule.scale_rate * rate * velocity[2].numpy(), 0.05)
        state.report("all terms", step, state, {name: float(v.detach()) for name, v in values.items()})
    state.R = staged.orthonormal(state.R)


class _Terms:
    """All costs as a function of every pose."""

    def __init__(self, state: State) -> None:
        problem = state.problem
        self.state, self.edges = state, Edges.of(problem)
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

    def evaluate(self, turn: torch.Tensor, p: torch.Tensor, scale: torch.Tensor) -> Mapping[str, torch.Tensor]:
        """3 e_align, e_sem, 5 e_place, e_rel, e_vol and e_col, weighted; adherence is part of the first and third.

        Turns are small rotations, (n, 3) in radians about the world's axes, over those of the state.
        """
        x, y, z = turn.T
        zero = torch.zeros_like(x)
        K = torch.stack([zero, -z, y, z, zero, -x, -y, x, zero], dim=1).reshape(-1, 3, 3)
        R0 = torch.tensor(self.state.R)
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
        w = self.state.weights
        return {
            "align": 3.0 * w.align * costs.e_align(inward, normal),
            "heading": w.heading * costs.e_sem(R[:, :, 0], self.front),
            "place": 5.0 * w.place * costs.e_place(centre, point, normal),
            "neighbours": w.neighbours * costs.e_rel(p, self.observed, self.relations),
            "volume": w.volume * self._space(R, p, scale),
            "collision": w.collision * self._overlap(p),
        }

    def _space(self, R: torch.Tensor, p: torch.Tensor, scale: torch.Tensor) -> torch.Tensor:
        if not len(self.supported):
            return torch.zeros((), dtype=torch.float64)
        supported = torch.tensor(self.supported)
        here = self.volumes.world_volumes(self.state.R, self.state.p, self.state.scale)
        outward, offset, normal = torch.tensor(here.outward), torch.tensor(here.offset), torch.tensor(here.normal)
        clearance, level = torch.tensor(here.clearance), torch.tensor(here.level)
        corners = p[supported][:, None] + torch.einsum(
            "eck,eik->eci", self.template * scale[supported][:, None], R[supported]
        )
        tilt = torch.einsum("ec,eck->ek", normal, R[supported]).abs() * self.size[supported] * scale[supported] / 2
        top = (normal * p[supported]).sum(dim=1) - level + tilt.sum(dim=1)
        return costs.e_vol(corners, top, outward, offset, clearance)

    def _overlap(self, p: torch.Tensor) -> torch.Tensor:
        R, centre, size, apart = staged.with_walls(self.state)
        pairs = candidate_pairs(R, centre, size, apart, 0.0)
        if not len(pairs):
            return torch.zeros((), dtype=torch.float64)
        count = self.state.problem.count
        everywhere = torch.cat([p, torch.tensor(centre[count:])])
        return costs.e_col(everywhere, torch.tensor(R), torch.tensor(size), torch.tensor(pairs), count)
