"""How an object of a settled layout may still move, grow and turn where it rests, how far that is from what was
observed of it, and what the layout must not lose by it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.surfaces import RestingSurface, is_wall_like
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.rotations import yaw_rotations
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.report import USUAL_ERRORS, part_overlaps, support_errors
from diorama_core.layout.settings import REFINEMENT, RefinementSettings
from diorama_core.scene.types import Pose, box_corners


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

        A turn is in proportion to the share by which an extent changes.
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


@dataclass(frozen=True)
class Precision:
    """Standard deviations of what was observed of an object."""

    distance_m: float
    """Deviation of its distance from the camera, in metres."""
    distance_share: float
    """Deviation of the distance as a share of it."""
    size_share: float
    """Deviation of each of its extents, as a share."""
    sizes_follow: bool
    """Whether sizes follow distances, because a photo alone gave both. Measured ones cost by their deviation however
    much they change; reasoned ones cost no more beyond `RefinementSettings.max_sigmas`."""


MEASURED = Precision(distance_m=0.01, distance_share=0.0, size_share=0.03, sizes_follow=False)
"""With measured depth."""
REASONED = Precision(distance_m=0.0, distance_share=0.033, size_share=0.05, sizes_follow=True)
"""From a photo alone."""


@dataclass(frozen=True, eq=False)
class PosePrior:
    """One observed pose."""

    eye: Float[np.ndarray, "3"]
    """The camera's position."""
    observed: Pose
    precision: Precision
    settings: RefinementSettings = REFINEMENT

    def was_pushed_away(self, position: Float[np.ndarray, "3"]) -> bool:
        """Whether a position is farther from a measured one than is usual."""
        usual = self.settings.linear_sigmas * self.precision.distance_m
        return usual > 0.0 and float(np.linalg.norm(position - self.observed.position)) > usual

    def cost(self, poses: PoseBatch) -> Float[np.ndarray, " p"]:
        """Cost of other poses, in shares of the agreement of one mask."""
        distance = float(np.linalg.norm(self.observed.position - self.eye))
        nearer = np.log(np.linalg.norm(poses.position - self.eye, axis=1) / distance)
        grown = np.log(poses.scale / self.observed.scale)
        if self.precision.sizes_follow:
            grown = grown - nearer[:, None]
        cosine = (np.einsum("pij,ij->p", poses.R, self.observed.R_world_object) - 1.0) / 2.0
        sigma = float(np.hypot(self.precision.distance_m / distance, self.precision.distance_share))
        turned = np.arccos(np.clip(cosine, -1.0, 1.0)) / self.settings.turn_sigma_rad
        deviations = np.column_stack([nearer / sigma, turned, grown / self.precision.size_share])
        squares = np.minimum(deviations**2, self.settings.max_sigmas**2)
        away, linear = np.abs(deviations), self.settings.linear_sigmas
        distant = np.where(away <= linear, away**2, linear * (2.0 * away - linear))
        sized = squares[:, 2:] if self.precision.sizes_follow else distant[:, 2:]
        return self.settings.sigma * (distant[:, 0] + squares[:, 1] + sized.mean(axis=1))


ROUNDING_M = 1e-6


@dataclass(frozen=True, eq=False)
class RoomLeft:
    """Tells which moves of single objects leave a layout as sound as it was settled."""

    problem: Problem
    """The settled layout."""
    support_errors: Float[np.ndarray, "n 3"]
    """Most that each object may be tilted on its support, off it and beyond its bounds: as is usual, or as it was."""
    overlaps_m: dict[tuple[int, int], float]
    """Depths of the overlaps that were left."""

    @classmethod
    def of(cls, problem: Problem) -> RoomLeft:
        """What is left around the objects of a settled layout."""
        errors = np.maximum(support_errors(problem) + ROUNDING_M, USUAL_ERRORS)
        return cls(problem, errors, part_overlaps(problem, supporters=True))

    def allows(self, i: int, now: Problem) -> bool:
        """Whether object i may be where it is now among all others."""
        affected = [i, *np.flatnonzero(now.parent == i)]
        worse = support_errors(now)[affected] > self.support_errors[affected]
        if worse.any() or self._enters_wall(i, now):
            return False
        depths = part_overlaps(now, only=i, supporters=True)
        return all(depth <= self.overlaps_m.get(pair, 0.0) + ROUNDING_M for pair, depth in depths.items())

    def _enters_wall(self, i: int, now: Problem) -> bool:
        """True if the object is farther behind a wall than it was."""
        local = box_corners(now.shape_size[i])
        corners = [of.p[i] + (local * of.scale[i]) @ of.R[i].T for of in (self.problem, now)]
        for wall in self.problem.walls_near(i):
            before, after = (float((points @ wall.normal).min()) - wall.offset for points in corners)
            if after < min(before, 0.0) - ROUNDING_M:
                return True
        return False
