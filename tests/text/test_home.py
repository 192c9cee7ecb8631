"""Homes from words: which rooms are meant, and that they stand beside each other with a way between them."""

from __future__ import annotations

import pytest
import shapely

from diorama_core.editing.collisions import Collisions
from diorama_core.errors import InputError
from diorama_core.geometry.rooms import doorways, rooms_of_objects
from diorama_core.library.catalogue import built_in_library
from diorama_core.text.home import APART_M, rooms_asked
from diorama_core.text.scene_from_text import scene_from_text


@pytest.mark.parametrize(
    ("prompt", "names"),
    [
        ("two bedrooms, a bath, an open kitchen", ["bedroom", "bedroom", "bathroom", "kitchen"]),
        ("A flat with a cosy living room and a kitchen.", ["living room", "kitchen"]),
        ("3 bedrooms; a dining room", ["bedroom", "bedroom", "bedroom", "dining room"]),
        ("a living room and a kitchen", []),
        ("a bedroom with a bed, a desk and a chair", []),
        ("a kitchen counter, two stools and a lamp", []),
        ("an apartment with big windows", []),
        ("", []),
    ],
)
def test_lists_of_rooms_are_homes_and_other_words_are_not(prompt: str, names: list[str]) -> None:
    assert [r.name for r in rooms_asked(prompt)] == names


def test_open_and_looks_are_said_of_a_room() -> None:
    kitchen = rooms_asked("a modern open-plan kitchen, a bedroom, a bath")[0]
    assert (kitchen.looks, kitchen.is_open) == ("modern", True)
    with pytest.raises(InputError, match="20 rooms"):
        rooms_asked("ten bedrooms, ten baths")


def test_rooms_join_at_doors_and_share_no_floor() -> None:
    made = scene_from_text("a living room, a bath and an open kitchen", built_in_library(), seed=1)
    scene = made.scene
    assert [r.name for r in scene.rooms] == ["living room", "bathroom", "kitchen"]
    floors = [shapely.Polygon(scene.plane(r.floor).polygon[:, :2]) for r in scene.rooms]
    apart = [a.distance(b) for k, a in enumerate(floors) for b in floors[:k]]
    assert min(apart) > APART_M
    ways = doorways(scene)
    assert {r for way in ways for r in way.rooms} == {r.id for r in scene.rooms}
    assert sorted(way.opening.object_id is None for way in ways) == [False, True], "a door and a passage"
    assert all(way.opening.is_door for way in ways)
    assert set(rooms_of_objects(scene).values()) == {r.id for r in scene.rooms}
    assert "a home of 3 rooms" in made.notes[0]
    doors = {o.id for o in scene.objects if o.category == "door"}
    assert not any(doors & set(pair) for pair in Collisions(built_in_library()).pairs(scene, sorted(doors)))
