"""Doors and windows cut the wall that they are in: the wall's outline without what they cover.

The scene's own planes stay whole, so that a door that is moved or removed leaves no trace. A wall with openings stays
one polygon: a door is a notch in its foot, a window is reached by a cut from below.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import manifold3d
import numpy as np
from jaxtyping import Float

from diorama_core.geometry.planes import plane_axes, signed_area
from diorama_core.scene.types import Architecture, Plane, Scene, SceneObject

OPENING_CATEGORIES = DOOR, WINDOW = ("door", "window")
REACH_M = 0.3
"""A door or window whose middle is no farther than this from a wall's face belongs to it."""
FRAME_M = 0.02
"""So much of a wall stays behind the rim of what fills the opening, and nothing is seen past it."""
FOOT_M = 0.05
"""What comes down to the floor this nearly reaches it."""
STANDS_OUT_M = 0.06
"""How far doors and windows stand out into the room."""
MIN_SIDE_M = 0.1

Contour = Float[np.ndarray, "_ 2"]


@dataclass(frozen=True)
class HomeSettings:
    """Distances within which faces are one wall, openings go through it, and objects are in a room."""

    thickest_m: float = 0.5
    """Two faces that look away from each other are one wall's up to this distance: a wall of stone."""
    facing: float = 0.98
    """Cosine from which on the faces of a wall are parallel: measured ones are a few degrees off."""
    min_opening_m: float = 0.15
    """Gaps in a wall's polygon that are narrower or lower than this are no opening."""
    border_m: float = 0.25
    """What is so near to a floor's border is still over it: what hangs in a doorway, or on the wall."""
    sinks_m: float = 0.3
    """A thing may reach so far below the floor that it stands on."""
    under_ceiling_m: float = 1.0
    """A point so far below a ceiling is in its room, and not on the floor above."""
    before_m: float = 0.1
    """A point so far before a wall's face is over the floor of the room that the wall is of."""


HOME = HomeSettings()


def wall_of(item: SceneObject, walls: Iterable[Plane], scene: Scene) -> Plane | None:
    """The wall that a door or window is in: the one it hangs on or stands against, or else the one right behind it."""
    edge = scene.support_of(item.id)
    named = () if edge is None else (edge.parent, *edge.adheres_to)
    candidates = tuple(walls)
    for wall in candidates:
        if wall.id in named:
            return wall
    near = [(abs(float(w.normal @ item.pose.position) - w.offset), w) for w in candidates if _is_along_wall(item, w)]
    distance, nearest = min(near, key=lambda pair: pair[0], default=(np.inf, None))
    return nearest if distance <= REACH_M else None


def faces_behind(wall: Plane, point: Float[np.ndarray, "3"], walls: Sequence[Plane]) -> tuple[Plane, ...]:
    """The other faces of a wall at a point of it: back to back with it, within the thickness of a wall.

    Args:
        wall: one face.
        point: on it or near it (world, m).
        walls: all faces.
    """
    if not walls:
        return ()
    normals = np.array([w.normal for w in walls])
    gaps = wall.offset - np.array([w.centre for w in walls]) @ wall.normal
    near = np.flatnonzero((normals @ wall.normal < -HOME.facing) & (gaps > -FRAME_M) & (gaps < HOME.thickest_m))
    return tuple(walls[k] for k in near.tolist() if _spans(walls[k], point))


def walls_cut_by(fills: Iterable[SceneObject], walls: Sequence[Plane], scene: Scene) -> Mapping[str, tuple[Plane, ...]]:
    """Faces that each door and window cuts, by its id: its wall's first, then those behind it."""
    cut = {}
    for item in fills:
        wall = wall_of(item, walls, scene)
        cut[item.id] = () if wall is None else (wall, *faces_behind(wall, item.pose.position, walls))
    return cut


def with_openings(scene: Scene) -> Scene:
    """The scene as it is drawn and written: every visible door and window cuts its wall, on both faces."""
    fills = [o for o in scene.objects if o.category in OPENING_CATEGORIES and not o.hidden]
    walls = scene.architecture.by_role("wall")
    if not fills or not walls:
        return scene
    cut = walls_cut_by(fills, walls, scene)
    by_wall = {w.id: [o for o in fills if any(w is c for c in cut[o.id])] for w in walls}
    planes = tuple(cut_wall(p, by_wall[p.id]) if by_wall.get(p.id) else p for p in scene.architecture.planes)
    return replace(scene, architecture=Architecture(planes))


def cut_wall(wall: Plane, fills: Collection[SceneObject]) -> Plane:
    """A wall without what doors and windows cover; whole where nothing or no single piece would be left."""
    return _without(wall, [item.corners_world for item in fills], FRAME_M)


def with_hole(wall: Plane, corners: Float[np.ndarray, "n 3"]) -> Plane:
    """A wall with a passage or a hatch that nothing fills; whole where nothing or no single piece would be left.

    Args:
        wall: the wall.
        corners: of the upright rectangle that is open, before or behind the wall.
    """
    return _without(wall, [corners], 0.0)


def _without(wall: Plane, covered: Sequence[Float[np.ndarray, "_ 3"]], frame_m: float) -> Plane:
    axes = np.stack(plane_axes(wall.normal), axis=1)
    outline = wall.polygon @ axes
    foot = float(outline[:, 1].min())
    rest = manifold3d.CrossSection([outline], manifold3d.FillRule.NonZero)
    whole = rest.area()
    for corners in covered:
        rest -= _rectangle(corners @ axes, foot, frame_m)
    if rest.area() < 1e-4 or rest.area() > whole - 1e-6 or len(rest.decompose()) != 1:
        return wall
    contours = [np.asarray(c, dtype=np.float64) for c in rest.to_polygons()]
    outer = next(c for c in contours if signed_area(c) > 0)
    holes = [c for c in contours if signed_area(c) < 0]
    flat = _with_slits(outer, holes)
    return replace(wall, polygon=flat @ axes.T + wall.offset * wall.normal)


def _spans(wall: Plane, point: Float[np.ndarray, "3"]) -> bool:
    u, v = plane_axes(wall.normal)
    return all(float((wall.polygon @ a).min()) <= float(point @ a) <= float((wall.polygon @ a).max()) for a in (u, v))


def _is_along_wall(item: SceneObject, wall: Plane) -> bool:
    u, _ = plane_axes(wall.normal)
    along, ends = float(item.pose.position @ u), wall.polygon @ u
    turned = abs(float(item.pose.R_world_object[:, 0] @ wall.normal)) > 0.8
    return turned and float(ends.min()) <= along <= float(ends.max())


def _rectangle(corners: Contour, foot: float, frame_m: float) -> manifold3d.CrossSection:
    """The rectangle that a door or window covers on its wall, less its frame; down to the floor where it stands."""
    (left, low), (right, high) = corners.min(axis=0) + frame_m, corners.max(axis=0) - frame_m
    if low - frame_m < foot + FOOT_M:
        low = foot - 1.0
    if right - left < MIN_SIDE_M or high - low < MIN_SIDE_M:
        return manifold3d.CrossSection()
    return manifold3d.CrossSection([[[left, low], [right, low], [right, high], [left, high]]])


def _with_slits(outer: Contour, holes: Sequence[Contour]) -> Contour:
    """One outline of a polygon with holes: each hole is reached by a cut straight down to what lies below it."""
    ring = outer
    for hole in sorted(holes, key=lambda h: float(h[:, 1].min())):
        first = int(np.lexsort((hole[:, 0], hole[:, 1]))[0])
        start = hole[first]
        edge, point = _edge_below(ring, start)
        around = np.concatenate([hole[first:], hole[: first + 1]])
        ring = np.concatenate([ring[: edge + 1], point[None], around, point[None], ring[edge + 1 :]])
    return ring


def _edge_below(ring: Contour, start: Float[np.ndarray, "2"]) -> tuple[int, Float[np.ndarray, "2"]]:
    """The edge of a ring straight below a point, nearest to it, and where it is met."""
    hits: list[tuple[float, int]] = []
    for number, (a, b) in enumerate(zip(ring, np.roll(ring, -1, axis=0), strict=True)):
        low, high = min(a[0], b[0]), max(a[0], b[0])
        if high - low < 1e-9 or not low <= start[0] <= high:
            continue
        height = float(a[1] + (start[0] - a[0]) / (b[0] - a[0]) * (b[1] - a[1]))
        if height <= start[1] + 1e-9:
            hits.append((height, number))
    height, edge = max(hits)
    return edge, np.array([start[0], height])
