"""Convex parts cut back from the places of their shape: nothing is where things are put down.

The hull of a quarter of a round tray's rim reaches far into the tray. What stands there would have to leave it,
although the rim is thin and the place within is free.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Bool, Float
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from diorama_core.geometry.convex import THINNEST_M, ConvexPart, simplest_part
from diorama_core.library.record import SupportSurface

Room = tuple[Float[np.ndarray, "k 2"], float, float]
"""What is over a place: its outline in plan, counter-clockwise, and from which height to which it is looked at, m."""


@dataclass(frozen=True)
class ClearPlacesSettings:
    """How parts are cut back from places."""

    rises_m: tuple[float, float] = (0.002, 0.01)
    """What rises less above a place is below what rests there: above flat places, and above those that are hardly
    flat."""
    around_feet_m: float = 0.05
    """What rises less above a place of furniture on which people put things is around their feet: the grates of a
    stove, the rim of a tray."""
    reaches_m: float = 0.01
    """Parts that reach less over a place are left as they are."""
    margin_m: float = 0.008
    """So far within a place's sides they may still rise: outlines are as fine as the grid that they were found on."""
    max_sides: int = 12
    """Outlines with more corners are cut with an inscribed outline of so many."""
    well_inside_m: float = 0.002
    """A point so far from all sides of a body is found where the body allows it."""
    steps: int = 40
    samples: int = 4000
    seed: int = 0


SETTINGS = ClearPlacesSettings()


def clear_of_places(
    parts: tuple[ConvexPart, ...],
    surfaces: Sequence[SupportSurface],
    mesh: Callable[[], trimesh.Trimesh],
    *,
    carries: bool = False,
) -> tuple[ConvexPart, ...]:
    """The parts without what of them is over places above which the mesh leaves room.

    Together they contain the mesh but for what rises over a place so little that things are put down on or within it.

    Args:
        parts: convex bodies that contain the shape, in its own frame.
        surfaces: its places.
        mesh: gives its geometry, which most shapes need not be asked for.
        carries: whether people put things on its places rather than sit on them.
    """
    places = [(_sample_corners(np.asarray(s.polygon)[:, :2]), s.height_m, s.height_m + s.clearance_m) for s in surfaces]
    if not any(_reaches_over(part, _room_above(place, SETTINGS.rises_m[0])) for part in parts for place in places):
        return parts
    rises = (*SETTINGS.rises_m, SETTINGS.around_feet_m) if carries else SETTINGS.rises_m
    surface = mesh()
    points = np.vstack(
        [surface.vertices, trimesh.sample.sample_surface(surface, SETTINGS.samples, seed=SETTINGS.seed)[0]]
    )
    for place in places:
        rooms = (_room_above(place, rise) for rise in rises)
        free = next((room for room in rooms if not _are_in_room(points, *room).any()), None)
        if free is not None:
            whole, flat = (place[0], place[1], free[2]), _room_above(place, SETTINGS.rises_m[0])
            parts = tuple(piece for p in parts for piece in (_cut(p, whole) if _reaches_over(p, flat) else [p]))
    return parts


def _sample_corners(outline: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, "m 2"]:
    """At most `MAX_SIDES` of an outline's corners, evenly along it."""
    if len(outline) <= SETTINGS.max_sides:
        return outline
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1))])
    at = np.searchsorted(length[:-1], np.arange(SETTINGS.max_sides) / SETTINGS.max_sides * length[-1])
    return outline[np.unique(np.minimum(at, len(outline) - 1))]


def _sides(outline: Float[np.ndarray, "k 2"]) -> tuple[Float[np.ndarray, "s 2"], Float[np.ndarray, " s"]]:
    """Outward unit normals of an outline's sides, and inside is where normal . x <= offset."""
    along = np.roll(outline, -1, axis=0) - outline
    length = np.linalg.norm(along, axis=1)
    long = length > 1e-9
    outward = np.column_stack([along[long, 1], -along[long, 0]]) / length[long, None]
    return outward, (outward * outline[long]).sum(axis=1)


def _room_above(place: Room, rise_m: float) -> Room:
    """The room over a place, above what rises from it so far."""
    outline, level, top = place
    return outline, level + rise_m, top - SETTINGS.rises_m[1]


def _are_in_room(
    points: Float[np.ndarray, "n 3"], outline: Float[np.ndarray, "k 2"], low: float, high: float
) -> Bool[np.ndarray, " n"]:
    """True for points in a room."""
    outward, offset = _sides(outline)
    beside = (points[:, :2] @ outward.T - offset).max(axis=1)
    return np.asarray((beside < -SETTINGS.margin_m) & (points[:, 2] > low) & (points[:, 2] < high))


def _reaches_over(part: ConvexPart, room: Room) -> bool:
    """Whether a part has some of a room inside it."""
    outline, low, high = room
    vertices = part.vertices
    if vertices[:, 2].max() < low or vertices[:, 2].min() > high or len(outline) < 3:
        return False
    reach = np.minimum(vertices[:, :2].max(axis=0), outline.max(axis=0))
    if (reach - np.maximum(vertices[:, :2].min(axis=0), outline.min(axis=0)) < SETTINGS.reaches_m).any():
        return False
    outward, offset = _sides(outline)
    inside = [[*n, 0.0, SETTINGS.margin_m + SETTINGS.reaches_m - o] for n, o in zip(outward, offset, strict=True)]
    inside += [[0.0, 0.0, -1.0, low]]
    inside += [[0.0, 0.0, 1.0, -high]] if np.isfinite(high) else []
    return len(_clip(vertices, np.array(inside))) > 0


def _cut(part: ConvexPart, room: Room) -> list[ConvexPart]:
    """A part without what of it is in a room: what is beyond each of the room's sides, and below and above it."""
    outline, low, high = room
    outward, offset = _sides(outline)
    beyond = [np.array([[-x, -y, 0.0, o - SETTINGS.margin_m]]) for (x, y), o in zip(outward, offset, strict=True)]
    beyond += [np.array([[0.0, 0.0, 1.0, -low]])]
    beyond += [np.array([[0.0, 0.0, -1.0, high]])] if np.isfinite(high) else []
    clouds = [_clip(part.vertices, half) for half in beyond]
    return [simplest_part(cloud) for cloud in _not_contained([c for c in clouds if len(c)])]


def _clip(vertices: Float[np.ndarray, "v 3"], half_spaces: Float[np.ndarray, "h 4"]) -> Float[np.ndarray, "n 3"]:
    """Corners of what of a convex body is inside half-spaces (normal . x + offset <= 0); none where nothing is."""
    deepest = (vertices @ half_spaces[:, :3].T + half_spaces[:, 3]).min(axis=0)
    if (deepest > -THINNEST_M).any():  # nothing as thick as that is inside
        return np.zeros((0, 3))
    try:
        planes = np.vstack([ConvexHull(vertices).equations, half_spaces])
    except (QhullError, ValueError):
        return np.zeros((0, 3))
    inside = _point_inside(planes, vertices.mean(axis=0))
    if inside is None:
        return np.zeros((0, 3))
    try:
        corners = HalfspaceIntersection(planes, inside).intersections
    except QhullError:
        return np.zeros((0, 3))
    return np.unique(np.round(corners, 9), axis=0)


def _point_inside(planes: Float[np.ndarray, "h 4"], start: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"] | None:
    """A point inside half-spaces (unit normal . x + offset <= 0); None where what is inside is thinner than a part.

    Steps back from one plane after another (Agmon 1954) mostly end well inside; where they do not, the largest ball
    is sought, which takes thirty times as long.
    """
    point = start
    for _ in range(SETTINGS.steps):
        over = planes[:, :3] @ point + planes[:, 3]
        worst = int(over.argmax())
        if over[worst] <= -SETTINGS.well_inside_m:
            return point
        point = point - (over[worst] + 2.0 * SETTINGS.well_inside_m) * planes[worst, :3]
    rows = np.column_stack([planes[:, :3], np.ones(len(planes))])
    ball = linprog([0.0, 0.0, 0.0, -1.0], rows, -planes[:, 3], bounds=[(None, None)] * 3 + [(0.0, None)]).x
    return None if ball is None or ball[3] < THINNEST_M / 2 else np.asarray(ball[:3])


def _not_contained(clouds: list[Float[np.ndarray, "_ 3"]]) -> list[Float[np.ndarray, "_ 3"]]:
    """Without those inside a larger one."""
    kept: list[np.ndarray] = []
    planes: list[np.ndarray] = []
    for cloud in sorted(clouds, key=lambda c: -float(ConvexHull(c).volume)):
        if not any((cloud @ p[:, :3].T + p[:, 3] <= 1e-5).all() for p in planes):
            kept.append(cloud)
            planes.append(ConvexHull(cloud).equations)
    return kept
