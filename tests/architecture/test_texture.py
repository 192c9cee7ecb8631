"""Plane textures: what is seen lands where it is, what is hidden is filled smoothly."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.colours import coloured
from diorama_core.architecture.texture import MAX_SIDE_PX, completed, plane_textures
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
    filled = completed(colours, seen, (120 / 255,) * 3, 30.0)
    assert np.abs(filled.astype(int) - 120).max() <= 2


def test_what_nobody_saw_is_the_plain_colour():
    seen = np.zeros((50, 400), dtype=bool)
    seen[:, :30] = True
    colours = np.full((50, 400, 3), 200.0, np.float32)
    filled = completed(colours, seen, (0.2, 0.2, 0.2), 10.0)
    assert np.abs(filled[:, -1].astype(int) - 51).max() <= 2
    assert np.abs(filled[:, 5].astype(int) - 200).max() <= 4
