from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest
import trimesh
from shapely.geometry import Polygon

from diorama_core.errors import InputError
from diorama_core.importing.measured_cloud import measure_cloud
from diorama_core.importing.measured_room import open_room, possible_kinds
from diorama_core.importing.point_cloud import PointCloud
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import yaw_rotation
from tests.importing.scans import DEPTH, FURNITURE, HEIGHT, TURN, WIDTH, room_points

UP = np.array([0.0, 0.0, 1.0])


def sides(polygon: Polygon) -> list[float]:
    ring = np.asarray(polygon.exterior.coords)
    return sorted(np.linalg.norm(np.diff(ring, axis=0), axis=1))


@pytest.mark.parametrize(("every", "off_m"), [(1, 0.08), (12, 0.12), (40, 0.12)])
def test_walls_floor_and_boxes_are_where_the_points_are(every: int, off_m: float) -> None:
    room = measure_cloud(PointCloud(room_points()[::every], UP))
    assert len(room.walls) == 4
    assert sides(Polygon(room.floors[0].outline)) == pytest.approx([DEPTH, DEPTH, WIDTH, WIDTH], abs=0.02)
    assert max(w.polygon[:, 2].max() for w in room.walls) == pytest.approx(HEIGHT, abs=0.02)
    assert len(room.boxes) == len(FURNITURE)
    found = sorted((sorted(b.size_m) for b in room.boxes), key=max)
    true = sorted((sorted(f.size_m) for f in FURNITURE), key=max)
    assert np.abs(np.array(found) - np.array(true)).max() < off_m


def test_a_rug_is_found_on_the_floor() -> None:
    rug = trimesh.creation.box((1.2, 1.8, 0.02), trimesh.transformations.translation_matrix((0.9, 0.3, 0.01)))
    rng = np.random.default_rng(2)
    points = np.asarray(trimesh.sample.sample_surface(rug, 6000, seed=2)[0]) + rng.normal(0, 0.002, (6000, 3))
    whole = np.concatenate([room_points(), points[points[:, 2] > 0.01] @ yaw_rotation(TURN).T + [0.0, 0.0, 12.0]])
    under = (np.abs((whole @ yaw_rotation(TURN))[:, :2] - [0.9, 0.3]) < [0.6, 0.9]).all(axis=1) & (whole[:, 2] < 12.01)
    room = measure_cloud(PointCloud(whole[~under], UP))
    (found,) = (box for box in room.boxes if "rug" in box.kinds)
    assert sorted(found.size_m) == pytest.approx([0.02, 1.2, 1.8], abs=0.08)
    assert "rug" in possible_kinds(found.kinds, found.size_m)


def test_the_axis_that_points_up_is_found() -> None:
    lying = room_points() @ np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]).T  # +Y up, as phones write
    room = measure_cloud(PointCloud(lying, None))
    assert max(w.polygon[:, 2].max() for w in room.walls) == pytest.approx(HEIGHT, abs=0.02)
    assert len(room.boxes) == len(FURNITURE)


def test_a_corner_that_is_not_of_the_room_is_left_out() -> None:
    room = measure_cloud(PointCloud(room_points(corner=True), UP))
    assert len(room.walls) == 6
    area = WIDTH * DEPTH - (WIDTH / 2 - 0.6) * (DEPTH / 2 - 0.3)
    assert Polygon(room.floors[0].outline).area == pytest.approx(area, rel=0.02)


def test_the_room_opens_as_a_scene_whose_things_stand_with_their_backs_to_walls() -> None:
    opened = open_room(measure_cloud(PointCloud(room_points(), UP)), built_in_library())
    scene = opened.scene
    assert [len(scene.architecture.by_role(r)) for r in ("floor", "wall", "ceiling")] == [1, 4, 1]
    assert len(scene.objects) == len(FURNITURE)
    for item in scene.objects:
        assert item.corners_world[:, 2].min() == pytest.approx(0.0, abs=0.01)
        assert scene.support_of(item.id).parent == "floor"
    tall = max(scene.objects, key=lambda o: o.size_m[2])
    back = tall.pose.position - tall.pose.R_world_object[:, 0] * tall.size_m[0] / 2
    assert min(abs(w.normal @ back - w.offset) for w in scene.architecture.by_role("wall")) < 0.1
    assert any("kinds of objects are guessed" in line for line in opened.changes)


def test_what_is_no_room_is_one_line() -> None:
    flat = np.column_stack([room_points()[:, :2], np.full(len(room_points()), 12.0)])
    with pytest.raises(InputError, match="nothing rises"):
        measure_cloud(PointCloud(flat, None))
    rng = np.random.default_rng(0)
    flat = np.column_stack([rng.uniform(0, 4, (5000, 2)), rng.normal(0, 0.002, 5000)])
    with pytest.raises(InputError, match="no room in the points"):
        measure_cloud(PointCloud(flat, UP))
    with pytest.raises(InputError, match="more than 60 m"):
        measure_cloud(PointCloud(1000 * flat, UP))
    with pytest.raises(InputError, match="more than 60 m"):  # a histogram of them would fill all memory
        measure_cloud(PointCloud(1e6 * flat, None))
    with pytest.raises(InputError, match="too far from the file's zero"):
        measure_cloud(PointCloud(flat + 1e30, None))
    for points in (np.zeros((5000, 3)), np.column_stack([np.linspace(0, 5, 5000), np.zeros((5000, 2))])):
        with pytest.raises(InputError, match="no room in the points"):
            measure_cloud(PointCloud(points, UP))


@pytest.mark.parametrize(("floor", "ceiling"), [(False, True), (True, False), (False, False)])
def test_a_room_without_floor_or_ceiling_has_its_walls_and_things(floor: bool, ceiling: bool) -> None:
    points = room_points()
    height = points[:, 2] - points[:, 2].min()
    points = points[((height > 0.05) | floor) & ((height < HEIGHT - 0.05) | ceiling)]
    room = measure_cloud(PointCloud(points, UP))
    assert sides(Polygon(room.floors[0].outline)) == pytest.approx([DEPTH, DEPTH, WIDTH, WIDTH], abs=0.02)
    assert len(room.boxes) == len(FURNITURE)
    said = " ".join(room.notes)
    assert ("no floor was scanned" in said, "no ceiling was scanned" in said) == (not floor, not ceiling)


@pytest.mark.parametrize("top", [0.55, 0.8, 1.0])
def test_a_low_cloud_with_stray_points_below_its_floor_is_a_room_or_one_line(top: float) -> None:
    """With next to nothing above furniture the band of walls is all points, and began below the array of its levels."""
    rng = np.random.default_rng(771)
    floor = np.column_stack([rng.uniform(0, 4, (4000, 2)), rng.normal(0, 0.01, 4000)])
    few = np.column_stack([rng.uniform(0, 4, (150, 2)), rng.uniform(0, top, 150)])
    stray = np.column_stack([rng.uniform(0, 4, (3, 2)), np.full(3, -0.49)])
    with suppress(InputError):
        measure_cloud(PointCloud(np.vstack([floor, few, stray]), UP))
