from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.free_space import free_space
from diorama_core.editing.plan_edits import empty_room
from diorama_core.library.record import Shape
from diorama_core.scene.types import Architecture, Pose, Scene, SceneObject, Support
from tests.editing.objects import item

ROOM = empty_room(3.0, 4.0, 2.4)


def shape(category: str, depth: float, width: float, height: float) -> Shape:
    return Shape(id="s", category=category, caption="", size_m=(depth, width, height))


def with_objects(scene: Scene, *objects: SceneObject) -> Scene:
    return replace(scene, objects=objects, supports=tuple(Support(o.id, "floor") for o in objects))


def turned(scene: Scene, angle: float) -> Scene:
    R = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]])
    planes = tuple(replace(p, polygon=p.polygon @ R.T) for p in scene.architecture.planes)
    objects = tuple(
        replace(o, pose=Pose(R @ o.pose.R_world_object, R @ o.pose.position, o.pose.scale)) for o in scene.objects
    )
    return replace(scene, architecture=Architecture(planes), objects=objects)


@pytest.mark.parametrize("angle", [0.0, 0.5])
def test_a_thing_fits_where_its_rectangle_is_free_in_either_heading(angle: float) -> None:
    empty = free_space(turned(ROOM, angle))
    assert empty.has_place_for(shape("sofa", 1.0, 3.8, 0.8))
    assert not empty.has_place_for(shape("sofa", 1.0, 4.2, 0.8))
    # What stands across the room leaves 1.5 m on one side and 1.9 m on the other.
    half = free_space(turned(with_objects(ROOM, item("row", (3.0, 0.6, 0.8), 0.0, -0.2)), angle))
    assert half.has_place_for(shape("sofa", 1.8, 2.8, 0.8))
    assert half.has_place_for(shape("sofa", 2.8, 1.8, 0.8))
    assert not half.has_place_for(shape("sofa", 2.1, 2.8, 0.8))


def test_rugs_hidden_and_hanging_things_take_no_floor() -> None:
    rug, hidden = item("rug", (3.0, 4.0, 0.02), 0, 0), replace(item("h", (3.0, 4.0, 0.8), 0, 0), hidden=True)
    lamp = replace(item("lamp", (3.0, 4.0, 0.3), 0, 0), pose=Pose.upright((0, 0, 2.0)))
    assert free_space(with_objects(ROOM, rug, hidden, lamp)).has_place_for(shape("sofa", 1.0, 2.0, 0.8))


def test_heights_walls_and_furniture_count() -> None:
    space = free_space(ROOM)
    assert not space.has_place_for(shape("wardrobe", 0.6, 1.0, 2.5))
    assert space.has_place_for(shape("mirror", 0.05, 3.5, 1.0))
    assert not space.has_place_for(shape("mirror", 0.05, 4.5, 1.0))
    assert space.has_place_for(shape("vase", 0.2, 0.2, 0.3))
    assert free_space(Scene()).has_place_for(shape("sofa", 1.0, 9.0, 0.8)), "where no room is known"


@pytest.mark.parametrize("angle", [0.0, 0.5])
def test_spots_are_free_middles_in_the_world(angle: float) -> None:
    scene = turned(with_objects(ROOM, item("row", (3.0, 0.6, 0.8), 0.0, -0.2)), angle)
    space = free_space(scene)
    assert space.free_m2 == pytest.approx(12.0 - 1.8, abs=0.4)
    spots = space.spots(1.2, 1.2)
    assert len(spots) >= 2
    for x, y in spots:
        there = with_objects(scene, item("new", (1.2, 1.2, 0.8), x, y, angle))
        assert free_space(replace(there, objects=(*scene.objects, there.object("new")))).free_m2 == pytest.approx(
            space.free_m2 - 1.44, abs=0.15
        )
    assert space.spots(3.5, 3.5) == ()
