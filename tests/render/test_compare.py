"""Pictures for judging by eye."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.render.compare import colour_of, overlay, side_by_side
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()


def test_side_by_side_keeps_the_photo_and_the_rendering_s_aspect() -> None:
    photo = np.full((100, 150, 3), 7, np.uint8)
    both = side_by_side(photo, np.full((50, 80, 3), 9, np.uint8), gap=4)
    assert both.shape == (100, 150 + 4 + 160, 3)
    assert (both[:, :150] == 7).all()
    assert (both[:, 154:] == 9).all()


def test_overlay_draws_box_edges_where_they_project() -> None:
    scene = furnished_room(LIBRARY)
    assert scene.camera is not None
    photo = np.zeros((240, 320, 3), np.uint8)
    alone = replace(scene, objects=scene.objects[:1], supports=())
    drawn = overlay(photo, alone)
    assert (overlay(photo, scene, LIBRARY) != drawn).any()
    corner = scene.camera.project(scene.objects[0].corners_world[4])
    patch = drawn[int(corner[1]) - 1 : int(corner[1]) + 2, int(corner[0]) - 1 : int(corner[0]) + 2].reshape(-1, 3)
    assert np.abs(patch.astype(int) - colour_of(0)).sum(axis=1).min() < 60
    assert not photo.any(), "the photo itself is untouched"


def test_overlay_without_camera_is_the_photo() -> None:
    photo = np.zeros((24, 32, 3), np.uint8)
    assert not overlay(photo, replace(furnished_room(LIBRARY), camera=None)).any()
