"""How an object may still move, grow and turn where it rests, and poses near its own that keep to that."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.surfaces import RestingSurface, is_wall_like
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.rotations import yaw_rotations
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.settings import REFINEMENT, RefinementSettings


@dataclass(frozen=True, eq=False)
class Freedom:
    """What the support and the walls of an object leave it."""

    directions: Float[np.ndarray, "d 3"]
    """Unit, world: along its support, and along the walls that it touches."""
    pinned: Float[np.ndarray, "3"]
    """Point of its box, in half extents, that touches supports and walls and stays put when it is resized."""
    extents: Float[np.ndarray, "e 3"]
    """Which of its extents may change, each by itself or several alike."""
    turns: bool
    """Whether it may turn about the vertical."""
    settings: RefinementSettings

    def steps(self, move_m: float, share: float) -> Float[np.ndarray, "k f"]:
        """No change, then one step either way for every freedom, and for all extents together.

        Args:
            move_m: length of a step along a direction.
            share: by which an extent changes in a step; a turn is in proportion.
        """
        extents, turn = len(self.extents), self.settings.turn_rad * share
        length = [*len(self.directions) * [move_m], *extents * [share], *int(self.turns) * [turn]]
        single = np.diag(length)
        as_a_whole = np.zeros((int(extents > 1), len(length)))
        as_a_whole[:, len(self.directions) : len(self.directions) + extents] = share
        ways = np.concatenate([single, as_a_whole])
        return np.concatenate([np.zeros((1, len(length))), ways, -ways])

    def steps_toward(self, p: Float[np.ndarray, "3"], place: Float[np.ndarray, "3"]) -> Float[np.ndarray, "k f"]:
        """From a centre all the way to a place, as far as it may go there, and parts of that way."""
        ways = self.settings.ways
        steps = np.zeros((len(ways), len(self.directions) + len(self.extents) + int(self.turns)))
        steps[:, : len(self.directions)] = np.outer(ways, self.directions @ (place - p))
        return steps

    def poses(
        self,
        R: Float[np.ndarray, "3 3"],
        p: Float[np.ndarray, "3"],
        scale: Float[np.ndarray, "3"],
        size: Float[np.ndarray, "3"],
        changes: Float[np.ndarray, "k f"],
    ) -> PoseBatch:
        """The poses that differ so from one.

        Args:
            R: its rotation.
            p: its centre.
            scale: its scale.
            size: extents of the object at scale 1.
            changes: metres along the directions, logarithms of the extents, and the turn in radians.
        """
        count = len(changes)
        along, grown, turn = np.split(changes, np.cumsum([len(self.directions), len(self.extents)]), axis=1)
        rotations = yaw_rotations(turn[:, 0]) @ R if self.turns else np.tile(R, (count, 1, 1))
        scales = scale * np.exp(grown @ self.extents)
        shift = np.einsum("kij,kj->ki", rotations, self.pinned * size * (scales - scale) / 2)
        return PoseBatch(rotations, p + along @ self.directions - shift, scales)


def freedom(
    problem: Problem,
    i: int,
    surface: RestingSurface,
    *,
    sized: bool,
    is_round: bool,
    settings: RefinementSettings = REFINEMENT,
) -> Freedom:
    """What is left to an object of a layout that is settled.

    Args:
        problem: the settled layout.
        i: index of the object.
        surface: where it rests, in the world.
        sized: whether its size is not its own to change.
        is_round: whether its outline from above is a circle, which it remains.
        settings: lengths of its steps.
    """
    walls = [(problem.walls[w], face) for k, w, face in problem.adheres if k == i]
    grounded = bool(problem.grounded[i])
    directions = list(plane_axes(surface.normal))[: 1 if grounded else 2]
    for wall, _ in walls:
        level = [d - float(d @ wall.normal) * wall.normal for d in directions]
        directions = [d / np.linalg.norm(d) for d in level if np.linalg.norm(d) > settings.min_along]
        if len(directions) == 2 and abs(float(directions[0] @ directions[1])) > 1.0 - settings.min_along:
            directions = directions[:1]
    pinned = problem.contact[i] + sum((face for _, face in walls), np.zeros(3))
    pinned[2] -= float(grounded)
    loaded = bool((problem.parent == i).any())
    upright = np.abs(problem.contact[i]) > 0.5
    extents = np.array([[1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) if is_round else np.eye(3)
    kept = extents @ (upright & loaded) > 0.0
    return Freedom(
        np.array(directions).reshape(-1, 3),
        np.clip(pinned, -1.0, 1.0),
        extents[~kept & (not sized)],
        turns=not walls and not loaded and not is_wall_like(surface) and bool(upright[2]),
        settings=settings,
    )
