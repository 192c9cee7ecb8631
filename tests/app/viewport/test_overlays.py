from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_app.reconstruction.camera_correction import CameraAttitude, trial_camera
from diorama_app.viewport.overlays import SELECTED_COLOUR, draw_ground, draw_planes, mask_picture, visible_objects
from diorama_core.artefacts import DetectedObject
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene

BOX = (100.0, 60.0, 200.0, 160.0)


def scene() -> Scene:
    made = furnished_scene()
    found = {"table_1": BOX, "chair_1": (300.0, 200.0, 360.0, 300.0)}
    return replace(made, objects=tuple(replace(o, box_px=found.get(o.id)) for o in made.objects))


def disc() -> DetectedObject:
    y, x = np.mgrid[:480, :640]
    mask = (x - 150) ** 2 + (y - 110) ** 2 < 45**2
    return DetectedObject("table_1", "table", "table", BOX, mask, 1, 1.0)


def test_outlines_are_drawn_where_they_hold_and_boxes_where_not() -> None:
    items = visible_objects(scene(), (disc(),))
    picture = mask_picture((640, 480), items, ())
    assert picture[110, 150, 3] > 0
    assert picture[62, 103, 3] == 0, "the corner of the box is outside its mask"
    assert picture[250, 330, 3] > 0, "no outline is known: its box"
    assert picture[400, 600, 3] == 0
    moved = replace(scene(), objects=tuple(replace(o, box_px=(0.0, 0.0, 50.0, 50.0)) for o in scene().objects))
    assert all(t.mask is None for t in visible_objects(moved, (disc(),))), "its box was drawn anew"


def test_what_is_selected_is_orange_and_on_top_and_what_is_hidden_is_not_drawn() -> None:
    items = visible_objects(scene(), (disc(),))
    picture = mask_picture((640, 480), items, ("table_1",))
    assert tuple(picture[110, 150, :3]) == SELECTED_COLOUR
    hidden = replace(scene(), objects=tuple(replace(o, hidden=True) for o in scene().objects))
    assert visible_objects(hidden, (disc(),)) == ()


def test_planes_are_drawn_where_the_camera_sees_their_edges() -> None:
    made = scene()
    picture = np.zeros((480, 640, 4), dtype=np.uint8)
    assert made.camera is not None
    draw_planes(picture, made.architecture.planes, made.camera)
    wall = made.plane("wall_3")
    seam = wall.polygon[np.argsort(wall.polygon[:, 2])[:2]].mean(axis=0)
    u, v = made.camera.project(seam[None])[0].round().astype(int)
    assert picture[v - 2 : v + 3, u, 3].max() == 255
    assert picture[..., 3].mean() < 20, "lines only, also of planes that reach behind the camera"


@pytest.mark.parametrize("size", [(4000, 3000), (300, 200)])
def test_large_photos_are_drawn_small_enough(size: tuple[int, int]) -> None:
    assert max(mask_picture(size, (), ()).shape) <= 1280


def test_the_ground_of_a_trial_camera_lies_below_its_horizon() -> None:
    made = scene()
    assert made.camera is not None
    picture = np.zeros((480, 640, 4), dtype=np.uint8)
    draw_ground(picture, made.camera, 0.0)
    rows = np.flatnonzero(picture[..., 3].any(axis=1))
    horizon = made.camera.project(made.camera.position[None] + np.array([[0.0, 1.0, 0.0]]))[0, 1]
    assert rows.min() > horizon
    steeper = trial_camera(made.camera, 66.0, CameraAttitude(np.radians(25.0), 0.0))
    lower = np.zeros_like(picture)
    draw_ground(lower, steeper, 0.0)
    assert np.flatnonzero(lower[..., 3].any(axis=1)).min() < rows.min(), "looking down, the floor rises in the picture"
