"""Where a person can walk: a body's breadth from walls and furniture, under lamps, over rugs, through doors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely.geometry import LineString, Point, Polygon

from diorama_core.editing.footprints import footprint_of
from diorama_core.editing.walking import EYE_M, RADIUS_M, SIMPLIFY_M, WalkableFloor, walk_of
from diorama_core.scene.types import Architecture, Plane, Pose, Scene, SceneObject, Support
from tests.app.small_room import furnished_scene, room_planes


def _area(walk: WalkableFloor) -> shapely.Geometry:
    return shapely.build_area(shapely.GeometryCollection([LineString(r) for r in walk.rings]))


def _thing(category: str, size: tuple[float, float, float], place: tuple[float, float, float]) -> SceneObject:
    return SceneObject(f"{category}_9", category, category, "chair_a", size, Pose.upright(place))


def test_one_keeps_clear_of_walls_and_furniture() -> None:
    scene = furnished_scene()
    walk = walk_of(scene)
    assert walk is not None
    room = Polygon(scene.architecture.by_role("floor")[0].polygon[:, :2])
    stands = [Polygon(footprint_of(o)) for o in scene.objects if o.category in ("table", "chair")]
    for ring in walk.rings:
        along = LineString(ring).segmentize(0.02)
        for x, y in along.coords:
            near = min(Point(x, y).distance(g) for g in (room.exterior, *stands))
            assert near > RADIUS_M - 2 * SIMPLIFY_M
    assert _area(walk).buffer(0.001).contains(Point(walk.start))
    assert scene.camera is not None
    assert walk.eye_m == pytest.approx(float(scene.camera.position[2]))
    assert walk.heading_rad == pytest.approx(np.pi / 2, abs=1e-4)


def test_lamps_on_high_and_rugs_are_not_in_the_way() -> None:
    bare = replace(furnished_scene(), objects=(), supports=(), camera=None)
    lamp, rug = _thing("ceiling lamp", (0.5, 0.5, 0.4), (0, 1.4, 2.2)), _thing("rug", (1.5, 1.5, 0.02), (0, 1.4, 0.01))
    held = (Support(lamp.id, "ceiling", "mounted on"), Support(rug.id, "floor"))
    assert walk_of(replace(bare, objects=(lamp, rug), supports=held)) == walk_of(bare)
    walk = walk_of(bare)
    assert walk is not None
    assert walk.eye_m == EYE_M


def test_a_door_lets_pass_and_a_wall_does_not() -> None:
    first = room_planes()
    moved = [Plane(f"{p.id}_b", p.role, p.polygon + np.array([4.5, 0.0, 0.0])) for p in first]
    rooms = Scene(None, Architecture((*first, *moved)))
    closed = walk_of(rooms)
    assert closed is not None
    assert len(getattr(_area(closed), "geoms", [1])) == 2
    door = replace(_thing("door", (0.06, 0.9, 2.0), (2.25, 1.4, 1.0)), shape_size_m=(0.06, 0.9, 2.0))
    opened = walk_of(replace(rooms, objects=(door,), supports=(Support(door.id, "floor"),)))
    assert opened is not None
    assert len(getattr(_area(opened), "geoms", [1])) == 1
    assert _area(opened).contains(LineString([(0.0, 1.4), (4.5, 1.4)]))


def test_without_a_floor_nobody_walks() -> None:
    assert walk_of(Scene()) is None
