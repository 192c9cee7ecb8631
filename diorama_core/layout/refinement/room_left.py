"""What a settled layout must not lose when one of its objects moves: contact, places on supporters, and distances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.report import USUAL_ERRORS, part_overlaps, support_errors
from diorama_core.scene.types import box_corners

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
        poses = problem.R, problem.p, problem.scale
        errors = np.maximum(support_errors(problem, *poses) + ROUNDING_M, USUAL_ERRORS)
        return cls(problem, errors, part_overlaps(problem, *poses, supporters=True))

    def allows(
        self, i: int, R: Float[np.ndarray, "n 3 3"], p: Float[np.ndarray, "n 3"], scale: Float[np.ndarray, "n 3"]
    ) -> bool:
        """Whether object i may be where it is among all others.

        Args:
            i: index of the object.
            R: rotations, world from object.
            p: centres, world, metres.
            scale: along the axes of each object.
        """
        affected = [i, *np.flatnonzero(self.problem.parent == i)]
        worse = support_errors(self.problem, R, p, scale)[affected] > self.support_errors[affected]
        if worse.any() or self._through_wall(i, R, p, scale):
            return False
        depths = part_overlaps(self.problem, R, p, scale, only=i, supporters=True)
        return all(depth <= self.overlaps_m.get(pair, 0.0) + ROUNDING_M for pair, depth in depths.items())

    def _through_wall(self, i: int, R: np.ndarray, p: np.ndarray, scale: np.ndarray) -> bool:
        """Whether the object is farther behind a wall than it was."""
        problem, local = self.problem, box_corners(self.problem.shape_size[i])
        was = problem.p[i] + (local * problem.scale[i]) @ problem.R[i].T
        now = p[i] + (local * scale[i]) @ R[i].T
        for wall in problem.walls_near(i):
            before, after = (float((corners @ wall.normal).min()) - wall.offset for corners in (was, now))
            if after < min(before, 0.0) - ROUNDING_M:
                return True
        return False
