"""Elevations of walls: openings, what hangs or stands there, widths and heights. Metres, from left to right and up."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

import numpy as np
import shapely
from jaxtyping import Float

from diorama_core.errors import ExportError
from diorama_core.export.footprints import Outline, silhouette
from diorama_core.export.gathering import ExportObject, ExportScene
from diorama_core.export.plan import DIMENSION_GAP_M, Dimension, FloorPlan, Piece
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.geometry.rooms import rooms_of_objects, rooms_of_planes
from diorama_core.geometry.wall_lines import DrawnWall, Opening, wall_lines
from diorama_core.scene.support import descendants

AGAINST_M = 0.25
"""What stands no farther before a wall, behind its back a skirting board or a radiator, belongs to it."""
FRAME_M = 0.03
"""Width of the line around a wall."""
APART_M = 0.02
"""Lengths that are shorter are not written."""


def elevations(scene: ExportScene) -> tuple[FloorPlan, ...]:
    """A drawing of each wall, room by room.

    Raises:
        ExportError: the scene has no wall.
    """
    room_of, holds = rooms_of_planes(scene.scene), rooms_of_objects(scene.scene)
    names = {r.id: r.name for r in scene.scene.rooms}
    walls = wall_lines([p.plane for p in scene.planes], [o.item for o in scene.objects], scene.scene)
    order = {room: number for number, room in enumerate(names)}
    drawings, counts = [], dict[str, int]()
    for wall in sorted(walls, key=lambda w: order.get(room_of.get(w.plane.id, ""), len(order))):
        room = room_of.get(wall.plane.id, "")
        counts[room] = counts.get(room, 0) + 1
        name = f"{names.get(room, scene.name)}, wall {counts[room]}"
        items = [o for o in scene.objects if holds.get(o.id, "") == room or not names]
        drawings.append(_elevation(scene, wall, name, items))
    if not drawings:
        raise ExportError("the room has no walls to draw; export the floor plan instead")
    return tuple(drawings)


def _elevation(scene: ExportScene, wall: DrawnWall, name: str, items: Iterable[ExportObject]) -> FloorPlan:
    axes = np.array([[*wall.direction, 0.0], [0.0, 0.0, 1.0]])
    origin = np.array([wall.start @ wall.direction, wall.bottom_m])
    face = wall.plane.polygon @ axes.T - origin
    low, high = face.min(axis=0), face.max(axis=0)
    against = sorted(_against(scene, wall, items), key=lambda o: _back_distance_m(wall, o))
    fills = tuple(_opening(wall, o) for o in wall.openings)
    pieces = tuple(_piece(scene, o, axes, origin) for o in against)
    openings = [_extent(p) for p in fills]
    things = [_extent(p) for p in pieces if p.on_floor and p.outlines]
    holes = [shapely.box(*b.ravel()) for b in openings]
    whole = shapely.union_all([shapely.make_valid(shapely.Polygon(face)), *holes])
    frame = [shapely.orient_polygons(whole.buffer(wide, join_style="mitre")).exterior for wide in (FRAME_M, 0.0)]
    outer, inner = (np.asarray(ring.coords)[:-1] for ring in frame)
    nothing: list[Float[np.ndarray, "2 2"]] = []
    chains = (
        (0, low, high, openings, things),
        (1, low, high, openings, nothing),
        (1, high, low, nothing, things),
    )
    return FloorPlan(
        name=name,
        floors=(face,),
        walls=(outer, inner[::-1]),
        door_leaves=(),
        window_panes=(),
        pieces=(*fills, *pieces),
        dimensions=tuple(d for chain in chains for d in _chain(*chain)),
        kind="Wall elevation",
    )


def _against(scene: ExportScene, wall: DrawnWall, items: Iterable[ExportObject]) -> list[ExportObject]:
    """Objects at a wall, and what stands on them; doors and windows are drawn as openings."""
    at_wall = set[str]()
    for item in items:
        along = (item.item.corners_world[:, :2] - wall.start) @ wall.direction
        over = min(float(along.max()), wall.length_m) - max(float(along.min()), 0.0)
        if -AGAINST_M < _back_distance_m(wall, item) < AGAINST_M and over > APART_M:
            at_wall |= {item.id, *descendants(scene.scene, item.id)}
    return [o for o in scene.objects if o.id in at_wall and o.item.category not in OPENING_CATEGORIES]


def _back_distance_m(wall: DrawnWall, item: ExportObject) -> float:
    """Distance of an object's back before a wall."""
    return float((item.item.corners_world @ wall.plane.normal).min()) - wall.plane.offset


def _opening(wall: DrawnWall, opening: Opening) -> Piece:
    low, high = np.array([[opening.from_m, opening.bottom_m], [opening.to_m, opening.top_m]]) - [0.0, wall.bottom_m]
    outline = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
    label = "door" if opening.is_door else "window"
    width, height = (float(v) for v in high - low)
    size = wall.plane.thickness, width
    return Piece(opening.id, label, (outline,), size, height, False, True, opening.bottom_m, upright=True)


def _piece(
    scene: ExportScene, item: ExportObject, axes: Float[np.ndarray, "2 3"], origin: Float[np.ndarray, "2"]
) -> Piece:
    outlines = tuple(o - origin for o in silhouette(scene, item, axes))
    extent = np.ptp(item.item.corners_world @ axes.T, axis=0)
    carried = item.support is not None and scene.scene.has_object(item.support.parent)
    bottom = float(item.item.corners_world[:, 2].min())
    return Piece(
        item.id,
        item.item.label,
        outlines,
        (float(item.item.size_m[0]), float(extent[0])),
        float(extent[1]),
        overhead=False,
        on_floor=not carried,
        bottom_m=bottom,
        upright=True,
    )


def _extent(piece: Piece) -> Float[np.ndarray, "2 2"]:
    points: Outline = np.concatenate(piece.outlines)
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _chain(
    axis: int,
    near: Float[np.ndarray, "2"],
    far: Float[np.ndarray, "2"],
    openings: Iterable[Float[np.ndarray, "2 2"]],
    things: Iterable[Float[np.ndarray, "2 2"]],
) -> Iterator[Dimension]:
    """Lengths along one axis on the side of `near`: between the ends of things, of openings, and the whole."""
    low, high = sorted((float(near[axis]), float(far[axis])))
    away = np.sign(near[1 - axis] - far[1 - axis]) * DIMENSION_GAP_M * np.eye(2)[1 - axis]
    ends = ([v for b in boxes for v in b[:, axis]] for boxes in (things, openings))
    rows = [sorted({low, high, *np.clip(row, low, high).tolist()}) for row in ends]
    known = set[tuple[float, ...]]()
    for row in (*rows, [low, high]):
        stops = [low, *(b for a, b in pairwise(row) if b - a > APART_M and b < high - APART_M), high]
        if len(stops) > 2 or row == [low, high]:
            if (key := tuple(stops)) in known:
                continue
            known.add(key)
            for a, b in pairwise(stops):
                points = np.tile(near, (2, 1))
                points[:, axis] = a, b
                yield Dimension(points[0], points[1], len(known) * away)
