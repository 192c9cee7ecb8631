"""Re-solving one object while it is dragged: it follows the hand as closely as the room allows."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from diorama_core.arrangement.surfaces import RestingSurface, object_surfaces, overhang_m, plane_surface
from diorama_core.layout.feasible.relocate import relocate
from diorama_core.layout.feasible.separate import base, build_program, relax, separate
from diorama_core.layout.feasible.structure import Structure, exact_structure
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene, Support


@dataclass(frozen=True, eq=False)
class DragSolver:
    """The precomputed problem of dragging one object; `solve` is fast and moves nothing else."""

    scene: Scene
    problem: Problem
    index: int
    """Number of the dragged object in the problem."""
    places: tuple[tuple[RestingSurface, Support], ...]
    """Every surface it could be put down on, in the world, with the edge that would then hold it."""
    rounds: int = 4
    leaves_m: float = 0.02
    """An object dragged this far past the edge of its supporter is assigned to another."""

    @classmethod
    def prepare(cls, scene: Scene, library: ShapeLibrary, object_id: str) -> DragSolver:
        """Gather what stays the same during a drag."""
        problem = build_problem(scene, library, only=frozenset({object_id}))
        index = problem.ids.index(object_id)
        return cls(scene, problem, index, _places(scene, library, problem, index))

    def solve(self, pose: Pose) -> Scene:
        """The scene with the object as near to `pose` as its support, the walls and its neighbours allow.

        What it holds up rides along. Dragged off its supporter, it is put down on what is below, and its support edge
        follows. A locked object stays.
        """
        i = self.index
        if not self.problem.free[i]:
            return self.scene
        problem, edge = self._problem_at(pose)
        structure = self._settle(problem)
        weight = np.tile(np.eye(2), (problem.count, 1, 1))
        program = build_program(problem, structure, weight)
        separation = separate(program, rounds=self.rounds, check=lambda y, depth: None)
        if separation.stuck:
            separation = relax(program, relocate(program, base(program)))
        moved = edits.place(self.scene, program.layout(separation.y).free_poses)
        return moved if edge is None else edits.attach(moved, edge)

    def _problem_at(self, pose: Pose) -> tuple[Problem, Support | None]:
        """The problem with the object at the hand's pose, its load along with it, and its new edge if any."""
        old, i = self.problem, self.index
        R, p, scale = old.R.copy(), old.p.copy(), old.scale.copy()
        turn = pose.R_world_object @ old.R[i].T
        for k in old.rides(i):
            R[k] = turn @ old.R[k]
            p[k] = pose.position + turn @ (old.p[k] - old.p[i])
        R[i], p[i], scale[i] = pose.R_world_object, pose.position, pose.scale
        moved = replace(old, R=R, p=p, scale=scale, adheres=tuple(a for a in old.adheres if a[0] not in old.rides(i)))
        return self._put_down(moved)

    def _settle(self, problem: Problem) -> Structure:
        """The object on its support, its load carried along as it lies; put anew only where the object was resized."""
        i, load = self.index, self.problem.rides(self.index)[1:]
        structure = exact_structure(problem, only=(i,))
        if not load:
            return structure
        if not np.array_equal(structure.scale[i], self.problem.scale[i]):
            return exact_structure(problem)
        R, p = structure.R.copy(), structure.p.copy()
        turn = structure.R[i] @ self.problem.R[i].T
        R[load] = turn @ self.problem.R[load]
        p[load] = structure.p[i] + (self.problem.p[load] - self.problem.p[i]) @ turn.T
        return replace(structure, R=R, p=p)

    def _put_down(self, problem: Problem) -> tuple[Problem, Support | None]:
        i = self.index
        supported = problem.surface[i]
        if supported is None or problem.contact[i][2] != -1.0:
            return problem, None
        j = int(problem.parent[i])
        world = problem.to_world(i, supported)
        foot = problem.p[i] - 0.5 * problem.R[i][:, 2] * problem.shape_size[i][2] * problem.scale[i][2]
        if j >= 0 and overhang_m(world, foot) <= self.leaves_m:
            return problem, None
        under = [
            (surface, edge)
            for surface, edge in self.places
            if overhang_m(surface, foot) <= 0.0 and surface.level <= float(foot[2]) + 0.15
        ]
        if not under:
            return problem, None
        surface, edge = max(under, key=lambda place: place[0].level)
        present = self.scene.support_of(problem.ids[i])
        if present is not None and present.parent == edge.parent and present.parent_surface == edge.parent_surface:
            return problem, None
        parent = problem.parent.copy()
        parent[i] = problem.ids.index(edge.parent) if edge.parent in problem.ids else -1
        surfaces, planes = list(problem.surface), list(problem.on_plane)
        # Surfaces of places are in the world already, and their owners stay.
        surfaces[i] = replace(surface, of_plane=True)
        planes[i] = None if parent[i] >= 0 else edge.parent
        kin = problem.kin.copy()
        for k in problem.rides(i):
            kin[k, :] = kin[:, k] = False
        levels = tuple(() if k == i else levels_of_object for k, levels_of_object in enumerate(problem.levels))
        changed = replace(problem, parent=parent, surface=tuple(surfaces), levels=levels, on_plane=tuple(planes))
        for k in problem.rides(i):
            for above in changed.chain(k):
                kin[k, above] = kin[above, k] = True
        return replace(changed, kin=kin | (problem.kin & problem.yielding)), edge


def _places(
    scene: Scene, library: ShapeLibrary, problem: Problem, index: int
) -> tuple[tuple[RestingSurface, Support], ...]:
    riders = {problem.ids[k] for k in problem.rides(index)}
    child = problem.ids[index]
    places = [(plane_surface(p), Support(child, p.id)) for p in scene.architecture.by_role("floor")]
    for item in scene.objects:
        if item.id in riders:
            continue
        for number, surface in enumerate(object_surfaces(library.shape(item.shape_id), item)):
            world = surface.to_world(item.pose)
            if world.normal[2] > 0.98:
                places.append((world, Support(child, item.id, parent_surface=number)))
    return tuple(places)
