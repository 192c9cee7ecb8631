"""Pictures of planes that were moved: nothing stretches, what was seen stays where it was."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.texture.refit import refit_picture, refit_textures
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.edits import move_plane, rescale, set_ceiling_height
from diorama_core.scene.room_edits import set_surface_finish
from diorama_core.scene.types import Architecture, Plane, Scene, SurfaceFinish
from tests.synthetic_rooms import box_room, look

STRIPES = np.repeat(np.where(np.arange(200) // 10 % 2, 155, 135).astype(np.uint8)[None, :, None], 125, axis=0)
PICTURE = np.ascontiguousarray(np.broadcast_to(STRIPES, (125, 200, 3)))
"""A wall 4 m wide and 2.5 m high, striped every 20 cm."""
PAINT = SurfaceFinish("paint", (0.5, 0.6, 0.7))


def room():
    planes = box_room(-2.0, 2.0, 4.0, 2.5, y0=-1.0)
    return Scene(
        architecture=Architecture(tuple(replace(p, texture=p.id) if p.id in ("back", "right") else p for p in planes)),
        camera=look(),
    )


TEXTURES = {"back": PICTURE, "right": PICTURE}


def test_a_side_wall_grows_and_its_neighbour_keeps_the_scale():
    before = room()
    after, made = refit_textures(before, move_plane(before, "right", 1.0), TEXTURES)
    back = after.plane("back")
    assert set(made) == {back.texture}
    picture = made[back.texture]
    assert picture.shape[:2] == (125, 250)
    np.testing.assert_allclose(picture[:, 10:190].astype(int), PICTURE[:, 10:190], atol=2)
    grown = picture[60, 205:, 0].astype(int)
    assert grown.max() - grown.min() > 12, "the stripes go on"


def test_a_plane_that_only_moves_along_its_normal_keeps_its_picture():
    before = room()
    after, _ = refit_textures(before, move_plane(before, "right", 1.0), TEXTURES)
    assert after.plane("right").texture == "right"


def test_a_lower_ceiling_cuts_the_picture_from_above():
    before = room()
    marked = PICTURE.copy()
    marked[:10] = (255, 0, 0)
    after, made = refit_textures(before, set_ceiling_height(before, 2.0), {"back": marked})
    picture = made[after.plane("back").texture]
    assert picture.shape[:2] == (100, 200)
    assert not ((picture[..., 0] > 240) & (picture[..., 1] < 30)).any()


def test_there_and_back_has_the_old_size_and_names_are_repeatable():
    before = room()
    there, made = refit_textures(before, move_plane(before, "right", 1.0), TEXTURES)
    again, _ = refit_textures(before, move_plane(before, "right", 1.0), TEXTURES)
    assert there == again
    back, more = refit_textures(there, move_plane(there, "right", -1.0), {**TEXTURES, **made})
    np.testing.assert_allclose(more[back.plane("back").texture].astype(int), PICTURE, atol=25)


@pytest.mark.parametrize("edit", ["rescale", "plain", "nothing"])
def test_other_edits_make_no_pictures(edit):
    before = room()
    after = {
        "rescale": lambda s: rescale(s, 1.2),
        "plain": lambda s: set_surface_finish(s, ["back"], PAINT),
        "nothing": lambda s: s,
    }[edit](before)
    assert refit_textures(before, after, TEXTURES) == (after, {})


def test_a_plane_without_overlap_takes_the_nearest_colours():
    a = Plane("wall", "wall", np.array([[0.0, 2, 0], [2, 2, 0], [2, 2, 2], [0, 2, 2]]))
    b = replace(a, polygon=a.polygon + np.array([5.0, 0.0, 0.0]))
    picture = refit_picture(np.full((50, 50, 3), 77, np.uint8), a, b)
    assert (picture == 77).all()
    assert plane_rectangle(b)[2] == pytest.approx([2.0, 2.0])
