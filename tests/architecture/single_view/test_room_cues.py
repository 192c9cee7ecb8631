from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.architecture.single_view.room_cues import (
    EDGE_AXES,
    EDGE_THRESHOLD,
    PRIOR_MEDIAN_M,
    box_edges,
    gather_room_cues,
    segment_axes,
)
from diorama_core.geometry.casting import cast_planes
from tests.architecture.single_view.plain_cues import CAMERA, cues, drawn_edges
from tests.synthetic_rooms import box_room, cuboid, floor, look, shoot, wall

BOX = np.array([[-2.0, 2.0, 4.0, 2.6]])
"""Left, right and far wall, ceiling."""


@given(st.lists(st.tuples(*[st.floats(-1, 1)] * 3), min_size=1, max_size=8))
def test_rays_meet_the_face_that_ray_casting_says(rays) -> None:
    rays = np.array([r for r in rays if r[1] > 0.05 and np.abs(r).min() > 1e-6]).reshape(-1, 3)
    names = {"left": 0, "right": 0, "back": 1, "floor": 2, "ceiling": 2}
    planes = box_room(-2.0, 2.0, 4.0, 2.6)
    t, which = cast_planes(CAMERA.position, rays, planes)
    clear = np.sort(np.abs(_distances(rays)), axis=1)
    sure = clear[:, 1] - clear[:, 0] > 1e-6 if len(rays) else np.zeros(0, dtype=bool)
    expected = np.array([names[planes[i].id] for i in which], dtype=int)
    found = cues().hits(BOX, rays)[0]
    assert np.isfinite(t).all()
    np.testing.assert_array_equal(found[sure], expected[sure])


def _distances(rays: np.ndarray) -> np.ndarray:
    """Along each ray to the side, the far and the level face that it heads for."""
    o = CAMERA.position
    far = np.where(rays > 0, [2.0, 4.0, 2.6], [-2.0, np.inf, 0.0]) - o
    return far / np.where(np.abs(rays) < 1e-9, 1e-9, rays)


def test_a_line_that_stands_out_of_its_surface_costs_its_weight() -> None:
    to_far_wall = np.array([0.0, 1.0, 0.0])
    along_y = cues(directions=to_far_wall[None], ray_axes=np.array([1]), ray_weights=np.array([0.7]))
    along_x = cues(directions=to_far_wall[None], ray_axes=np.array([0]), ray_weights=np.array([0.7]))
    assert along_y.orientation(BOX) == pytest.approx([-0.7])
    assert along_x.orientation(BOX) == pytest.approx([0.0])
    assert cues().orientation(BOX) == pytest.approx([0.0])


def test_boundaries_run_along_their_axes_and_join_in_the_far_corners() -> None:
    edges = box_edges(BOX, 0.3)[0]
    along = edges[:, 1] - edges[:, 0]
    np.testing.assert_array_equal(np.abs(along).argmax(axis=1), EDGE_AXES)
    assert (np.count_nonzero(along, axis=1) == 1).all()
    assert edges[[0, 1, 5, 6], 0, 1] == pytest.approx([0.3] * 4)
    corners = {tuple(p) for p in edges.reshape(-1, 3) if p[1] == 4.0}
    assert corners == {(x, 4.0, z) for x in (-2.0, 2.0) for z in (0.0, 2.6)}


def test_the_box_whose_edges_are_seen_scores_best() -> None:
    left, right, back = ((-2, 0.3, 0), (-2, 4, 0)), ((2, 0.3, 0), (2, 4, 0)), ((-2, 4, 0), (2, 4, 0))
    uprights = [(2, (x, 4, 0), (x, 4, 2.6)) for x in (-2, 2)]
    seen = cues(edge_maps=drawn_edges(CAMERA, [(1, *left), (1, *right), (0, *back), *uprights]))
    others = BOX + np.array([[0, 0, 0, 0], [0.4, 0, 0, 0], [0, -0.4, 0, 0], [0, 0, 0.5, 0], [-0.3, 0.3, 0.3, 0]])
    found = seen.edges(others)
    assert found.shape == (5, 8)
    assert found.sum(axis=1).argmax() == 0
    np.testing.assert_allclose(cues().edges(others), 0.0, atol=1e-6)


def test_edges_behind_the_camera_or_out_of_the_picture_say_nothing() -> None:
    everywhere = cues(edge_maps=np.ones((3, 240, 320), np.float32))
    found = everywhere.edges(np.array([[-50.0, 50.0, 4.0, 80.0]]))[0]
    back = [k for k in range(8) if k != 2]
    assert found[2] > 0.1
    np.testing.assert_allclose(found[back], 0.0, atol=1e-9)
    behind = everywhere.edges(np.array([[-2.0, 2.0, -3.0, 2.6]]))[0]
    np.testing.assert_allclose(behind, 0.0, atol=1e-9)


def test_the_length_of_an_edge_counts_in_picture_diagonals() -> None:
    everywhere = cues(edge_maps=np.ones((3, 240, 320), np.float32))
    a, b = CAMERA.project(np.array([[-1.0, 4.0, 0.0], [1.0, 4.0, 0.0]]))
    expected = (1.0 - EDGE_THRESHOLD) * np.linalg.norm(a - b) / np.hypot(320, 240)
    assert everywhere.edges(np.array([[-1.0, 1.0, 4.0, 2.6]]))[0, 2] == pytest.approx(expected, rel=1e-5)


def test_objects_that_stick_out_cost_by_how_far_and_how_sure() -> None:
    two = cues(
        object_low=np.array([[-2.25, 1.0, 0.0], [0.0, 1.0, 0.0]]),
        object_high=np.array([[-1.0, 2.0, 1.0], [1.0, 2.0, 1.0]]),
        object_weights=np.array([3.0, 1.0]),
    )
    wide, tight, far = BOX, BOX - np.array([[0.3, 0, 0, 0]]), np.array([[2.0, 3.0, 4.0, 2.6]])
    # 0.25 m out of the left wall, once the scale, for three quarters of the weight.
    assert two.objects(wide) == pytest.approx([-0.75])
    assert two.objects(tight) == pytest.approx([0.0])
    assert two.objects(far) == pytest.approx([-2.0])


def test_what_hangs_higher_than_the_ceiling_costs_at_most_a_half() -> None:
    hung = cues(hung_top_m=2.8)
    found = hung.objects(np.array([[-2.0, 2.0, 4.0, top] for top in (3.0, 2.8, 2.55, 1.0)]))
    assert found == pytest.approx([0.0, 0.0, -0.25, -0.5])


def test_usual_rooms_are_preferred_and_large_ones_cost_linearly() -> None:
    depth = CAMERA.position[1]
    usual = np.array([-PRIOR_MEDIAN_M[0] / 2, PRIOR_MEDIAN_M[0] / 2, depth + PRIOR_MEDIAN_M[1], PRIOR_MEDIAN_M[2]])
    boxes = np.repeat(usual[None], 4, axis=0)
    boxes[1:, 2] = depth + PRIOR_MEDIAN_M[1] * np.exp([1.0, 2.0, 3.0])
    found = cues().prior(boxes)
    assert found[0] == pytest.approx(0.0)
    assert found[1] == pytest.approx(-2.0)
    assert found[2] - found[3] == pytest.approx(2.0)


def test_impossible_boxes_score_minus_infinity() -> None:
    possible = BOX[0]
    bad = [[-0.1, 2, 4, 2.6], [-2, 0.1, 4, 2.6], [-2, 2, 0.4, 2.6], [-2, 2, 4, 1.55]]
    scores = cues().score(np.array([possible, *bad]))
    assert np.isfinite(scores[0])
    assert (scores[1:] == -np.inf).all()


@given(axis=st.integers(0, 2), x=st.floats(-1.2, 1.2), y=st.floats(2.5, 5.0), z=st.floats(0.2, 2.2))
def test_segments_along_an_axis_are_told_by_its_vanishing_point(axis, x, y, z) -> None:
    camera = look(25.0, 12.0, 1.5)
    middle = np.array([x, y, z])
    # Where each axis leads in the picture from here, by a small step along it.
    ways = camera.project(middle + 1e-4 * np.eye(3)) - camera.project(middle)
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    sines = np.abs(ways[:, 0] * ways[axis, 1] - ways[:, 1] * ways[axis, 0])
    segment = np.concatenate([camera.project(middle), camera.project(middle)]) + np.outer([-20, 20], ways[axis]).ravel()
    (found,) = segment_axes(segment[None], camera)
    if np.delete(sines, axis).min() > 0.02:
        assert found == axis
    else:
        assert found in (axis, -1)


def test_segments_along_no_axis_and_no_segments_at_all() -> None:
    camera = look(25.0, 12.0, 1.5)
    start = np.array([-0.5, 3.0, 0.0])
    slanted = camera.project(np.stack([start, start + np.array([0.5, 0.5, 0.0])])).reshape(1, 4)
    assert segment_axes(slanted, camera).tolist() == [-1]
    assert len(segment_axes(np.zeros((0, 4)), camera)) == 0


def test_cues_of_a_photo_leave_the_furniture_out() -> None:
    camera = look(20.0, 12.0, fov_deg=70.0, size=(320, 240))
    wardrobe = cuboid("wardrobe", (-1.0, 3.0, 0.0), (0.6, 1.0, 1.8))
    lamp = cuboid("lamp", (0.5, 3.2, 1.9), (0.3, 0.3, 0.6))
    shot = shoot(camera, box_room(-2.0, 2.0, 4.0, 2.6), (wardrobe, lamp), ("wardrobe", "ceiling lamp"))
    found = gather_room_cues(shot.inputs.photo.rgb, camera, shot.objects, shot.cuboids)
    np.testing.assert_allclose(found.object_low, [wardrobe.corners_world.min(axis=0)])
    assert found.hung_top_m == pytest.approx(2.5)
    assert found.ray_weights.sum() == pytest.approx(1.0)
    assert len(found.directions) == len(found.ray_axes) == 3 * len(found.segment_rays)
    mask = next(o for o in shot.objects if o.id == "wardrobe").mask
    assert found.map_scale == 1.0
    np.testing.assert_allclose(found.edge_maps[:, mask], EDGE_THRESHOLD)
    # The true box explains the picture better than one a third as wide.
    assert found.score(np.array([[-2.0, 2.0, 4.0, 2.6]]))[0] > found.score(np.array([[-1.0, 0.7, 4.0, 2.6]]))[0]


def test_an_unsure_mask_hides_its_whole_box() -> None:
    camera = look(20.0, 12.0, fov_deg=70.0, size=(320, 240))
    shot = shoot(camera, box_room(-2.0, 2.0, 4.0, 2.6), (cuboid("chair", (0.0, 2.5, 0.0), (0.5, 0.5, 0.9), 30.0),))
    (chair,) = shot.objects
    unsure = replace(chair, mask_confidence=0.5)
    x1, y1, x2, y2 = (int(v) for v in chair.box)
    found = gather_room_cues(shot.inputs.photo.rgb, camera, (unsure,), shot.cuboids)
    np.testing.assert_allclose(found.edge_maps[:, y1:y2, x1:x2], EDGE_THRESHOLD)
    sure = gather_room_cues(shot.inputs.photo.rgb, camera, (chair,), shot.cuboids)
    assert (np.abs(sure.edge_maps[:, y1:y2, x1:x2] - EDGE_THRESHOLD) > 0.01).any()


def test_a_slanted_wall_gives_its_direction() -> None:
    planes = (
        floor((-3, -3), (3, -3), (3, 5.6), (-3, 2.4)),
        wall("left", (-3, -3), (-3, 2.4), 2.6),
        wall("slanted", (-3, 2.4), (3, 5.6), 2.6),
        wall("right", (3, 5.6), (3, -3), 2.6),
    )
    shot = shoot(look(0.0, 10.0, fov_deg=75.0, size=(480, 360)), planes)
    found = gather_room_cues(shot.inputs.photo.rgb, shot.camera, (), ())
    assert found.slants_rad == pytest.approx([np.arctan2(3.2, 6.0)], abs=np.deg2rad(6.0))
    assert found.slant_maps[0].shape == found.edge_maps[0].shape
    straight = shoot(look(0.0, 10.0, fov_deg=75.0, size=(480, 360)), box_room(-2.0, 2.0, 4.0, 2.6))
    assert gather_room_cues(straight.inputs.photo.rgb, straight.camera, (), ()).slants_rad == ()


def test_a_blank_picture_has_no_lines() -> None:
    found = gather_room_cues(np.full((240, 320, 3), 128, np.uint8), CAMERA, (), ())
    assert len(found.directions) == len(found.segment_rays) == 0
    assert found.edge_maps.max() == 0.0
    assert np.isfinite(found.score(BOX)).all()
