"""The room drawn over its photo: the right planes tinted, edges where they meet, the photo still visible."""

from __future__ import annotations

import numpy as np

from diorama_core.render.planes_over_photo import plane_colours, planes_over_photo
from tests.synthetic_rooms import box_room, look

ROOM = box_room(-2.0, 2.0, 4.0, 2.6)
CAMERA = look(0, 5, size=(320, 240))
GREY = np.full((240, 320, 3), 120, np.uint8)


def tint_at(picture, point):
    column, row = CAMERA.project(np.asarray(point, dtype=float)).astype(int)
    return picture[row, column].astype(float)


def test_each_plane_is_tinted_in_its_own_colour():
    picture = planes_over_photo(GREY, ROOM, CAMERA)
    colours = plane_colours(ROOM)
    assert len(set(colours)) == len(colours)
    for point, index in (((0.9, 3.0, 0), 0), ((1.2, 4, 1.9), 1), ((-2, 3.8, 1.9), 2), ((2, 3.8, 1.9), 3)):
        np.testing.assert_allclose(tint_at(picture, point), 0.67 * 120 + 0.33 * np.array(colours[index]), atol=2)


def test_edges_are_drawn_where_planes_meet():
    picture = planes_over_photo(GREY, ROOM, CAMERA)
    column, row = CAMERA.project(np.array([1.0, 4.0, 0.0])).astype(int)
    assert (picture[row - 3 : row + 4, column] > 225).all(axis=-1).any()


def test_any_size_and_an_empty_room():
    assert planes_over_photo(np.zeros((480, 640, 3), np.uint8), ROOM, CAMERA).shape == (480, 640, 3)
    assert planes_over_photo(GREY, (), CAMERA).shape == GREY.shape
