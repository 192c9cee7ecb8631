from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.architecture.single_view.room_cues import EDGE_THRESHOLD, gather_room_cues, segment_axes
from tests.architecture.known_rooms import open_room
from tests.architecture.single_view.plain_cues import CAMERA
from tests.synthetic_rooms import box_room, cuboid, look, shoot


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
    planes = open_room((-3, -3), (-3, 2.4), (3, 5.6), (3, -3))
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
