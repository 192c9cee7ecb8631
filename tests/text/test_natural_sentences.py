"""Sentences as people say them, written down before the grammar was looked at, and what each must do to a room."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from diorama_core.editing.footprints import gap_between
from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.room_edits import ceiling_height
from diorama_core.scene.types import Scene
from diorama_core.text.edit_room import gap_to_wall
from diorama_core.text.editing_by_words import propose_edits
from tests.text.edited import apart_m, dining_room, living_room, turned_deg

Check = Callable[[Scene, Scene], bool]


def _count(scene: Scene, category: str) -> int:
    return sum(o.category == category for o in scene.objects)


def _new(after: Scene, before: Scene, category: str) -> int:
    return _count(after, category) - _count(before, category)


def _size(scene: Scene, object_id: str, axis: int) -> float:
    return float(scene.object(object_id).size_m[axis])


def _place(scene: Scene, object_id: str) -> np.ndarray:
    return scene.object(object_id).pose.position


def _gap(scene: Scene, first: str, second: str) -> float:
    return gap_between(scene.object(first), scene.object(second))


def _finishes(scene: Scene, role: str) -> list:
    return [p.finish for p in scene.architecture.planes if p.role == role]


def _lengths(scene: Scene) -> np.ndarray:
    floor = scene.architecture.floor
    assert floor is not None
    return np.sort(np.ptp(floor.polygon[:, :2], axis=0))


def _about(value: float, expected: float) -> bool:
    return value == pytest.approx(expected, abs=0.011)


PICTURES = ("picture_1", "picture_2", "picture_3", "picture_4")

NATURAL: dict[str, Check] = {
    "Get rid of the piano.": lambda a, b: not a.has_object("piano_1"),
    "Throw out everything on the sideboard.": lambda a, b: not a.children_of("sideboard_1"),
    "Put a floor lamp to the left of the sofa.": lambda a, b: _new(a, b, "floor lamp") == 1,
    "I'd like a mirror above the sideboard, please.": lambda a, b: _new(a, b, "mirror") == 1,
    "Move the sofa half a metre to the right.": lambda a, b: _about(
        float(np.linalg.norm(_place(a, "sofa_1") - _place(b, "sofa_1"))), 0.5
    ),
    "Push the coffee table 20 cm closer to the sofa.": lambda a, b: (
        apart_m(a, "coffee_table_1", "sofa_1") < apart_m(b, "coffee_table_1", "sofa_1")
    ),
    "Pull the sideboard away from the wall a bit.": lambda a, b: _about(
        float((_place(a, "sideboard_1") - _place(b, "sideboard_1")) @ b.plane("wall_1").normal), 0.2
    ),
    "Make the sofa 30 cm wider.": lambda a, b: _about(_size(a, "sofa_1", 1) - _size(b, "sofa_1", 1), 0.3),
    "The television should be 120 cm wide.": lambda a, b: _about(_size(a, "television_1", 1), 1.2),
    "Make the plant half as tall.": lambda a, b: _about(_size(a, "plant_1", 2), _size(b, "plant_1", 2) / 2),
    "Rotate the coffee table by 90 degrees.": lambda a, b: _about(turned_deg(a, b, "coffee_table_1"), 90.0),
    "Turn the sofa around.": lambda a, b: _about(turned_deg(a, b, "sofa_1"), 180.0),
    "Turn the chairs so that they face the window.": lambda a, b: (
        sum(turned_deg(a, b, o.id) > 1.0 for o in b.objects if o.category == "chair") >= 4
    ),
    "Swap the coffee table for a round one.": lambda a, b: _about(
        _size(a, "coffee_table_1", 0), _size(a, "coffee_table_1", 1)
    ),
    "Make a copy of the side table on the other side of the sofa.": lambda a, b: (
        _new(a, b, "side table") == 1 and apart_m(a, "side_table_1", "side_table_2") > 1.0
    ),
    "Give the sofa a dark green colour.": lambda a, b: a.object("sofa_1").colour is not None,
    "The sofa should be leather.": lambda a, b: (
        "leather" in built_in_library().shape(a.object("sofa_1").shape_id).caption
    ),
    "Paint the walls a warm white and the ceiling white.": lambda a, b: (
        all(_finishes(a, "wall")) and _finishes(a, "ceiling")[0] != _finishes(a, "wall")[0]
    ),
    "Put in an oak floor.": lambda a, b: _finishes(a, "floor")[0].pattern == "boards",
    "Paint the wall behind the sofa terracotta.": lambda a, b: (
        sum(f is not None for f in _finishes(a, "wall")) == 1 and a.plane("wall_0").finish is not None
    ),
    "Raise the ceiling to 2.8 m.": lambda a, b: _about(ceiling_height(a) or 0.0, 2.8),
    "Make the room one metre longer.": lambda a, b: _about((_lengths(a) - _lengths(b))[1], 1.0),
    "Put a window in the wall behind the piano.": lambda a, b: (
        _new(a, b, "window") == 1 and a.support_of("window_2").parent == "wall_3"
    ),
    "Open the door.": lambda a, b: a.object("door_1").open_share == 1.0,
    "Hang the pictures a little higher.": lambda a, b: all(_place(a, p)[2] > _place(b, p)[2] for p in PICTURES),
    "Line up the pictures.": lambda a, b: float(np.ptp([_place(a, p)[2] for p in PICTURES])) < 1e-6,
    "Centre the rug under the coffee table.": lambda a, b: apart_m(a, "rug_1", "coffee_table_1") < 0.1,
    "Make the light warmer.": lambda a, b: a.light_settings != b.light_settings,
    "Lock the piano.": lambda a, b: a.object("piano_1").locked,
    "Hide the ceiling lamp.": lambda a, b: a.object("ceiling_lamp_1").hidden,
    "Call the plant Ficus.": lambda a, b: a.object("plant_1").label == "Ficus",
    "Swap the sideboard and the piano.": lambda a, b: (
        np.linalg.norm(_place(a, "piano_1") - _place(b, "sideboard_1")) < 0.5
    ),
}
REFUSED = {
    "Make the light warmer.": "the light has its colour from the hour and the lamps",
}
"""What this room or the page cannot do, and why."""

REPORTED: dict[str, Check] = {
    "add two lamps": lambda a, b: len(a.objects) == len(b.objects) + 2,
    "make the walls brick": lambda a, b: all(f.pattern == "brick" for f in _finishes(a, "wall")),
    "wooden floor": lambda a, b: _finishes(a, "floor")[0].pattern == "boards",
    "make the sofa 2 m wide": lambda a, b: _about(_size(a, "sofa_1", 1), 2.0),
    "duplicate the side table": lambda a, b: _new(a, b, "side table") == 1,
    "paint the ceiling darker": lambda a, b: (
        np.mean(_finishes(a, "ceiling")[0].colour) < np.mean(b.architecture.by_role("ceiling")[0].colour)
    ),
    "turn the television towards the window": lambda a, b: turned_deg(a, b, "television_1") > 1.0,
}
MORE: dict[str, Check] = {
    "set the height of the plant to 1.5 m": lambda a, b: _about(_size(a, "plant_1", 2), 1.5),
    "make the coffee table 20 cm lower": lambda a, b: _about(
        _size(b, "coffee_table_1", 2) - _size(a, "coffee_table_1", 2), 0.2
    ),
    "tiles on the floor": lambda a, b: _finishes(a, "floor")[0].pattern == "tiles",
    "I want wallpaper on the wall behind the sofa": lambda a, b: a.plane("wall_0").finish.pattern == "leaves",
    "make it evening": lambda a, b: a.light_settings.hour == 18.5,
    "set the time to 6:30 pm": lambda a, b: a.light_settings.hour == 18.5,
    "turn on the lamps": lambda a, b: set(a.light_settings.lamps_on or ()) == {"lamp_1", "ceiling_lamp_1"},
    "switch the ceiling lamp off": lambda a, b: "ceiling_lamp_1" not in (a.light_settings.lamps_on or ()),
    "make the room darker": lambda a, b: a.light_settings.exposure_ev < 0,
    "make the room 7 m long": lambda a, b: _about(_lengths(a)[1], 7.0),
    "lower the ceiling by 10 cm": lambda a, b: _about((ceiling_height(b) or 0) - (ceiling_height(a) or 0), 0.1),
    "add a door to the right wall": lambda a, b: _new(a, b, "door") == 1,
    "rename the sofa to Old Couch": lambda a, b: a.object("sofa_1").label == "Old Couch",
    "make two copies of the plant": lambda a, b: _new(a, b, "plant") == 2,
    "space the pictures evenly": lambda a, b: a != b,
    "unlock the piano": lambda a, b: not a.object("piano_1").locked,
    "Change the sofa's colour to mustard.": lambda a, b: a.object("sofa_1").colour is not None,
    "I want the piano gone.": lambda a, b: not a.has_object("piano_1"),
    "I don't need the radiator.": lambda a, b: not a.has_object("radiator_1"),
    "I'd prefer the piano against the opposite wall.": lambda a, b: (
        apart_m(a, "piano_1", "sofa_1") != (apart_m(b, "piano_1", "sofa_1"))
    ),
    "The rug is a bit too small, make it 3 by 2 metres.": lambda a, b: (
        _about(max(_size(a, "rug_1", 0), _size(a, "rug_1", 1)), 3.0)
        and _about(min(_size(a, "rug_1", 0), _size(a, "rug_1", 1)), 2.0)
    ),
    "The sideboard is too long; make it 1.6 metres.": lambda a, b: _about(_size(a, "sideboard_1", 1), 1.6),
    "Make the coffee table 1.2 m long and 60 cm deep.": lambda a, b: (
        _about(_size(a, "coffee_table_1", 1), 1.2) and _about(_size(a, "coffee_table_1", 0), 0.6)
    ),
    "Make the coffee table the same height as the side table.": lambda a, b: _about(
        _size(a, "coffee_table_1", 2), _size(b, "side_table_1", 2)
    ),
    "Bring the coffee table closer to the sofa, about 30 centimetres away.": lambda a, b: _about(
        _gap(a, "coffee_table_1", "sofa_1"), 0.3
    ),
    "Put the sofa 30 cm from the wall.": lambda a, b: _about(gap_to_wall(a, "sofa_1"), 0.3),
    "Remove all of the pictures but keep the largest.": lambda a, b: _new(a, b, "picture") == -3,
    "Swap the sofa for two armchairs.": lambda a, b: _new(a, b, "armchair") == 2 and not _count(a, "sofa"),
    "Get a wooden stool for the piano.": lambda a, b: _new(a, b, "stool") == 1 and _new(a, b, "piano") == 0,
    "Add curtains to the window.": lambda a, b: _new(a, b, "curtain") == 1,
    "Add a small table with a lamp on it beside the piano.": lambda a, b: _new(a, b, "lamp") == 1,
    "Give me a bigger rug.": lambda a, b: _new(a, b, "rug") == 0 and _size(a, "rug_1", 0) > _size(b, "rug_1", 0),
    "Make the room 6 by 5 metres.": lambda a, b: _about(_lengths(a)[0], 5.0) and _about(_lengths(a)[1], 6.0),
    "Let me see the room at night.": lambda a, b: a.light_settings.hour == 23.0,
    "Please remove anything that is on the sideboard.": lambda a, b: not a.children_of("sideboard_1"),
    "Turn the television so it faces the window.": lambda a, b: turned_deg(a, b, "television_1") > 1.0,
    "Push the sofa back against the wall.": lambda a, b: gap_to_wall(a, "sofa_1") < 0.1,
}
NOT_UNDERSTOOD = {
    "Put the rug parallel to the sofa.": "“parallel”",
    "Move the piano to where the sideboard is.": "“where”",
}
"""Words that are not known are named: nothing else is done instead."""


def _asked(sentence: str) -> tuple[Scene, Scene]:
    before = dining_room() if " chairs" in sentence else living_room()
    return propose_edits(sentence, before, built_in_library()).scene, before


@pytest.mark.parametrize("sentence", NATURAL)
def test_natural_sentences(sentence: str) -> None:
    if sentence in REFUSED:
        with pytest.raises(EditRefused, match=REFUSED[sentence]):
            _asked(sentence)
        return
    assert NATURAL[sentence](*_asked(sentence))


@pytest.mark.parametrize("sentence", NOT_UNDERSTOOD)
def test_what_is_not_understood_is_named(sentence: str) -> None:
    with pytest.raises(EditRefused, match=NOT_UNDERSTOOD[sentence]):
        _asked(sentence)


@pytest.mark.parametrize("sentence", {**REPORTED, **MORE})
def test_every_edit_of_the_page_has_its_words(sentence: str) -> None:
    assert {**REPORTED, **MORE}[sentence](*_asked(sentence))


@pytest.mark.parametrize(
    "sentence",
    ["make the floor of the sofa happy", "hang the lamp on the wall", "put the plant on the floor by the wall"],
)
def test_walls_and_floors_that_are_places_are_not_painted(sentence: str) -> None:
    try:
        after, before = _asked(sentence)
    except EditRefused:
        return
    assert after.architecture == before.architecture
