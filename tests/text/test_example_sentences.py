"""Sentences that a customer says to the example's room, written down before the grammar was looked at."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

import diorama_core as diorama
from diorama_core.errors import EditRefused
from diorama_core.io.assets import asset
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.room_edits import ceiling_height
from diorama_core.scene.types import Scene
from diorama_core.text.edit_wording import clauses_of
from diorama_core.text.editing_by_words import propose_edits
from tests.text.edited import apart_m, assert_sound, turned_deg

Check = Callable[[Scene, Scene], bool]


@cache
def example() -> Scene:
    return diorama.load(asset("example") / "project").scene


def _new(after: Scene, before: Scene) -> list[str]:
    return [o.category for o in after.objects if not before.has_object(o.id)]


def _gone(after: Scene, before: Scene) -> set[str]:
    return {o.id for o in before.objects if not after.has_object(o.id)}


def _way(after: Scene, before: Scene, object_id: str) -> np.ndarray:
    return np.asarray(after.object(object_id).pose.position - before.object(object_id).pose.position)


def _size(scene: Scene, object_id: str) -> np.ndarray:
    return np.asarray(scene.object(object_id).size_m)


CHAIRS = ("chair_1", "chair_2", "chair_3")
DONE: dict[str, Check] = {
    "Put a reading lamp next to the armchair.": lambda a, b: (
        _new(a, b) == ["floor lamp"] and apart_m(a, "floor_lamp_2", "armchair_1") < 1.0
    ),
    "Swap the two pictures.": lambda a, b: (
        abs(_way(a, b, "picture_1")[0] - 0.92) < 0.1 and abs(_way(a, b, "picture_2")[0] + 0.92) < 0.1
    ),
    "Get rid of everything on the dining table.": lambda a, b: _gone(a, b) == {"vase_3", "bowl_2"},
    "I need a TV opposite the sofa.": lambda a, b: _new(a, b) == ["television"],
    "Can you move the sofa a little to the left?": lambda a, b: -0.2 <= _way(a, b, "sofa_1")[0] < -0.03,
    "Push the armchair back against the wall.": lambda a, b: (
        float(a.object("armchair_1").corners_world[:, 0].max()) > 2.8
    ),
    "Take the pillows off the sofa.": lambda a, b: _gone(a, b) == {"pillow_1", "pillow_2"},
    "I don't like the rug, remove it.": lambda a, b: _gone(a, b) == {"rug_1"},
    "Make the rug 50 % bigger.": lambda a, b: bool(np.allclose(_size(a, "rug_1"), 1.5 * _size(b, "rug_1"))),
    "Change the colour of the armchair to mustard yellow.": lambda a, b: a.object("armchair_1").colour is not None,
    "Add a fourth chair to the table.": lambda a, b: _new(a, b) == ["chair"] and apart_m(a, "chair_4", "table_1") < 1.4,
    "Hang the clock above the mirror.": lambda a, b: (
        abs(a.object("clock_1").pose.position[0] - a.object("mirror_1").pose.position[0]) < 0.8
    ),
    "Replace the plant on the coffee table with a vase.": lambda a, b: a.object("plant_1").category == "vase",
    "Turn the armchair so it faces the sofa.": lambda a, b: turned_deg(a, b, "armchair_1") > 10.0,
    "Give the armchair a cushion.": lambda a, b: a.children_of("armchair_1") == ("pillow_3",),
    "The ceiling is too low, make it 3 metres high.": lambda a, b: ceiling_height(a) == pytest.approx(3.0, abs=0.01),
    "Paint the back wall dark blue.": lambda a, b: (
        a.plane("wall_1").finish is not None and a.plane("wall_2").finish is None
    ),
    "Let's have a darker wooden floor.": lambda a, b: (
        (finish := a.plane("floor").finish) is not None and finish.pattern == "boards"
    ),
    "Switch off all the lamps.": lambda a, b: a.light_settings.lamps_on == (),
    "Make it night time.": lambda a, b: a.light_settings.hour == 23.0,
    "Delete the smallest plant.": lambda a, b: _gone(a, b) == {"plant_2"},
    "The sofa is too small, make it 40 cm longer.": lambda a, b: (
        float((_size(a, "sofa_1") - _size(b, "sofa_1"))[1]) == pytest.approx(0.4)
    ),
    "Rotate the coffee table a quarter turn.": lambda a, b: turned_deg(a, b, "coffee_table_1") == pytest.approx(90.0),
    "Bring the floor lamp over to the sofa.": lambda a, b: apart_m(a, "floor_lamp_1", "sofa_1") < 1.5,
    "Replace all the chairs with wooden stools.": lambda a, b: all(a.object(c).category == "stool" for c in CHAIRS),
    "Lower the ceiling lamp by 20 cm.": lambda a, b: (
        float(np.ptp(_way(a, b, "ceiling_lamp_1"))) == pytest.approx(0.1)  # its middle, as its top stays
        and float((_size(a, "ceiling_lamp_1") - _size(b, "ceiling_lamp_1"))[2]) == pytest.approx(0.2)
    ),
    "Put the pictures at the same height.": lambda a, b: (
        a.object("picture_1").pose.position[2] == a.object("picture_2").pose.position[2]
    ),
}
REFUSED = {
    "Put the bowl from the coffee table onto the side table.": "no free place for bowl on side table",
    "Put two more pillows on the sofa.": "1 of 2 would fit",
    "Move the big plant to the other corner.": "no free place for plant in the other corner",
    "Place a desk with an office chair by the left wall.": "no left wall",
    "Move the dining table and its chairs half a metre towards the window wall.": "no window in this scene",
}
"""What this room has no place for, or what it has not: of its walls the photo shows two, its one corner is full."""
MORE: dict[str, Check] = {
    "Move the dining table and its chairs half a metre towards the right wall.": lambda a, b: all(
        _way(a, b, i)[0] == pytest.approx(0.5, abs=0.02) for i in ("table_1", "vase_3", *CHAIRS)
    ),
    "Place a desk with an office chair by the right wall.": lambda a, b: (
        sorted(_new(a, b)) == ["desk", "office chair"] and apart_m(a, "desk_1", "office_chair_1") < 1.0
    ),
    "Put a cushion on each chair.": lambda a, b: all(len(a.children_of(c)) == 1 for c in CHAIRS),
    "Take the cup and put it on the bookshelf.": lambda a, b: "cup_1" in a.children_of("bookshelf_1"),
    "I'd like the armchair next to the bookshelf.": lambda a, b: apart_m(a, "armchair_1", "bookshelf_1") < 1.5,
    "The room is too dark.": lambda a, b: a.light_settings.exposure_ev > b.light_settings.exposure_ev,
    "Show me the room in the evening with the lamps on.": lambda a, b: (
        a.light_settings.hour == 18.5 and bool(a.light_settings.lamps_on)
    ),
    "Duplicate the armchair and put the copy on the other side of the sofa.": lambda a, b: _new(a, b) == ["armchair"],
}
"""Sentences of the same mended kinds, and what other sentences taught."""


@pytest.mark.parametrize("sentence", DONE | MORE)
def test_what_is_said_of_the_example_is_done(sentence: str) -> None:
    before = example()
    after = propose_edits(sentence, before, built_in_library()).scene
    assert (DONE | MORE)[sentence](after, before)
    if "Swap" not in sentence and "ceiling" not in sentence:  # which what hangs beside may meet
        assert_sound(before, after)


@pytest.mark.parametrize("sentence", REFUSED)
def test_what_the_room_does_not_have_is_refused_in_a_line_that_says_what(sentence: str) -> None:
    with pytest.raises(EditRefused, match=REFUSED[sentence]):
        propose_edits(sentence, example(), built_in_library())


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("I don't like the rug, remove it.", ("remove the rug",)),
        ("The sofa is too small so please make it bigger.", ("please make the sofa bigger",)),
        ("The sofa is too small.", ("make the sofa bigger",)),
        ("Take the cup from the table and put it on the shelf.", ("put the cup on the table on the shelf",)),
        ("Lock the sofa and hide the rug.", ("lock the sofa", "hide the rug")),
        ("Add a cupboard and open shelf.", ("add a cupboard and open shelf",)),
    ],
)
def test_remarks_say_what_the_next_clause_is_about(said: str, meant: tuple[str, ...]) -> None:
    assert clauses_of(said) == meant
