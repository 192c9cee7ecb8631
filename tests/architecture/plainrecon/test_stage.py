"""The published pipeline: its clusters, its bounds, and what it gives on known rooms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.plainrecon.bounds import PlaneSheet, fit_sheet, join_walls, upright
from diorama_core.architecture.plainrecon.clusters import planar_clusters
from diorama_core.architecture.plainrecon.stage import PlainRecon
from diorama_core.evaluation.metrics.architecture import architecture_scores, match_planes
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod
from tests.synthetic_rooms import box_room, cuboid, look, shoot

FURNITURE = (cuboid("cabinet", (-1.0, 2.5, 0), (0.6, 1.0, 0.8)), cuboid("stand", (0.8, 2.2, 0), (0.5, 0.5, 0.9)))
FLOOR = PlaneSheet(np.array([0.0, 0.0, 1.0]), 0.0, np.array([[-2.0, 0, 0], [2, 0, 0], [2, 4, 0], [-2, 4, 0]]))


def grid(origin, u, v, count=60):
    steps = np.linspace(0.0, 1.0, count)
    return (origin + steps[:, None, None] * np.array(u) + steps[None, :, None] * np.array(v)).reshape(-1, 3)


def test_parallel_walls_are_told_apart_and_small_pieces_go_to_the_nearest():
    near = grid([0.0, 0, 0], [0, 2.0, 0], [0, 0, 2.0])
    far = grid([3.0, 0, 0], [0, 2.0, 0], [0, 0, 2.0])
    crumb = grid([3.0, 4.0, 0], [0, 0.2, 0], [0, 0, 0.2], 10)
    points = np.concatenate([near, far, crumb])
    normals = np.tile([1.0, 0.0, 0.0], (len(points), 1))
    labels = planar_clusters(points, normals)
    assert len(set(labels[: len(near)])) == 1
    assert len(set(labels[len(near) :])) == 1
    assert labels[0] != labels[-1]


def test_few_points_have_no_cluster():
    assert (planar_clusters(np.zeros((50, 3)), np.tile([0.0, 0, 1], (50, 1))) == -1).all()


def test_a_sheet_is_the_smallest_rectangle_and_faces_the_eye():
    turned = np.array([np.cos(0.5), np.sin(0.5), 0.0])
    sheet = fit_sheet(grid([1.0, 3, 0.5], 2.0 * turned, [0, 0, 1.5]), np.zeros(3))
    sides = sorted(np.linalg.norm(sheet.corners - np.roll(sheet.corners, 1, axis=0), axis=1))
    assert sides == pytest.approx([1.5, 1.5, 2.0, 2.0], abs=0.02)
    assert sheet.offset < 0
    assert abs(sheet.normal @ turned) < 1e-3


def test_a_leaning_wall_is_turned_about_its_foot():
    leaning = np.array([0.0, -np.cos(0.1), np.sin(0.1)])
    offset = float(leaning @ [0.0, 4.0, 0.0])
    corners = np.array([[-1.0, 4, 0], [1, 4, 0], [1, 4.2, 2], [-1, 4.2, 2]])
    wall = upright(PlaneSheet(leaning, offset, corners), FLOOR)
    np.testing.assert_allclose(wall.normal, [0, -1, 0], atol=1e-9)
    assert wall.offset == pytest.approx(-4.0)
    assert np.abs(wall.corners @ wall.normal - wall.offset).max() < 1e-9


def test_walls_come_down_to_the_floor_and_share_their_corner():
    back = PlaneSheet(
        np.array([0.0, -1, 0]), -4.0, np.array([[-1.8, 4.0, 0.2], [1.7, 4, 0.2], [1.7, 4, 2], [-1.8, 4, 2]])
    )
    side = PlaneSheet(
        np.array([-1.0, 0, 0]), -2.0, np.array([[2.0, 3.8, 0.1], [2, 0, 0.1], [2, 0, 2.1], [2, 3.8, 2.1]])
    )
    a, b = join_walls(FLOOR, [back, side])
    for wall in (a, b):
        assert (np.linalg.norm(wall.corners - [2.0, 4.0, 0.0], axis=1) < 1e-9).sum() == 1
        assert np.isclose(wall.corners[:, 2], 0.0).sum() == 2
    assert a.corners[:, 0].max() == pytest.approx(2.0)


def test_floor_and_walls_of_a_known_room_and_no_ceiling():
    shot = shoot(look(15, 5, fov_deg=75), box_room(-1.8, 2.2, 4.0, 2.6), FURNITURE)
    estimate = PlainRecon().reconstruct(shot.inputs, shot.objects, shot.geometry, Progress())
    matches = match_planes(estimate.architecture.planes, shot.planes, shot.camera, angle_deg=3, offset_m=0.05)
    assert {m.true_id for m in matches.matches} >= {"floor", "back", "left"}
    assert not matches.spurious
    assert not estimate.architecture.by_role("ceiling")
    assert architecture_scores(estimate.architecture.planes, shot.planes, shot.camera).pixel_error < 0.25
    again = PlainRecon().reconstruct(shot.inputs, shot.objects, shot.geometry, Progress())
    assert estimate == again


def test_walls_and_floor_of_acdc_are_planes_of_what_is_seen_of_them():
    shot = shoot(look(15, 5, fov_deg=75), box_room(-1.8, 2.2, 4.0, 2.6), FURNITURE[:1])
    estimate = PlainRecon(method=RoomMethod.ACDC).reconstruct(shot.inputs, shot.objects, shot.geometry, Progress())
    matches = match_planes(estimate.architecture.planes, shot.planes, shot.camera, angle_deg=3, offset_m=0.05)
    assert {m.true_id for m in matches.matches} >= {"floor", "back", "left"}
    assert estimate.source.method == RoomMethod.ACDC
    assert not estimate.architecture.by_role("ceiling")
    assert all(abs(w.normal[2]) < 1e-3 for w in estimate.architecture.by_role("wall"))
    # The picture's lower edge cuts the floor: nothing is carried on beyond what is seen.
    assert architecture_scores(estimate.architecture.planes, shot.planes, shot.camera).cdb_m > 0.2


@pytest.mark.parametrize("method", [RoomMethod.PLAINRECON, RoomMethod.ACDC])
def test_needs_depth(method):
    shot = shoot(look(), box_room(-2.0, 2.0, 3.5, 2.6))
    with pytest.raises(ValueError, match="measured depth"):
        PlainRecon(method=method).reconstruct(replace(shot.inputs, depth_m=None), (), shot.geometry, Progress())
