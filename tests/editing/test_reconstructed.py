"""What the photo shows is put where it meets nothing."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from diorama_core.editing.collisions import Collisions
from diorama_core.editing.reconstructed import insert
from diorama_core.scene.types import Pose, Scene, SceneObject, Support
from tests.app.small_room import PlainLibrary, furnished_scene


@dataclass
class Posed:
    """What of a reconstruction is inserted."""

    item: SceneObject
    support: Support | None


def _lamp(x: float, y: float, height: float) -> SceneObject:
    shape = PlainLibrary().shape("lamp_a")
    pose = replace(Pose.upright((x, y, height / 2)), scale=np.full(3, height / shape.size_m[2]))
    return SceneObject("new", "lamp", "lamp", "lamp_a", shape.size_m, pose)


def _seen(lamp: SceneObject, high_px: float, scene: Scene) -> SceneObject:
    """A lamp whose foot the photo shows on the table."""
    assert scene.camera is not None
    x, y = scene.camera.project(np.array([0.1, 2.2, 0.74]))
    return replace(lamp, box_px=(x - 20.0, y - high_px, x + 20.0, y))


def _room() -> Scene:
    """Without the lamp that is on the table."""
    scene = furnished_scene()
    return replace(
        scene,
        objects=tuple(o for o in scene.objects if o.id != "lamp_1"),
        supports=tuple(s for s in scene.supports if s.child != "lamp_1"),
    )


@pytest.mark.unchecked
def test_what_would_go_through_a_table_stands_on_it_as_the_photo_shows_it() -> None:
    scene = _room()
    lamp = _seen(_lamp(0.1, 2.55, 1.6), 90.0, scene)
    after = insert(scene, Posed(lamp, Support("new", "floor")), PlainLibrary())
    new = after.objects[-1]
    assert after.support_of(new.id).parent == "table_1"
    assert not Collisions(PlainLibrary()).pairs(after, [new.id])
    assert new.corners_world[:, 2].min() == pytest.approx(0.74, abs=1e-6)
    np.testing.assert_allclose(new.pose.position[:2], (0.1, 2.2), atol=0.02)
    seen = [o.size_m[2] / scene.camera.to_camera(o.pose.position[None])[0, 2] for o in (lamp, new)]
    assert seen[1] == pytest.approx(seen[0], rel=0.1)


@pytest.mark.unchecked
def test_what_cannot_stand_on_it_stands_beside_it() -> None:
    scene = _room()
    after = insert(scene, Posed(_lamp(-0.9, 1.5, 0.5), Support("new", "floor")), PlainLibrary())
    new = after.objects[-1]
    assert after.support_of(new.id).parent == "floor"
    assert not Collisions(PlainLibrary()).pairs(after, [new.id])


@pytest.mark.unchecked
def test_what_meets_nothing_stays() -> None:
    lamp = _lamp(-1.6, 2.8, 0.5)
    after = insert(_room(), Posed(lamp, Support("new", "floor")), PlainLibrary())
    np.testing.assert_allclose(after.objects[-1].pose.position, lamp.pose.position, atol=1e-6)


@pytest.mark.unchecked
def test_what_was_found_out_of_the_room_stands_on_what_the_photo_shows_it_on() -> None:
    scene = _room()
    lamp = _seen(_lamp(-0.7, 7.3, 1.1), 70.0, scene)
    below = replace(lamp, pose=lamp.pose.move((0.0, 0.0, -0.9)))
    after = insert(scene, Posed(below, Support("new", "wall_4", "mounted on")), PlainLibrary())
    new = after.objects[-1]
    assert after.support_of(new.id).parent == "table_1"
    assert new.corners_world[:, 2].min() == pytest.approx(0.74, abs=1e-6)
