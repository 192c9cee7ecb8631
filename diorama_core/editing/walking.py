"""Where a person can walk in a scene: the floor without walls and furniture, and where the walk begins.

Doors let pass: the wall is open over their width, and there is floor on both sides of them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float
from shapely.geometry import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import nearest_points

from diorama_core.editing.footprints import footprint_of
from diorama_core.editing.plan_edits import wall_feet
from diorama_core.geometry.openings import DOOR, OPENING_CATEGORIES
from diorama_core.geometry.rooms import Doorway, doorways, part_of_home, storeys_of
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Scene

RADIUS_M = 0.25
"""Radius of the upright capsule that a person is."""
STEP_M, HEAD_M = 0.2, 1.8
"""What is lower is stepped over, what hangs higher is passed under; from the floor."""
EYE_M = 1.6
EYES_M = (1.1, 2.0)
"""A photo taken from such a height was taken by a person, who walks with this eye."""
DOORSTEP_M = 1.2
"""Floor before and behind a door, also where the scene ends there."""
DOOR_SIDE_M = 0.02
"""A door leaves its frame free by this on each side."""
SIMPLIFY_M = 0.005


@dataclass(frozen=True)
class WalkableFloor:
    """A floor to walk on."""

    rings: tuple[tuple[tuple[float, float], ...], ...]
    """Closed outlines and holes of where the middle of a person may be (world, metres): inside an odd number."""
    start: tuple[float, float]
    heading_rad: float
    eye_m: float
    """Height of the eye in the world."""

    @property
    def json(self) -> str:
        """As the page's script takes it."""
        document = {"rings": self.rings, "start": self.start, "heading": self.heading_rad, "eye": self.eye_m}
        return json.dumps(document, separators=(",", ":"))


def walk_of(scene: Scene) -> WalkableFloor | None:
    """The walk through a scene, of a home through its lowest storey; None where no floor is large enough."""
    storeys = storeys_of(scene)
    scene = scene if len(storeys) < 2 else part_of_home(scene, [r.id for r in storeys[min(storeys)]])
    free = free_floor(scene, RADIUS_M)
    if free.is_empty:
        return None
    camera, level = scene.camera, floor_height(scene)
    ahead: tuple[float, ...]
    parts = sorted((p for p in getattr(free, "geoms", [free]) if isinstance(p, Polygon)), key=lambda p: -p.area)
    if camera is None:
        start, ahead, above = shapely.maximum_inscribed_circle(parts[0]).coords[0], (0.0, 1.0), EYE_M
    else:
        point = Point(camera.position[:2])
        start = (point if free.contains(point) else nearest_points(parts[0], point)[0]).coords[0]
        ahead = tuple(map(float, camera.T_world_camera[:2, 2]))
        above = float(camera.position[2]) - level
    eye = above if EYES_M[0] <= above <= EYES_M[1] else EYE_M
    rings = tuple(_ring(r) for p in parts for r in (p.exterior, *p.interiors))
    x, y = (float(v) for v in start[:2])
    return WalkableFloor(rings, (x, y), round(float(np.arctan2(ahead[1], ahead[0])), 4), round(level + eye, 4))


def free_floor(scene: Scene, radius_m: float) -> BaseGeometry:
    """Where the middle of somebody upright, so wide on each side, may be."""
    floors = [shapely.make_valid(Polygon(p.polygon[:, :2])) for p in scene.architecture.by_role("floor")]
    doors = [Polygon(_doorway_footprint(footprint_of(o))) for o in scene.objects if o.category == DOOR and not o.hidden]
    bare = (d for d in doorways(scene) if d.opening.object_id is None and d.opening.is_door)
    doors += [Polygon(_doorway_footprint(_passage(scene, d))) for d in bare]
    walls = shapely.unary_union([LineString([f.start, f.end]) for f in wall_feet(scene)])
    edges = shapely.unary_union([walls, *(f.exterior for f in floors if isinstance(f, Polygon))])
    in_way = shapely.unary_union([edges.difference(shapely.unary_union(doors)), *_furniture(scene)])
    return shapely.unary_union([*floors, *doors]).difference(in_way.buffer(radius_m)).simplify(SIMPLIFY_M)


def _furniture(scene: Scene) -> Iterator[Polygon]:
    level = floor_height(scene)
    for item in scene.objects:
        low, high = float(item.corners_world[:, 2].min()) - level, float(item.corners_world[:, 2].max()) - level
        if item.category not in OPENING_CATEGORIES and not item.hidden and high > STEP_M and low < HEAD_M:
            yield Polygon(footprint_of(item))


def _passage(scene: Scene, way: Doorway) -> Float[np.ndarray, "4 2"]:
    """Floor that a bare opening covers between its two faces."""
    out = scene.plane(way.walls[0]).normal[:2]
    along = np.array([-out[1], out[0]]) * (way.opening.to_m - way.opening.from_m) / 2
    deep = out * max(way.depth_m, DOOR_SIDE_M) / 2
    return np.array(way.at) + np.array([-along - deep, along - deep, along + deep, -along + deep])


def _doorway_footprint(quad: Float[np.ndarray, "4 2"]) -> Float[np.ndarray, "4 2"]:
    """A door's footprint, as deep as a step before and behind it."""
    middle = quad.mean(axis=0)
    sides = [quad[1] - quad[0], quad[2] - quad[1]]
    wide, deep = sorted(sides, key=lambda s: -float(np.linalg.norm(s)))
    along = wide / 2 * (1.0 - 2 * DOOR_SIDE_M / max(float(np.linalg.norm(wide)), 1e-6))
    across = deep / max(float(np.linalg.norm(deep)), 1e-6) * DOORSTEP_M
    return np.array([middle + a * along + b * across for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def _ring(ring: BaseGeometry) -> tuple[tuple[float, float], ...]:
    return tuple((round(float(x), 4), round(float(y), 4)) for x, y in ring.coords)
