"""Furniture that was posed through a wall turned along it.

Of a counter that the picture cuts off, one end is seen: as wide as the counter is deep, or as deep as it is wide.
Where its length would go on through a wall that was seen, it goes on along the wall instead, to the side on which its
end was not seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.layout.feasible.hidden_extents import is_hidden
from diorama_core.layout.feasible.photo_observations import MAX_STRETCH, UPWARD, PhotoObservations
from diorama_core.layout.feasible.settle import PARALLEL, SHORTEST_BEFORE_WALL
from diorama_core.layout.problem.problem import Problem
from diorama_core.arrangement.surfaces import plane_surface
from diorama_core.scene.types import Plane


def turned_along_walls(problem: Problem, observations: PhotoObservations) -> Problem:
    """The problem with what stands on a floor and goes through a wall turned by a right angle, its back to the wall.

    Objects of which enough is before the wall are left: they end at it.

    Args:
        problem: the observed poses and the graph.
        observations: what the camera saw.
    """
    R, p, scale = problem.R.copy(), problem.p.copy(), problem.scale.copy()
    for i in map(int, np.flatnonzero(problem.free)):
        place = problem.surface[i]
        if place is None or not place.of_plane or place.normal[2] < UPWARD or problem.R[i][2, 2] < UPWARD:
            continue
        for wall in problem.walls:
            turned = _turned(problem, observations, i, wall) if wall.seen else None
            if turned is not None:
                R[i], p[i], scale[i] = turned
                break
    return replace(problem, R=R, p=p, scale=scale)


def _turned(
    problem: Problem, observations: PhotoObservations, i: int, wall: Plane
) -> tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, "3"], Float[np.ndarray, "3"]] | None:
    """The pose of an object with its back to a wall through which it goes with its width; None where it does not."""
    size = problem.shape_size[i] * problem.scale[i]
    across, ahead = problem.R[i][:, 1], float(wall.normal @ problem.p[i]) - wall.offset
    left = ahead + 0.5 * size[1]
    surface = plane_surface(wall)
    beside = float((surface.outward @ problem.p[i] - surface.offset).max())
    goes_through = 0.0 < left < SHORTEST_BEFORE_WALL * size[1] and beside <= 0.0
    if not goes_through or abs(float(wall.normal @ across)) < PARALLEL:
        return None
    back_to_wall = np.column_stack([wall.normal, np.cross([0.0, 0.0, 1.0], wall.normal), [0.0, 0.0, 1.0]])
    deeper = float(np.clip(left / size[0], 1.0 / MAX_STRETCH, MAX_STRETCH))
    along = back_to_wall[:, 1]
    end = 0.5 * size[0] * along
    hidden = [is_hidden(observations, i, problem.p[i], problem.p[i] + sign * end) for sign in (1.0, -1.0)]
    onward = 0.5 * (size[1] - size[0]) * (float(hidden[0]) - float(hidden[1]))
    centre = problem.p[i] + (0.5 * deeper * size[0] - ahead) * wall.normal + onward * along
    return back_to_wall, centre, problem.scale[i] * [deeper, 1.0, 1.0]
