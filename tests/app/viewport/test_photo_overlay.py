from __future__ import annotations

import numpy as np
import pytest

from diorama_app.viewport.photo_overlay import LAYER_DEPTH_M, OVERLAY_DEPTH_M, PhotoCamera, PhotoOverlay
from tests.app.people import LocalClient, node
from tests.app.small_room import photo_camera, plain_photo

CAMERA = photo_camera()
RGB = plain_photo().rgb


@pytest.fixture
def overlay(server):
    yield PhotoOverlay(LocalClient(server, 0))
    server.scene.reset()


def test_the_photo_over_the_model_covers_exactly_what_its_camera_saw(server, overlay) -> None:
    overlay.show_overlay(CAMERA, RGB, 0.5)
    assert overlay.opacity == 0.5
    shown, k = node(server, "/photo_overlay"), CAMERA.intrinsics
    T_camera_world = np.linalg.inv(CAMERA.T_world_camera)
    centre = T_camera_world[:3, :3] @ shown.position + T_camera_world[:3, 3]
    assert centre[2] == pytest.approx(OVERLAY_DEPTH_M)
    left = k.fx * (centre[0] - shown.render_width / 2) / centre[2] + k.cx
    bottom = k.fy * (centre[1] + shown.render_height / 2) / centre[2] + k.cy
    np.testing.assert_allclose((left, bottom), (0.0, k.height), atol=1e-6)
    overlay.show_overlay(CAMERA, RGB, 0.0)
    assert overlay.opacity == 0.0
    assert node(server, "/photo_overlay") is None


def test_the_backdrop_stands_where_it_is_asked_and_goes_without_a_photo(server, overlay) -> None:
    overlay.show_backdrop(CAMERA, RGB, 7.0)
    away = CAMERA.T_world_camera[:3, 2] @ (node(server, "/photo_backdrop").position - CAMERA.position)
    assert away == pytest.approx(7.0)
    overlay.show_backdrop(None, None, 7.0)
    assert node(server, "/photo_backdrop") is None


def test_leaving_the_photo_takes_its_layer_away_and_shows_where_it_was_taken(server, overlay) -> None:
    overlay.show_cameras([PhotoCamera("", CAMERA, RGB, lambda: None)])
    assert node(server, "/photo_camera").visible
    overlay.camera_moved(through_photo=True)
    assert not node(server, "/photo_camera").visible
    overlay.show_layer(CAMERA, np.zeros((6, 8, 4), dtype=np.uint8))
    assert LAYER_DEPTH_M < OVERLAY_DEPTH_M
    overlay.camera_moved(through_photo=False)
    assert node(server, "/photo_evidence") is None
    assert node(server, "/photo_camera").visible


def test_the_pyramid_is_drawn_anew_only_for_another_camera_or_photo(server, overlay, monkeypatch) -> None:
    overlay.show_cameras([PhotoCamera("", CAMERA, RGB, lambda: None)])
    first = node(server, "/photo_camera")
    overlay.show_cameras([PhotoCamera("", CAMERA, RGB, lambda: None)])
    assert node(server, "/photo_camera") is first
    overlay.show_cameras([PhotoCamera("", CAMERA, RGB.copy(), lambda: None)])
    assert node(server, "/photo_camera") is not first
    overlay.show_cameras([])
    assert node(server, "/photo_camera") is None


def test_a_pyramid_made_in_the_view_through_it_is_hidden(server, overlay) -> None:
    overlay.camera_moved(through_photo=True)
    overlay.show_cameras([PhotoCamera("", CAMERA, None, lambda: None)])
    assert not node(server, "/photo_camera").visible
