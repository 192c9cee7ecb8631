from __future__ import annotations

import numpy as np
import pytest

from diorama_app.viewport.camera import DEFAULT_FOV_RAD, ViewCamera, fitting_fov, room_view
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.render.picture import looking_along
from tests.app.people import LocalClient
from tests.app.small_room import furnished_scene, photo_camera

FACING_NORTH = np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
"""Camera axes (OpenCV) that look along +Y with +Z up."""


@pytest.fixture
def moved() -> list[bool]:
    return []


@pytest.fixture
def camera(server, moved) -> ViewCamera:
    made = ViewCamera(LocalClient(server, 0), moved.append)
    made._viser_client.camera.wxyz = quaternion_wxyz(FACING_NORTH)
    return made


@pytest.mark.parametrize("aspect", [0.6, 1.0, 1.33, 2.2])
def test_the_whole_photo_fits_the_view(aspect) -> None:
    k = photo_camera().intrinsics
    fov = fitting_fov(k.width, k.height, k.fx, k.fy, k.cx, k.cy, aspect)
    assert np.tan(fov / 2) >= k.height / 2 / k.fy - 1e-12
    assert np.tan(fov / 2) * aspect >= k.width / 2 / k.fx - 1e-12


def test_the_whole_room_is_seen_from_outside() -> None:
    position, target = room_view(furnished_scene(), 0.7)
    assert np.linalg.norm(position - target) > 5.0


def test_a_move_says_that_the_view_leaves_the_photo_and_a_look_through_it_says_the_opposite(camera, moved) -> None:
    photo = photo_camera()
    camera.look_through(photo, 2.0)
    assert camera.through_photo
    assert moved == [True]
    np.testing.assert_allclose(camera.position, photo.position)
    np.testing.assert_allclose(camera.R_world_camera, photo.T_world_camera[:3, :3], atol=1e-12)
    np.testing.assert_allclose(camera.target_point, photo.position + 2.0 * photo.T_world_camera[:3, 2])
    camera.move(np.array([0.0, -4.0, 1.0]), np.zeros(3))
    assert not camera.through_photo
    assert moved == [True, False]
    assert camera.fov_rad == pytest.approx(float(DEFAULT_FOV_RAD))


def test_a_picture_of_the_view_has_its_place_and_its_height_of_view(camera) -> None:
    picture = camera.to_picture_camera(300, 200)
    np.testing.assert_allclose(picture.position, camera.position)
    np.testing.assert_allclose(picture.T_world_camera[:3, :3], FACING_NORTH, atol=1e-12)
    assert picture.intrinsics.vertical_fov_rad == pytest.approx(camera.fov_rad)


def test_approaching_keeps_the_direction_of_view(camera) -> None:
    before = camera.position - camera.target_point
    camera.approach(np.array([1.0, 1.0, 1.0]), 0.5)
    after = camera.position - camera.target_point
    assert np.linalg.norm(after) == pytest.approx(0.5)
    np.testing.assert_allclose(after / 0.5, before / np.linalg.norm(before))


def test_approaching_from_the_target_itself_comes_from_above(camera) -> None:
    camera.move(np.ones(3), np.ones(3))
    camera.approach(np.zeros(3), 1.0)
    assert camera.position[2] > 0.0


@pytest.mark.parametrize(
    ("eye", "right", "away"),
    [((0, -3, 1), (0, False), (1, False)), ((0, 3, 1), (0, True), (1, True)), ((-3, 0, 1), (1, True), (0, False))],
)
def test_directions_of_the_screen_are_axes_of_the_room(camera, eye, right, away) -> None:
    forward = np.array([0.0, 0.0, 1.0]) - np.array(eye, dtype=np.float64)
    camera._viser_client.camera.wxyz = quaternion_wxyz(looking_along(forward))
    for side, (axis, backward) in (("right", right), ("away", away)):
        unit, flipped = camera.screen_axis(side)
        assert (int(unit.argmax()), flipped) == (axis, backward)


def test_what_is_framed_stays_in_view_when_the_view_changes_its_shape_until_a_person_moves(camera) -> None:
    scene, handle = furnished_scene(), camera._viser_client.camera
    camera.frame(lambda aspect: room_view(scene, aspect))
    np.testing.assert_allclose(camera.position, room_view(scene, 1.3)[0])
    handle.aspect = 0.7
    camera.frame_again()
    np.testing.assert_allclose(camera.position, room_view(scene, 0.7)[0])
    handle.position = here = camera.position + 0.5
    handle.aspect = 1.3
    camera.frame_again()
    np.testing.assert_allclose(camera.position, here)
    camera.move(room_view(scene, 1.3)[0], np.zeros(3))
    handle.aspect = 0.7
    camera.frame_again()
    np.testing.assert_allclose(camera.position, room_view(scene, 1.3)[0], err_msg="another view took its place")
