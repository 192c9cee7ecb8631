"""Pictures of the room by all photos: what is posed hides the room also where nobody marked it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.library.catalogue import built_in_library
from diorama_core.multiview.room_pictures import PlacedPicture, room_pictures, silhouettes, with_pictures
from diorama_core.render.world import scene_world
from diorama_core.scene.room_edits import set_surface_finish
from diorama_core.scene.types import SurfaceFinish
from tests.multiview.two_photos import two_photos


def test_silhouettes_are_where_objects_project() -> None:
    photos = two_photos()
    scene, camera = photos.scene, photos.scene.camera
    assert camera is not None
    k = next(i for i, o in enumerate(scene.objects) if o.category == "table")
    found = silhouettes(scene_world(scene, built_in_library()), camera, [k])
    assert found.shape == (camera.intrinsics.height, camera.intrinsics.width)
    pixels = camera.project(scene.objects[k].corners_world)
    rows, columns = np.nonzero(found)
    assert len(rows) > 200
    assert columns.min() > pixels[:, 0].min() - 6
    assert columns.max() < pixels[:, 0].max() + 6


@pytest.mark.slow
def test_two_photos_give_pictures_without_the_furniture() -> None:
    photos = two_photos()
    scene = photos.scene
    assert scene.camera is not None
    placed = (PlacedPicture(photos.first, (), scene.camera), PlacedPicture(photos.second, (), photos.camera))
    pictures = room_pictures(scene, placed, built_in_library(), {"floor"})
    assert set(pictures) == {"floor"}
    spread = pictures["floor"].reshape(-1, 3).astype(float).std(axis=0).mean()
    assert spread < 40


def test_pictures_get_names_of_their_own_and_lie_below_a_finish() -> None:
    scene = two_photos().scene
    one, other = np.zeros((4, 4, 3), np.uint8), np.full((4, 4, 3), 9, np.uint8)
    shown, named = with_pictures(scene, {"floor": one})
    again, others = with_pictures(shown, {"floor": other})
    floor = again.architecture.floor
    assert floor is not None
    assert floor.texture in others
    assert set(named) & set(others) == set()
    finished = set_surface_finish(scene, ["floor"], SurfaceFinish("boards", (0.5, 0.4, 0.3), 1.0))
    below, _ = with_pictures(finished, {"floor": one})
    kept = below.architecture.floor
    assert kept is not None
    assert kept.texture is None
    assert kept.photo_texture in named
    assert replace(kept, photo_texture=None) == replace(finished.architecture.floor, photo_texture=None)
