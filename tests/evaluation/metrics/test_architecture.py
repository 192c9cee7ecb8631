"""The room metrics on layouts whose answers are worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.evaluation.metrics.architecture import (
    architecture_scores,
    centred_chamfer,
    depth_rmse,
    edge_error,
    layout_edges,
    match_planes,
    pixel_error,
    plane_points,
    segment_iou,
    segment_pairs,
    visible_points,
)
from diorama_core.scene.types import Camera, Plane
from tests.synthetic_rooms import box_room, look, wall

ROOM = box_room(-2.0, 2.0, 4.0, 2.6)


def halves(columns, width=20, height=10):
    labels = np.zeros((height, width), dtype=int)
    labels[:, columns:] = 1
    return labels


def test_the_same_layout_is_perfect_whatever_its_numbers():
    truth = halves(8)
    renamed = 5 - 3 * truth
    assert segment_iou(renamed, truth) == 1.0
    assert pixel_error(renamed, truth) == 0.0
    assert edge_error(renamed, truth) == 0.0


def test_a_wall_edge_two_columns_off():
    found, truth = halves(10), halves(8)
    # Segments of 10 and 10 columns against 8 and 12: overlaps 8/10 and 10/12.
    assert segment_iou(found, truth) == pytest.approx((0.8 + 10 / 12) / 2)
    assert pixel_error(found, truth) == pytest.approx(2 / 20)
    assert edge_error(found, truth) == pytest.approx(2.0)


def test_a_missing_wall():
    found, truth = np.zeros((10, 20), dtype=int), halves(15)
    assert segment_pairs(found, truth) == (((0, 0, 0.75),), 1, 2)
    assert segment_iou(found, truth) == pytest.approx(2 * 0.75 / 3)
    assert pixel_error(found, truth) == pytest.approx(0.25)
    assert edge_error(found, truth) == pytest.approx(np.hypot(10, 20))


def test_matching_takes_the_largest_overlap_first():
    truth = halves(10)
    found = np.zeros_like(truth)
    found[:, 6:10], found[:, 10:] = 1, 2
    pairs, ours, theirs = segment_pairs(found, truth)
    assert (ours, theirs) == (3, 2)
    assert pairs == ((2, 1, 1.0), (0, 0, 0.6))
    assert segment_iou(found, truth) == pytest.approx(2 * 1.6 / 5)
    assert pixel_error(found, truth) == pytest.approx(4 / 20)


def test_pixels_without_a_true_plane_do_not_count():
    truth = halves(10)
    truth[:, :5] = -1
    found = halves(10)
    assert pixel_error(found, truth) == 0.0
    assert segment_iou(found, truth) == pytest.approx((0.5 + 1.0) / 2)


def test_nothing_against_nothing():
    nothing = np.full((4, 4), -1)
    assert segment_iou(nothing, nothing) == 1.0
    assert edge_error(nothing, nothing) == 0.0
    assert np.isnan(depth_rmse(np.full((4, 4), np.inf), np.full((4, 4), np.inf)))


def test_edges_lie_between_planes_and_not_on_the_border():
    edges = layout_edges(halves(8))
    assert edges.sum() == 10
    assert edges[:, 7].all()


def test_depth_error_counts_only_what_both_see():
    truth = np.array([[1.0, 2.0], [3.0, np.inf]])
    found = np.array([[1.3, 1.6], [np.inf, 9.0]])
    assert depth_rmse(found, truth) == pytest.approx(np.sqrt((0.09 + 0.16) / 2))


def test_chamfer_forgets_where_the_rooms_are_but_not_their_shape():
    square = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    assert centred_chamfer(square + np.array([5.0, -3, 2]), square) == pytest.approx(0.0)
    # Twice as large: every corner is half a diagonal from its counterpart, both ways.
    assert centred_chamfer(2 * square, square) == pytest.approx(2 * np.hypot(0.5, 0.5))
    assert np.isnan(centred_chamfer(square[:0], square))


def test_points_cover_a_plane_evenly():
    notched = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 2], [2, 0, 2], [2, 0, 0], [3, 0, 0], [3, 0, 3], [0, 0, 3]])
    points = plane_points((Plane("wall", "wall", notched.astype(float)),), 0.1)
    assert len(points) == pytest.approx(700, abs=2)
    assert not ((points[:, 0] > 1) & (points[:, 0] < 2) & (points[:, 2] < 2)).any()


def test_a_room_against_itself():
    scores = architecture_scores(ROOM, ROOM, look(10, 5))
    assert (scores.iou, scores.pixel_error, scores.edge_error_px, scores.recall, scores.precision) == (1, 0, 0, 1, 1)
    assert scores.depth_rmse_m == pytest.approx(0.0, abs=1e-9)
    assert scores.cdb_m == pytest.approx(0.0, abs=1e-9)


def test_only_what_the_picture_shows_counts_as_seen():
    near, far = wall("near", (-1, 3), (0, 3), 2.0), wall("far", (-1, 6), (1, 6), 2.0)
    points = visible_points((near, far), look(0, 0, height_m=1.0))
    # Of the far wall the near one hides its left half, which it covers twice over from here; all else is in view.
    assert np.isclose(points[:, 1], 3).sum() == 20 * 40
    rest = points[np.isclose(points[:, 1], 6)]
    assert rest[:, 0].min() > 0
    assert len(rest) == 20 * 40
    assert not len(visible_points((wall("behind", (1, -2), (-1, -2), 2.0),), look(0, 0)))


def test_rooms_that_differ_behind_the_camera_look_alike():
    fourth = (*ROOM, wall("fourth", (2, -5), (-2, -5), 2.6))
    longer = (*box_room(-2.0, 2.0, 4.0, 2.6, y0=-5.0), fourth[-1])
    scores = architecture_scores(ROOM, longer, look(0, 5))
    assert scores.cdb_seen_m == pytest.approx(0.0, abs=1e-3)
    # Centred, the boxes of 7 and 9 metres leave each back wall a metre from its like, and one wall without any.
    assert scores.cdb_m > 0.25


def test_the_seen_part_of_a_taller_wall():
    truth, found = wall("w", (-1, 5), (1, 5), 2.0), wall("w", (-1, 5), (1, 5), 2.4)
    scores = architecture_scores((found,), (truth,), look(0, 0, height_m=1.0))
    # 0.2 m stand out above and below after centring; their 8 rows lie 0.025 to 0.175 m from the nearest row.
    rows = np.array([0.025, 0.075, 0.125, 0.175])
    assert scores.cdb_seen_m == pytest.approx(2 * (rows + 0.0).sum() / 48, abs=0.03)


def test_a_far_wall_ten_centimetres_off():
    moved = box_room(-2.0, 2.0, 4.1, 2.6)
    camera = look(0, 0)
    scores = architecture_scores(moved, ROOM, camera, angle_deg=1.0, offset_m=0.05)
    assert scores.recall == pytest.approx(scores.precision)
    assert scores.recall < 1.0
    assert match_planes(moved, ROOM, camera, angle_deg=1.0, offset_m=0.05).missed == ("back",)
    assert 0.0 < scores.depth_rmse_m <= 0.1
    loose = match_planes(moved, ROOM, camera, angle_deg=1.0, offset_m=0.15)
    assert {m.true_id: round(m.offset_m, 6) for m in loose.matches}["back"] == pytest.approx(0.1)


def test_a_turned_wall_is_measured_in_degrees():
    run = 4 * np.tan(np.deg2rad(3.0))
    turned = (*ROOM[:1], wall("turned", (-2, 4 - run / 2), (2, 4 + run / 2), 2.6), *ROOM[2:])
    found = match_planes(turned, ROOM, look(), angle_deg=5.0, offset_m=0.1).matches
    assert next(m.angle_deg for m in found if m.true_id == "back") == pytest.approx(3.0)


def test_the_two_worlds_may_differ():
    camera = look(10, 5)
    T = np.eye(4)
    T[:3, 3] = (3.0, -2.0, 0.5)
    T[:2, :2] = [[0, -1], [1, 0]]
    elsewhere = Camera(camera.intrinsics, T @ camera.T_world_camera)
    moved = tuple(replace(p, polygon=p.polygon @ T[:3, :3].T + T[:3, 3]) for p in ROOM)
    scores = architecture_scores(moved, ROOM, camera, found_camera=elsewhere)
    assert (scores.recall, scores.precision) == (1.0, 1.0)
    assert scores.iou == pytest.approx(1.0, abs=1e-3)
    assert scores.cdb_m == pytest.approx(0.0, abs=1e-6)
