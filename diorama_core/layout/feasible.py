"""The default recipe: exact structure first, then the least move that takes collisions away."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import LayoutReport
from diorama_core.layout.problem import Problem, build_problem
from diorama_core.layout.report import measure
from diorama_core.layout.separate import Program, Separation, build_program, separate
from diorama_core.layout.structure import Structure, exact_structure
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.protocols import Preview
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.types import Camera, Scene


@dataclass(frozen=True)
class FeasibleRecipe:
    """Support is exact by construction; what remains moves as little as possible until nothing overlaps.

    With a camera, moves that would be seen in the photo cost more than moves along the viewing ray.
    """

    library: ShapeLibrary
    only: frozenset[str] | None = None
    """Ids free to move (with what they hold up); all when None."""
    rounds: int = 12
    """Most rounds of choosing axes."""
    evidence: float = 4.0
    """Cost of moving across the viewing ray relative to along it, when the scene has a camera; 1 is indifferent."""
    adherence_m: float = 0.06
    """Faces parallel to a wall and nearer than this are set against it."""

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        """Returns the scene with every free object's pose made feasible, and what was achieved.

        Raises:
            Cancelled: when asked to stop; nothing was changed then.
        """
        begun = time.perf_counter()
        progress.report(0.0, "reading the layout")
        problem = build_problem(scene, self.library, only=self.only, adherence_m=self.adherence_m)
        structure = exact_structure(problem, self._rays(problem, scene.camera))
        poses = problem.poses(structure.R, structure.p, structure.scale)
        if preview is not None:
            preview(edits.place(scene, poses), [("overlap_m", 0.0)])
        program, found = self._separated(scene, problem, structure, progress, preview)
        p = program.structure.p + program.moves(found.y)
        structure = program.structure
        settled = edits.place(scene, problem.poses(structure.R, p, structure.scale))
        before = measure(problem, problem.R, problem.p, problem.scale)
        after = measure(problem, structure.R, p, structure.scale)
        reasons = problem.reasons + structure.reasons + _stuck_reasons(problem, found)
        report = LayoutReport("feasible", before, after, time.perf_counter() - begun, reasons)
        return edits.set_metrics(settled, after), report

    def _separated(
        self, scene: Scene, problem: Problem, structure: Structure, progress: Progress, preview: Preview | None
    ) -> tuple[Program, Separation]:
        program = build_program(problem, structure, self._weights(problem, structure, scene.camera))
        turn = 0

        def check(y: np.ndarray, depth: float) -> None:
            nonlocal turn
            turn += 1
            progress.report(turn / (self.rounds + 1), "taking collisions away")
            if preview is not None:
                p = structure.p + program.moves(y)
                shown = edits.place(scene, problem.poses(structure.R, p, structure.scale))
                preview(shown, [("overlap_m", max(depth, 0.0))])

        return program, separate(program, rounds=self.rounds, check=check)

    def _rays(self, problem: Problem, camera: Camera | None) -> Float[np.ndarray, "n 3"] | None:
        if camera is None or self.evidence <= 1.0:
            return None
        away = problem.p - camera.position
        return away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)

    def _weights(self, problem: Problem, structure: Structure, camera: Camera | None) -> Float[np.ndarray, "n 2 2"]:
        """What a move costs: things that hold up much move less; moves across the viewing ray cost more."""
        load = np.zeros(problem.count)
        for k in range(problem.count):
            for i in problem.chain(k):
                load[i] += 1.0
        rays = self._rays(problem, camera)
        weights = np.tile(np.eye(2), (problem.count, 1, 1))
        if rays is not None:
            for i in range(problem.count):
                along = structure.basis[i].T @ rays[i]
                weights[i] = self.evidence * np.eye(2) - (self.evidence - 1.0) * np.outer(along, along)
        return weights * load[:, None, None]


def _stuck_reasons(problem: Problem, found: Separation) -> tuple[str, ...]:
    return tuple(f"no room: {problem.labels[i]} and {problem.labels[j]} still overlap" for i, j in found.stuck)


def selection(recipe: FeasibleRecipe, ids: frozenset[str]) -> FeasibleRecipe:
    """The same recipe for some objects only."""
    return replace(recipe, only=ids)
