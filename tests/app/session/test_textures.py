from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_app.session.textures import refit
from diorama_core.appearance.surface_finish import usual_finish
from diorama_core.scene import edits
from diorama_core.scene.room_edits import move_plane, set_surface_finish
from tests.app.small_room import furnished_scene

SCENE = furnished_scene()


def test_an_edit_of_furniture_leaves_every_picture_alone() -> None:
    moved = edits.rename(SCENE, "chair_1", "throne")
    assert refit(SCENE, moved, {"floor.png": np.zeros((4, 4, 3), dtype=np.uint8)}) == (moved, {})


def test_a_longer_floor_gets_a_larger_picture_of_the_same_scale(rng) -> None:
    floor = next(p for p in SCENE.architecture.planes if p.role == "floor")
    square = floor.polygon * (*(4.0 / np.ptp(floor.polygon[:, :2], axis=0)), 1.0)
    textured = replace(floor, texture="floor.png", polygon=square)
    planes = tuple(textured if p is floor else p for p in SCENE.architecture.planes)
    before = replace(SCENE, architecture=replace(SCENE.architecture, planes=planes))
    longer = replace(textured, polygon=square * (1.5, 1.0, 1.0))
    after = replace(
        before, architecture=replace(before.architecture, planes=tuple(longer if p is textured else p for p in planes))
    )
    picture = rng.integers(0, 256, (80, 80, 3), dtype=np.uint8)
    scene, made = refit(before, after, {"floor.png": picture})
    assert len(made) == 1
    name = next(iter(made))
    assert name != "floor.png"
    assert next(p for p in scene.architecture.planes if p.role == "floor").texture == name
    grown = np.array(made[name].shape[:2]) / picture.shape[:2]
    np.testing.assert_allclose(sorted(grown), (1.0, 1.5), atol=0.03)


def test_a_moved_wall_has_its_finish_made_anew_and_the_photo_below_it_fitted(rng) -> None:
    photo = rng.integers(0, 256, (80, 120, 3), dtype=np.uint8)
    bare = replace(SCENE.plane("wall_2"), texture="wall.png")
    planes = tuple(bare if p.id == "wall_2" else p for p in SCENE.architecture.planes)
    before = replace(SCENE, architecture=replace(SCENE.architecture, planes=planes))
    finished, made = refit(before, set_surface_finish(before, ("wall_2",), usual_finish("dots")), {"wall.png": photo})
    known = {"wall.png": photo, **made}
    moved, more = refit(finished, move_plane(finished, "wall_3", 1.0), known)
    wall = moved.plane("wall_2")
    assert {wall.texture, wall.photo_texture} == set(more)
    assert wall.texture != finished.plane("wall_2").texture
    back = set_surface_finish(moved, ("wall_2",), None).plane("wall_2")
    assert back.texture == wall.photo_texture
    assert more[str(back.texture)].shape[1] > photo.shape[1]
