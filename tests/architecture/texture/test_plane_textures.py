"""Plane textures: what is seen lands where it is, what is hidden is filled smoothly."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.texture.colours import coloured, object_pixels
from diorama_core.architecture.texture.empty_room import empty_room
from diorama_core.architecture.texture.plane_textures import MAX_SIDE_PX, completed, plane_textures, strays
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
    planes = coloured(shot.planes, shot.inputs.photo.rgb, CAMERA, shot.objects)
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
    from dataclasses import replace

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


def test_hidden_parts_are_filled_without_steps():
    seen = np.ones((60, 80), dtype=bool)
    seen[20:40, 30:50] = False
    colours = np.full((60, 80, 3), 120.0, np.float32)
    filled = completed(colours, seen, (120 / 255,) * 3, 0.02, seen)
    assert np.abs(filled.astype(int) - 120).max() <= 2


def test_what_nobody_saw_is_the_plain_colour():
    seen = np.zeros((50, 400), dtype=bool)
    seen[:, :30] = True
    colours = np.full((50, 400, 3), 200.0, np.float32)
    filled = completed(colours, seen, (0.2, 0.2, 0.2), 0.05, seen)
    assert np.abs(filled[:, -1].astype(int) - 51).max() <= 2
    assert np.abs(filled[:, 5].astype(int) - 200).max() <= 4


def boards(height=300, width=400, period=14):
    """A floor of boards 14 texels wide with dark joints."""
    picture = np.full((height, width, 3), 160.0, np.float32)
    picture[:, np.arange(width) % period < 2] = 110.0
    return picture


def test_boards_continue_where_nobody_saw_the_floor():
    colours, seen = boards(), np.zeros((300, 400), dtype=bool)
    seen[100:220, 100:260] = True
    filled = completed(colours, seen, (0.6, 0.6, 0.6), 0.01, seen, ground=True).astype(float)
    unseen = filled[:, 300:384, 0] - filled[:, 300:384, 0].mean(axis=1, keepdims=True)
    # Along most rows the variation lives at the boards' period: six of them in 84 texels.
    spectrum = np.abs(np.fft.rfft(unseen, axis=1))
    assert np.median(spectrum[:, 6] / spectrum[:, 1:6].max(axis=1)) > 1.5


def test_a_poster_stays_where_it_is_and_is_not_copied():
    rng = np.random.default_rng(0)
    colours = (150 + rng.normal(0, 2, (300, 400, 1)) + np.zeros(3)).astype(np.float32)
    colours[120:170, 140:180] = (230.0, 20.0, 40.0)
    seen = np.zeros((300, 400), dtype=bool)
    seen[60:240, 60:280] = True
    own = seen & (colours[..., 1] > 100)
    filled = completed(colours, seen, (150 / 255,) * 3, 0.01, own).astype(int)
    assert np.abs(filled[140, 160] - (230, 20, 40)).max() < 6
    away = filled.copy()
    away[100:190, 120:200] = 150
    assert np.abs(away - 150).max() < 25


def test_textures_are_deterministic(shot, textures):
    planes = coloured(shot.planes, shot.inputs.photo.rgb, CAMERA, shot.objects)
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
    planes = coloured(shot.planes, shot.inputs.photo.rgb, CAMERA, shot.objects)
    picture = plane_textures(shot.inputs, shot.objects, CAMERA, Architecture(planes), _Painter(colour))["floor"]
    share = (np.abs(picture.astype(int) - colour).max(axis=-1) < 5).mean()
    assert share > 0.02 if accepted else share == 0


def test_the_empty_room_has_no_furniture(shot, textures):
    planes = coloured(shot.planes, shot.inputs.photo.rgb, CAMERA, shot.objects)
    hidden = object_pixels(shot.inputs.photo.rgb.shape[:2], shot.objects)
    empty = empty_room(shot.inputs.photo.rgb, hidden, planes, CAMERA, textures)
    np.testing.assert_array_equal(empty[~hidden], shot.inputs.photo.rgb[~hidden])
    assert len({p.id for p in planes}) == len(planes)
    _, rays = camera_rays(CAMERA)
    which = cast_planes(CAMERA.position, rays, planes)[1]
    expected = PALETTE[which % len(PALETTE)]
    assert np.quantile(np.abs(empty[hidden].astype(int) - expected[hidden]).max(axis=-1), 0.9) < 45


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


def test_light_and_shade_go_on_beside_what_is_seen():
    shade = np.linspace(60.0, 190.0, 400, dtype=np.float32)
    colours = np.broadcast_to(shade[None, :, None], (300, 400, 3)).copy()
    seen = np.zeros((300, 400), dtype=bool)
    seen[100:200] = True
    filled = completed(colours, seen, (0.5, 0.5, 0.5), 0.01, seen).astype(float)
    assert np.abs(filled[90, 20:380, 0] - shade[20:380]).max() < 12


def test_copies_of_a_small_piece_do_not_show_as_a_weave():
    rng = np.random.default_rng(0)
    colours = (150 + rng.normal(0, 2, (300, 300, 1)) + np.zeros(3)).astype(np.float32)
    seen = np.zeros((300, 300), dtype=bool)
    seen[130:170, 130:170] = True
    # A broad dark stripe across the little that is seen, as a thing's shadow leaves it.
    colours -= 18.0 * np.exp(-(((np.arange(300) - 150) / 6.0) ** 2))[:, None, None].astype(np.float32)
    filled = completed(colours, seen, (150 / 255,) * 3, 0.01, seen, ground=True).astype(float)
    rows, places = filled[:90, 230:, 0].mean(axis=1), np.arange(90)
    assert np.std(rows - np.polyval(np.polyfit(places, rows, 3), places)) < 2.5
