"""Objects whose hidden side reaches into a neighbour or beyond their wall: how far they go on there is a guess, so they
end before it.

A bookcase whose left end is behind a wardrobe was seen up to the wardrobe. Where its shape goes on into the wardrobe, a
narrower bookcase agrees with the picture as well, and nothing has to move. So it is with a window whose upper end is
above the picture's border, and whose shape goes on through the ceiling. The other way round, a lamp whose upper end
is above the border goes on up to the ceiling.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.sat import pair_axes, place_bodies
from diorama_core.layout.escape import exits
from diorama_core.layout.feasible.photo_observations import (
    BORDER_PX,
    PhotoObservations,
    posed_bounds_px,
)
from diorama_core.layout.feasible.separate import APART_M
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.report import part_overlaps
from diorama_core.scene.types import box_corners

MIN_SHARE = 0.5
"""An extent is reduced to no less than this share of what was retrieved."""
MIN_OVERLAP_M = 0.01
"""Overlaps that go less deep are left to moves."""
MIN_SEEN = 0.03
"""Share of its box in the photo by which a shortened object may fall short of it."""
UPRIGHT = 0.3
"""A normal whose z is smaller is that of a wall; a direction that is more along it goes through the wall."""
MAX_CORD_M = 1.5
"""A lamp that was seen farther below its ceiling does not hang from it."""
AROUND_LOAD_M = 0.02
"""Left beside what stands on an object."""


def ending_before_neighbours(problem: Problem, observations: PhotoObservations) -> Problem:
    """The problem with objects shortened where a side that was not seen reaches into another object.

    The opposite side stays, and so does what the object holds up.
    """
    scale, p = problem.scale.copy(), problem.p.copy()
    overlaps = part_overlaps(problem, problem.R, problem.p, problem.scale)
    for i in map(int, np.flatnonzero(problem.free & observations.hidden.any(axis=1))):
        neighbours = [j for j in range(problem.count) if overlaps.get((min(i, j), max(i, j)), 0.0) > MIN_OVERLAP_M]
        if not neighbours:
            continue
        for axis in (0, 1):
            for sign in (-1.0, 1.0):
                outward = sign * problem.R[i][:, axis]
                extent = float(problem.shape_size[i, axis] * scale[i, axis])
                face = p[i] + 0.5 * extent * outward
                if not is_hidden(observations, i, p[i], face):
                    continue
                cut = reaching_in_m(problem, i, neighbours, p, scale, axis, outward)
                least = MIN_SHARE * float(problem.shape_size[i, axis] * problem.scale[i, axis])
                cut = min(cut, free_m(problem, i, float(face @ outward), outward), extent - least)
                shorter = scale[i] * np.where(np.arange(3) == axis, 1.0 - cut / extent, 1.0)
                nearer = p[i] - 0.5 * cut * outward
                if cut > MIN_OVERLAP_M and covers_box(problem, observations, i, nearer, shorter):
                    scale[i], p[i] = shorter, nearer
    return replace(problem, scale=scale, p=p)


def ending_on_walls(problem: Problem, observations: PhotoObservations) -> Problem:
    """The problem with objects that hang on walls shortened where a side that was not seen reaches beyond the wall.

    The opposite side stays.
    """
    scale, p = problem.scale.copy(), problem.p.copy()
    for i in map(int, np.flatnonzero(problem.free & observations.hidden.any(axis=1))):
        wall = problem.surface[i]
        if problem.on_plane[i] is None or wall is None or abs(float(wall.normal[2])) > UPRIGHT:
            continue
        for axis in range(3):
            for sign in (-1.0, 1.0):
                outward = sign * problem.R[i][:, axis]
                extent = float(problem.shape_size[i, axis] * scale[i, axis])
                face = p[i] + 0.5 * extent * outward
                if abs(float(outward @ wall.normal)) > UPRIGHT or not is_hidden(observations, i, p[i], face, (0, 1)):
                    continue
                beyond = float(face @ outward) - float((wall.polygon @ outward).max())
                least = MIN_SHARE * float(problem.shape_size[i, axis] * problem.scale[i, axis])
                cut = min(beyond, extent - least)
                if cut > MIN_OVERLAP_M:
                    scale[i, axis] *= 1.0 - cut / extent
                    p[i] = p[i] - 0.5 * cut * outward
    return replace(problem, scale=scale, p=p)


def reaching_ceilings(problem: Problem, observations: PhotoObservations) -> Problem:
    """The problem with lamps whose upper end was not seen going on up to the ceiling that they hang from.

    The lower end stays.
    """
    scale, p = problem.scale.copy(), problem.p.copy()
    for i in map(int, np.flatnonzero(problem.free & observations.hidden[:, 1])):
        ceiling = problem.surface[i]
        if (
            problem.on_plane[i] is None
            or ceiling is None
            or ceiling.normal[2] > -UPRIGHT
            or problem.contact[i][2] < 0.5
        ):
            continue
        up = problem.R[i][:, 2]
        height = float(problem.shape_size[i, 2] * scale[i, 2])
        gap = (float(ceiling.normal @ p[i]) - ceiling.level) / max(-float(ceiling.normal @ up), UPRIGHT) - height / 2
        if 0.0 < gap <= MAX_CORD_M:
            scale[i, 2] *= 1.0 + gap / height
            p[i] = p[i] + 0.5 * gap * up
    return replace(problem, scale=scale, p=p)


def is_hidden(
    observations: PhotoObservations, i: int, centre: np.ndarray, face: np.ndarray, sides: tuple[int, ...] = (0,)
) -> bool:
    """Whether a face of an object looks to a side of the picture on which something hides the object's end.

    Sides are those across the picture (0) and up and down (1).
    """
    ends = np.stack([centre, face])
    if observations.camera.to_camera(ends)[:, 2].min() <= 0.0:
        return False
    step = np.diff(observations.camera.project(ends), axis=0)[0]
    side = 0 if abs(step[0]) > abs(step[1]) else 1
    return side in sides and bool(observations.hidden[i, side if step[side] < 0 else side + 2])


def covers_box(
    problem: Problem, observations: PhotoObservations, i: int, p: Float[np.ndarray, "3"], scale: Float[np.ndarray, "3"]
) -> bool:
    """Whether an object still reaches to the sides of its box in the photo to which it reached as observed."""
    box = problem.box_px[i]
    if not np.isfinite(box).all():
        return True
    before = posed_bounds_px(problem, observations.camera, i, problem.p[i], problem.scale[i])
    after = posed_bounds_px(problem, observations.camera, i, p, scale)
    slack = MIN_SEEN * np.tile(box[2:] - box[:2], 2) + BORDER_PX
    short = np.array([1.0, 1.0, -1.0, -1.0]) * (after - box)
    was_short = np.array([1.0, 1.0, -1.0, -1.0]) * (before - box)
    return bool((short <= np.maximum(slack, was_short + slack)).all())


def reaching_in_m(
    problem: Problem,
    i: int,
    neighbours: Sequence[int],
    p: np.ndarray,
    scale: np.ndarray,
    axis: int,
    outward: np.ndarray,
) -> float:
    """How far other objects reach into an object from one of its sides, metres.

    Where boxes overlap and parts hardly do, as those of a chair under a table, it is as far as the parts are from being
    apart.
    """
    R, half = problem.R[i], 0.5 * problem.shape_size[i] * scale[i]
    others = [k for k in range(3) if k != axis]
    deepest = 0.0
    for j in neighbours:
        corners = (p[j] + box_corners(problem.shape_size[j] * scale[j]) @ problem.R[j].T - p[i]) @ R
        low, high = corners.min(axis=0), corners.max(axis=0)
        beside = (low[others] >= half[others]).any() or (high[others] <= -half[others]).any()
        along = corners @ (R.T @ outward)
        reaches = float(half[axis] - along.min())
        # What goes on beyond the face comes from outside. What is within the box does not, unless something that is not
        # marked stands there and holds it.
        from_outside = float(along.max()) > half[axis] or problem.surface[j] is None
        if not beside and reaches > 0.0 and from_outside:
            deepest = max(deepest, min(reaches + APART_M, _exit_m(problem, i, j, p, scale, outward)))
    return deepest


def _exit_m(problem: Problem, i: int, j: int, p: np.ndarray, scale: np.ndarray, outward: np.ndarray) -> float:
    """How far object j would have to go in a direction for its parts to be apart from those of object i."""
    bodies = place_bodies(problem.packed, problem.R, p, scale)
    ours, theirs = np.flatnonzero(bodies.owner == j), np.flatnonzero(bodies.owner == i)
    a, b = (grid.ravel() for grid in np.meshgrid(ours, theirs, indexing="ij"))
    blocks = pair_axes(bodies, a, b, faces_only=True)
    offsets = [np.zeros((len(block.a), 3)) for block in blocks]
    return float(exits(blocks, offsets, [np.ones(len(block.a)) for block in blocks], outward[None], APART_M)[0])


def free_m(problem: Problem, i: int, face: float, outward: np.ndarray) -> float:
    """How far a side may come in until it meets what the object holds up, metres."""
    loads = (
        problem.p[k] + box_corners(problem.shape_size[k] * problem.scale[k]) @ problem.R[k].T
        for k in problem.rides(i)[1:]
    )
    return face - AROUND_LOAD_M - max((float((corners @ outward).max()) for corners in loads), default=-np.inf)
