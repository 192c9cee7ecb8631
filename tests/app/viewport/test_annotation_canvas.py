from __future__ import annotations

import asyncio
from types import SimpleNamespace

import numpy as np
import pytest

from diorama_app.viewport.annotation_canvas import CENTRE, AnnotationCanvas, FlatPhoto
from diorama_app.viewport.camera import ViewCamera
from diorama_core.artefacts import LabelledBox
from diorama_core.geometry.rotations import quaternion_wxyz
from tests.app.people import LocalClient

RGB = np.zeros((480, 640, 3), dtype=np.uint8)
FLAT = FlatPhoto(640, 480)


@pytest.fixture
def camera(server):
    made = ViewCamera(LocalClient(server, 0), lambda through_photo: None)
    # A browser answers a move with the attitude that follows; the canvas is looked at along +Y.
    made._viser_client.camera.wxyz = quaternion_wxyz(np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]))
    return made


@pytest.fixture
def canvas(server, camera):
    made = AnnotationCanvas(LocalClient(server, 0), camera)
    yield made
    made.close()
    server.scene.reset()


def drawn(server) -> set[str]:
    parents = ("/board/box", "/board/name")
    return {n for n in server.scene._handle_from_node_name if n.startswith("/board/") and n not in parents}


def test_screen_to_photo_pixels_is_exact_from_any_place_before_the_canvas(rng) -> None:
    for _ in range(20):
        pixels = rng.uniform((0, 0), (640, 480), (6, 2))
        origin = FLAT.to_world(np.array([320.0, 240.0]), lift_m=1.2) + rng.normal(0, 0.2, 3)
        np.testing.assert_allclose(FLAT.to_pixels(origin, FLAT.to_world(pixels) - origin), pixels, atol=1e-6)


def test_boxes_end_at_the_photo_s_edges_and_specks_are_none() -> None:
    assert FLAT.box_around(np.array([[-50.0, 10.0], [700.0, 90.0]])) == (0.0, 10.0, 640.0, 90.0)
    assert FLAT.box_around(np.array([[5.0, 5.0], [7.0, 90.0]])) is None
    assert FLAT.box_around(np.array([[-90.0, 10.0], [-5.0, 90.0]])) is None


def test_the_whole_photo_is_in_view(canvas, camera) -> None:
    canvas.open(RGB, None)
    corners = FLAT.to_world(np.array([[0.0, 0.0], [640.0, 480.0]])) - camera.position
    up = np.abs(corners[:, 2] / corners[:, 1]).max()
    across = np.abs(corners[:, 0] / corners[:, 1]).max()
    assert up < np.tan(camera.fov_rad / 2)
    assert across < np.tan(camera.fov_rad / 2) * camera.aspect


def test_a_rectangle_on_the_screen_is_a_box_of_the_photo(canvas, camera) -> None:
    boxes: list = []
    canvas.open(RGB, boxes.append)
    half = np.tan(camera.fov_rad / 2)
    wanted = np.array([[100.0, 120.0], [300.0, 360.0]])
    seen = FLAT.to_world(wanted) - camera.position
    screen = [(0.5 + s[0] / s[1] / half / camera.aspect / 2, 0.5 - s[2] / s[1] / half / 2) for s in seen]
    asyncio.run(canvas._rect(SimpleNamespace(screen_min=screen[0], screen_max=screen[1])))
    np.testing.assert_allclose(boxes, [wanted.ravel()], atol=1e-6)


def test_clicks_tell_the_pixel_and_shift_and_those_beside_the_photo_nothing(canvas) -> None:
    points: list = []
    canvas.open(RGB, None, lambda *point: points.append(point))
    origin = CENTRE - (0.0, 2.0, 0.0)
    for callback, pixel in zip((*canvas._points, canvas._points[0]), ((10.0, 20.0), (600.0, 470.0), (-5.0, 20.0))):
        ray = FLAT.to_world(np.array(pixel)) - origin
        asyncio.run(callback(SimpleNamespace(ray_origin=tuple(origin), ray_direction=tuple(ray))))
    np.testing.assert_allclose(points, [(10.0, 20.0, True), (600.0, 470.0, False)], atol=1e-6)


def test_boxes_and_outlines_lie_on_the_photo_until_it_is_closed(server, canvas) -> None:
    canvas.show_boxes([LabelledBox((1.0, 1.0, 50.0, 50.0), "chair", "a chair")], None)
    canvas.show_mask(np.ones((480, 640), dtype=bool))
    assert not drawn(server), "a closed canvas shows nothing"
    canvas.open(RGB, None)
    box = LabelledBox((1.0, 1.0, 50.0, 50.0), "chair", "a chair")
    canvas.show_boxes([box, box], 1)
    for _ in range(2):
        canvas.show_mask(np.ones((480, 640), dtype=bool))
    names = {"/board/photo", "/board/mask", *(f"/board/{kind}/{i}" for kind in ("box", "name") for i in (0, 1))}
    assert drawn(server) == names
    canvas.show_boxes([], None)
    assert drawn(server) == {"/board/photo", "/board/mask"}
    canvas.close()
    assert not canvas.is_open
    assert not drawn(server)


def test_leaving_goes_back_to_the_view_from_before_even_when_it_was_opened_twice(canvas, camera) -> None:
    before = camera.position, camera.target_point, camera.fov_rad
    canvas.open(RGB, None)
    canvas.open(RGB[:240], None)
    assert canvas.photo == FlatPhoto(640, 240)
    canvas.leave()
    np.testing.assert_allclose(camera.position, before[0])
    np.testing.assert_allclose(camera.target_point, before[1])
    assert camera.fov_rad == pytest.approx(before[2])
