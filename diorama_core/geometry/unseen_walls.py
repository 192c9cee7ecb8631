"""What closes a room where its photo shows nothing: walls on the rest of the floor's outline, and a ceiling.

Light meets them as if they were there; they are neither drawn nor written. A room without any window that is known
would be dark by day: each wall that nobody saw then has a window of usual size.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.scene.types import Architecture, Plane, Scene

BESIDE_M = 0.25
"""A wall whose foot is no farther than this from the floor's edge stands on it."""
PARALLEL = 0.97
"""Least cosine between such a wall and the edge."""
MIN_GAP_M = 0.1
USUAL_HEIGHT_M = 2.5
SILL_M, HEAD_M, LINTEL_M = 0.9, 2.1, 0.2
"""A usual window: its lower and upper edge above the floor, and the least that is left of the wall above it."""
WINDOW_SHARE, WIDEST_WINDOW_M, NARROWEST_WALL_M = 0.5, 2.2, 1.2

Corners = Float[np.ndarray, "4 3"]


@dataclass(frozen=True)
class LightOpening:
    """A hole in a wall that lets light in."""

    corners: Corners
    """In the world, metres."""
    normal: Float[np.ndarray, "3"]
    """Normal of its wall, toward the room."""


@dataclass(frozen=True)
class Unseen:
    """What closes a room."""

    planes: tuple[Plane, ...] = ()
    """Walls in pieces around their windows, and a ceiling."""
    openings: tuple[LightOpening, ...] = ()


def unseen_parts(scene: Scene) -> Unseen:
    """Walls and ceiling that nobody saw; none without a floor, whose outline they follow."""
    floor = scene.architecture.floor
    if floor is None:
        return Unseen()
    level, top = heights(scene.architecture)
    outline = _upward(floor)
    gaps = open_edges(scene.architecture)
    knows_windows = any(o.category == "window" and not o.hidden for o in scene.objects)
    planes: list[Plane] = []
    openings: list[LightOpening] = []
    for a, b in gaps:
        window = None if knows_windows else _usual_window(float(np.linalg.norm(b - a)), top - level)
        for s0, s1, z0, z1 in _pieces(window, top - level):
            corners = rectangle(a, b, (s0, s1), (level + z0, level + z1))
            planes.append(Plane(f"unseen_{len(planes) + 1}", "wall", corners, confidence=0.0))
        if window is not None:
            corners = rectangle(a, b, window[:2], (level + window[2], level + window[3]))
            openings.append(LightOpening(corners, planes[-1].normal))
    if not scene.architecture.by_role("ceiling"):
        above = outline[::-1] * (1.0, 1.0, 0.0) + (0.0, 0.0, top)
        planes.append(Plane("unseen_ceiling", "ceiling", above, confidence=0.0))
    return Unseen(tuple(planes), tuple(openings))


def close_room(scene: Scene) -> Scene:
    """The scene with what nobody saw of its room, as light meets it."""
    more = unseen_parts(scene).planes
    return replace(scene, architecture=Architecture((*scene.architecture.planes, *more))) if more else scene


def open_edges(architecture: Architecture) -> list[tuple[Float[np.ndarray, "2"], Float[np.ndarray, "2"]]]:
    """Parts of the floor's outline without a wall, from and to, the room on their left; none without a floor."""
    floor, walls = architecture.floor, architecture.by_role("wall")
    edges = [] if floor is None else _edges(_upward(floor))
    return [gap for a, b in edges for gap in _gaps(a[:2], b[:2], walls)]


def heights(architecture: Architecture) -> tuple[float, float]:
    """Heights of the floor and of what is highest, in metres; the usual ones where nothing says them."""
    floor = architecture.floor
    level = 0.0 if floor is None else float(floor.polygon[:, 2].mean())
    tops = [float(p.polygon[:, 2].max()) for p in architecture.planes if p.role != "floor"]
    return level, max(tops, default=level + USUAL_HEIGHT_M)


def _upward(floor: Plane) -> Float[np.ndarray, "n 3"]:
    return floor.polygon if floor.normal[2] > 0 else floor.polygon[::-1]


def _edges(outline: Float[np.ndarray, "n 3"]) -> Iterable[tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]]:
    return zip(outline, np.roll(outline, -1, axis=0), strict=True)


def _gaps(
    a: Float[np.ndarray, "2"], b: Float[np.ndarray, "2"], walls: Iterable[Plane]
) -> list[tuple[Float[np.ndarray, "2"], Float[np.ndarray, "2"]]]:
    """The parts of a floor's edge on which no wall stands."""
    length = float(np.linalg.norm(b - a))
    if length < MIN_GAP_M:
        return []
    along = (b - a) / length
    inward = np.array([-along[1], along[0]])
    covered = []
    for wall in walls:
        foot = wall.polygon[:, :2] - a
        if float(wall.normal[:2] @ inward) > PARALLEL and float(np.abs(foot @ inward).max()) < BESIDE_M:
            covered.append((float((foot @ along).min()), float((foot @ along).max())))
    gaps, start = [], 0.0
    for low, high in [*sorted(covered), (length, length)]:
        if low - start > MIN_GAP_M:
            gaps.append((a + start * along, a + min(low, length) * along))
        start = max(start, high)
    return gaps


def _usual_window(width_m: float, height_m: float) -> tuple[float, float, float, float] | None:
    """From and to along the wall, lower and upper edge; None where a wall is too small for one."""
    head = min(HEAD_M, height_m - LINTEL_M)
    if width_m < NARROWEST_WALL_M or head < SILL_M + 0.3:
        return None
    half = 0.5 * min(WINDOW_SHARE * width_m, WIDEST_WINDOW_M) / width_m
    return 0.5 - half, 0.5 + half, SILL_M, head


def _pieces(
    window: tuple[float, float, float, float] | None, height_m: float
) -> Iterable[tuple[float, float, float, float]]:
    """A wall without its window, in rectangles: from and to as shares of its width, lower and upper edge in metres."""
    if window is None:
        return [(0.0, 1.0, 0.0, height_m)]
    s0, s1, low, high = window
    return [(0.0, 1.0, 0.0, low), (0.0, 1.0, high, height_m), (0.0, s0, low, high), (s1, 1.0, low, high)]


def rectangle(
    a: Float[np.ndarray, "2"], b: Float[np.ndarray, "2"], shares: tuple[float, float], heights: tuple[float, float]
) -> Corners:
    """Polygon of a wall, counter-clockwise from the room.

    Args:
        a: Start of its foot on the floor (x, y), metres; the room is on the left of the way to `b`.
        b: End of its foot.
        shares: Part of the way that the polygon covers, from and to.
        heights: Levels of its lower and upper edge, metres.
    """
    start, end = a + shares[0] * (b - a), a + shares[1] * (b - a)
    return np.array([[*end, heights[0]], [*start, heights[0]], [*start, heights[1]], [*end, heights[1]]])
