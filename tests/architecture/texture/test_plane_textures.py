"""Plane textures: what is seen lands where it is, what is hidden is filled smoothly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.texture.colours import colour_planes
from diorama_core.architecture.texture.plane_textures import (
    MAX_SIDE_PX,
    PhotoView,
    RoomPicture,
    plane_textures,
    strays,
    texel_points,
)
from diorama_core.geometry.casting import camera_rays, cast_planes
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.types import Architecture
from tests.synthetic_rooms import PALETTE, box_room, cuboid, look, shoot

CAMERA = look(0, 12)


@pytest.fixture(scope="module")
def shot():
    return shoot(CAMERA, box_room(-1.8, 1.8, 4.0, 2.6), (cuboid("a", (0.2, 3.0, 0), (0.6, 1.0, 0.8)),))


@pytest.fixture(scope="module")
def textures(shot):
    planes = colour_planes(shot.planes, shot.inputs.photo.rgb, CAMERA, shot.objects)
    return plane_textures(shot.inputs, shot.objects, CAMERA, Architecture(planes))


def test_seen_planes_have_small_pictures_of_their_own_colour(textures):
    for name, index in (("floor", 0), ("back", 1)):
        picture = textures[name]
        assert max(picture.shape[:2]) <= MAX_SIDE_PX
        assert picture.dtype == np.uint8
        assert np.abs(np.median(picture.reshape(-1, 3), axis=0) - PALETTE[index]).max() < 40


def test_no_furniture_is_left_on_the_floor(textures):
    difference = np.abs(textures["floor"].astype(int) - PALETTE[0]).max(axis=-1)
    assert np.quantile(difference[: difference.shape[0] // 2], 0.99) < 45


def test_unseen_planes_have_none(textures):
    assert "ceiling" not in textures


def test_a_mark_on_the_wall_lands_at_its_texture_coordinates(shot):
    target = np.array([-1.0, 4.0, 1.7])
    column, row = CAMERA.project(target).astype(int)
    rgb = shot.inputs.photo.rgb.copy()
    rgb[row - 9 : row + 10, column - 9 : column + 10] = (255, 0, 255)
    inputs = replace(shot.inputs, photo=replace(shot.inputs.photo, rgb=rgb))
    picture = plane_textures(inputs, shot.objects, CAMERA, Architecture(shot.planes))["back"]
    origin, axes, extents = plane_rectangle(next(p for p in shot.planes if p.id == "back"))
    u, v = (target - origin) @ axes / extents
    height, width = picture.shape[:2]
    texel = picture[int((1 - v) * height), int(u * width)].astype(int)
    assert texel[0] > 200
    assert texel[1] < 80


def test_gaps_between_boards_are_the_floors_and_cut_it_in_no_pieces(shot):
    """Without them, what is left between gaps narrower than an island's width would be given up."""
    floor = next(p for p in shot.planes if p.id == "floor")
    rgb = shot.inputs.photo.rgb.copy()
    origin, rays = camera_rays(CAMERA)
    depth, index = cast_planes(origin, rays, shot.planes)
    on_floor = index == [p.id for p in shot.planes].index("floor")
    x = origin[0] + np.where(on_floor, depth, 0.0) * rays[..., 0]
    gap = on_floor & (x % 0.09 < 0.016)
    rgb[gap] = rgb[gap] // 3
    inputs = replace(shot.inputs, photo=replace(shot.inputs.photo, rgb=rgb))
    picture = plane_textures(inputs, shot.objects, CAMERA, Architecture((floor,)))["floor"]
    dark = (picture.astype(int).sum(axis=-1) < 0.6 * np.median(picture.astype(int).sum(axis=-1))).mean()
    assert dark > 0.02


def test_textures_are_deterministic(shot, textures):
    planes = colour_planes(shot.planes, shot.inputs.photo.rgb, CAMERA, shot.objects)
    again = plane_textures(shot.inputs, shot.objects, CAMERA, Architecture(planes))
    assert all(np.array_equal(again[name], textures[name]) for name in textures)


class _Painter:
    """A filler that paints everything hidden in one colour."""

    def __init__(self, colour):
        self.colour = np.uint8(colour)

    def fill(self, rgb, hole):
        return np.where(hole[..., None], self.colour, rgb)


@pytest.mark.parametrize(("colour", "accepted"), [((165, 122, 90), True), ((20, 40, 230), False)])
def test_what_a_filler_painted_is_taken_for_floor_where_it_looks_like_it(shot, colour, accepted):
    planes = colour_planes(shot.planes, shot.inputs.photo.rgb, CAMERA, shot.objects)
    floor = next(p for p in planes if p.id == "floor")
    view = PhotoView(RoomPicture(shot.inputs.photo.rgb, shot.objects, CAMERA, filler=_Painter(colour)))
    found = view.plane_view(floor, planes, *texel_points(floor))
    share = (found.own & (np.abs(found.colours - colour).max(axis=-1) < 5)).mean()
    assert share > 0.02 if accepted else share == 0


def test_without_planes_to_paint_the_room_is_not_painted_empty(shot):
    class Untouched:
        def fill(self, rgb, hole):
            pytest.fail("nothing is to be painted")

    room = Architecture(shot.planes)
    assert plane_textures(shot.inputs, shot.objects, CAMERA, room, Untouched(), only=()) == {}


def test_the_nearest_texels_are_sharp(shot):
    floor = next(p for p in shot.planes if p.id == "floor")
    points, pixel_m = texel_points(floor)
    view = PhotoView(RoomPicture(shot.inputs.photo.rgb, shot.objects, CAMERA))
    found = view.plane_view(floor, shot.planes, points, pixel_m)
    away = np.linalg.norm(points - CAMERA.position, axis=-1)
    assert 0.1 * found.own.sum() < found.sharp.sum() < found.own.sum()
    assert away[found.sharp].mean() < away[found.own & ~found.sharp].min() + 0.5


def wall_with_an_object(rows, columns):
    """A grey wall of 3 by 4 m seen above 2 m of furniture, and whether a green thing on it is given up."""
    colours = np.full((300, 400, 3), 150.0, np.float32)
    colours[rows, columns] = (30.0, 120.0, 40.0)
    seen = np.zeros((300, 400), dtype=bool)
    seen[20:200, 20:380] = True
    own = seen & (colours[..., 0] > 100)
    return strays(seen, own, 0.01, wall=True)


def test_what_stands_before_a_wall_is_given_up_and_a_poster_is_not():
    plant, poster = (slice(140, 200), slice(100, 160)), (slice(60, 120), slice(100, 160))
    assert wall_with_an_object(*plant)[plant].all()
    assert not wall_with_an_object(*poster).any()


def test_a_wall_of_two_materials_keeps_both():
    assert not wall_with_an_object(slice(20, 110), slice(20, 380)).any()
