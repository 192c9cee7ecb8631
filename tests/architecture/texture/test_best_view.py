"""Textures of several photos: each texel from the photo that sees it best, in one exposure, without seams."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.texture.best_view import best_view_textures, exposure_gains
from diorama_core.architecture.texture.colours import colour_planes
from diorama_core.architecture.texture.plane_textures import PlaneView, RoomPicture, plane_textures
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.types import Architecture, Camera
from tests.synthetic_rooms import PALETTE, box_room, cuboid, look, shoot

FIRST = look(0, 12)
BOX = cuboid("a", (0.9, 2.6, 0), (0.7, 0.9, 1.2))
"""Hides the right part of the back wall and the floor before it."""


def beside(camera: Camera, shift: tuple[float, float, float]) -> Camera:
    T = camera.T_world_camera.copy()
    T[:3, 3] += shift
    return Camera(camera.intrinsics, T)


SECOND = beside(FIRST, (1.6, 0.6, 0.0))


def picture_of(shot, camera: Camera, factor: float = 1.0) -> RoomPicture:
    rgb = (shot.inputs.photo.rgb * factor).clip(0, 255).astype(np.uint8)
    return RoomPicture(rgb, shot.objects, camera)


@pytest.fixture(scope="module")
def shots():
    planes = box_room(-1.8, 1.8, 4.0, 2.6)
    return shoot(FIRST, planes, (BOX,)), shoot(SECOND, planes, (BOX,))


@pytest.fixture(scope="module")
def room(shots):
    first = shots[0]
    return Architecture(colour_planes(first.planes, first.inputs.photo.rgb, FIRST, first.objects))


def test_one_photo_gives_what_it_gives_alone(shots, room):
    alone = plane_textures(shots[0].inputs, shots[0].objects, FIRST, room)
    joined = best_view_textures([picture_of(shots[0], FIRST)], room)
    assert set(joined) == set(alone)
    for name in alone:
        assert np.abs(joined[name].astype(int) - alone[name]).mean() < 1.5


def texel_at(picture, plane, point):
    origin, axes, extents = plane_rectangle(plane)
    u, v = (np.array(point) - origin) @ axes / extents
    height, width = picture.shape[:2]
    return picture[int((1 - v) * height), int(u * width)].astype(int)


def test_what_one_photo_hides_comes_from_the_other(shots, room):
    mark = np.array([1.5, 4.0, 0.9])  # behind the box in the first photo
    back = next(p for p in room.planes if p.id == "back")

    def marked(shot, camera):
        rgb = shot.inputs.photo.rgb.copy()
        column, row = camera.project(mark).astype(int)
        free = ~shot.objects[0].mask[row - 12 : row + 13, column - 12 : column + 13]
        rgb[row - 12 : row + 13, column - 12 : column + 13][free] = (255, 0, 255)
        return replace(shot, inputs=replace(shot.inputs, photo=replace(shot.inputs.photo, rgb=rgb)))

    first, second = marked(shots[0], FIRST), marked(shots[1], SECOND)
    alone = texel_at(plane_textures(first.inputs, first.objects, FIRST, room)["back"], back, mark)
    both = best_view_textures([picture_of(first, FIRST), picture_of(second, SECOND)], room)["back"]
    found = texel_at(both, back, mark)
    assert not (alone[0] > 200 and alone[1] < 80)
    assert found[0] > 200
    assert found[1] < 80


def test_a_darker_photo_leaves_no_patch(shots, room):
    pictures = [picture_of(shots[0], FIRST), picture_of(shots[1], SECOND, 0.7)]
    floor = best_view_textures(pictures, room)["floor"].astype(int)
    assert np.quantile(np.abs(floor - PALETTE[0]).max(axis=-1), 0.95) < 45


def test_what_nobody_marked_is_left_out_where_it_is_known_to_stand(shots, room):
    first = shots[0]
    bare = RoomPicture(first.inputs.photo.rgb, (), FIRST, unmarked=first.objects[0].mask)
    with_mask = plane_textures(first.inputs, first.objects, FIRST, room)["back"]
    found = best_view_textures([bare], room)["back"]
    assert np.abs(found.astype(int) - with_mask).mean() < 4


def test_gains_make_common_texels_alike():
    rng = np.random.default_rng(0)
    colours = rng.uniform(80, 160, (40, 50, 3)).astype(np.float32)
    everywhere = np.ones((40, 50), dtype=bool)

    def view(factor):
        return PlaneView(colours * np.float32(factor), everywhere, everywhere, everywhere, np.ones((40, 50)))

    gains = exposure_gains([({0: view(1.0), 1: view(0.8), 2: view(1.25)}, 0.01)], 3)
    np.testing.assert_allclose(gains[:, 0], [1.0, 1.25, 0.8], rtol=0.04)
    apart = exposure_gains([({0: view(1.0)}, 0.01), ({1: view(0.5)}, 0.01)], 2)
    np.testing.assert_allclose(apart, 1.0)
