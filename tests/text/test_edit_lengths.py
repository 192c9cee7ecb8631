"""Distances in edits by words: along the floor, nearer to things, up and down walls."""

from __future__ import annotations

import pytest

from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.text.edit_lengths import A_LITTLE_M, HUNG_STEP_M, MAX_SHIFT_M, lift, nearer, quantity_edits, shift_of
from diorama_core.text.edit_plan import Insert
from diorama_core.text.selecting import Selector, all_but
from tests.text.edited import dining_room, living_room

SELECTOR = Selector(living_room(), built_in_library())


@pytest.mark.parametrize(
    ("words", "right_m", "away_m"),
    [
        ("the sofa 50 cm to the left", -0.5, 0.0),
        ("the sofa two metres back", 0.0, 2.0),
        ("the sofa half a metre to the right", 0.5, 0.0),
        ("the sofa a bit forward", 0.0, -A_LITTLE_M),
    ],
)
def test_a_length_and_a_way_are_a_shift(words, right_m, away_m):
    found = shift_of(SELECTOR, words)
    assert found is not None
    assert (found.objects, found.right_m, found.away_m) == (["sofa_1"], pytest.approx(right_m), pytest.approx(away_m))


def test_what_names_no_way_is_no_shift():
    assert shift_of(SELECTOR, "the sofa beside the table") is None


def test_a_picture_is_lifted_and_lowered():
    assert lift(SELECTOR, "raise picture 1 by 20 cm", "picture 1 by 20 cm").up_m == pytest.approx(0.2)
    assert lift(SELECTOR, "lower picture 1", "picture 1").up_m == -HUNG_STEP_M


def test_nearer_needs_an_object_to_go_nearer_to():
    assert nearer(SELECTOR, "the sofa closer to the wall") is None
    assert nearer(SELECTOR, "the sofa beside the piano") is None


def test_farther_than_any_room_is_refused():
    with pytest.raises(EditRefused, match=f"at most {MAX_SHIFT_M:g} m"):
        shift_of(SELECTOR, "the sofa 200 m to the left")


@pytest.mark.parametrize(
    ("text", "spared"),
    [
        ("all but one of the pillows", (1, "pillows")),
        ("all except 2 chairs", (2, "chairs")),
        ("all but the chairs", None),
        ("all chairs", None),
    ],
)
def test_some_are_spared(text: str, spared: tuple[int, str] | None) -> None:
    assert all_but(text) == spared


def test_more_of_a_kind_are_as_many_as_asked_and_not_too_many() -> None:
    selector = Selector(dining_room(), built_in_library())
    assert quantity_edits(selector, "double the chairs") == (Insert(what="chair", count=5),)
    assert quantity_edits(selector, "i want twice as many chairs") == (Insert(what="chair", count=5),)
    assert quantity_edits(selector, "remove the chairs") is None
    with pytest.raises(EditRefused, match="15 more"):
        quantity_edits(selector, "quadruple the number of chairs")
    with pytest.raises(EditRefused, match="no piano"):
        quantity_edits(selector, "double the number of pianos")
