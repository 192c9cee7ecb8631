"""Attributes of form as a person would state them of built-in shapes."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.form import agrees, compare, form_at, form_of
from diorama_core.library.slots import Slot

LIBRARY = built_in_library()


def form(shape_id: str, stretch=(1.0, 1.0, 1.0)):
    shape = LIBRARY.shape(shape_id)
    return form_at(LIBRARY, shape, np.array(shape.size_m) * stretch)


@pytest.mark.parametrize(
    ("shape_id", "top", "base"),
    [
        ("table-oak-classic", "rectangular", "four legs"),
        ("table-white-square", "square", "four legs"),
        ("table-round-tulip", "round", "pedestal"),
        ("table-steel-hoop", "rectangular", "sled"),
        ("table-oval-walnut", "oval", "four legs"),
        ("coffee-table-round-drum", "round", "plinth"),
        ("coffee-table-oak-shelf", "rectangular", "four legs"),
        ("coffee-table-tray-linen", "rectangular", "plinth"),
        ("coffee-table-plain-oak", "rectangular", "four legs"),
        ("coffee-table-plain-white-shelf", "rectangular", "four legs"),
        ("coffee-table-bent-oak", "rectangular", "sled"),
        ("side-table-plain-oak", "square", "four legs"),
        ("side-table-round-oak", "round", "four legs"),
        ("side-table-plinth-white", "square", "plinth"),
    ],
)
def test_tops_and_bases_of_tables(shape_id, top, base) -> None:
    found = form(shape_id)
    assert (found["top"], found["base"]) == (top, base)


def test_a_round_table_stretched_is_oval() -> None:
    assert form("table-round-tulip", (1.0, 1.6, 1.0))["top"] == "oval"


@pytest.mark.parametrize(
    ("shape_id", "arms"),
    [("chair-slat-oak", "no"), ("chair-padded-blue", "yes"), ("office-chair-task-blue", "no"),
     ("armchair-club-leather", "yes"), ("sofa-grey-three", "yes"), ("sofa-daybed", "no")],
)  # fmt: skip
def test_arms(shape_id, arms) -> None:
    assert form(shape_id)["arms"] == arms


@pytest.mark.parametrize(
    ("shape_id", "upholstered", "open_back"),
    [("chair-ladder-walnut", "no", "yes"), ("chair-padded-tan", "yes", "no"), ("chair-shell-white", "no", "no"),
     ("chair-wire-black", "yes", "yes"), ("office-chair-bankers-oak", "no", "yes")],
)  # fmt: skip
def test_upholstery_and_backs(shape_id, upholstered, open_back) -> None:
    found = form(shape_id)
    assert (found["upholstered"], found["open back"]) == (upholstered, open_back)


def test_a_stool_has_no_back_and_easy_seats_are_alike_in_both() -> None:
    stool = form("stool-plush-blush")
    assert stool["upholstered"] == "yes"
    assert "open back" not in stool
    for easy in ("sofa-grey-three", "armchair-club-leather"):
        assert not {"upholstered", "open back"} & set(form(easy))


def test_of_materials_that_nobody_named_nothing_is_said() -> None:
    mesh, size_m = LIBRARY.mesh("chair-padded-tan"), np.array(LIBRARY.shape("chair-padded-tan").size_m)
    unknown = Slot("material", "material", ("body",), 2.0, main=True)
    for slots in ((), (unknown,), (unknown, Slot("fabric", "fabric", ("seat",), 1.0, main=False))):
        found = form_of("own-chair", "chair", mesh, size_m, slots)
        assert "upholstered" not in found
        assert found["open back"] == "no"


@pytest.mark.parametrize("shape_id", ["chair-tub-pedestal-blush", "chair-shell-tulip-white"])
def test_dining_chairs_on_pedestals(shape_id) -> None:
    assert form(shape_id)["base"] == "pedestal"


def test_an_office_chair_stands_on_a_star() -> None:
    assert form("office-chair-mesh-black")["base"] == "five-star"


def test_drawers_and_doors_are_counted_by_their_joints() -> None:
    assert form("dresser-oak-six")["drawers"] == 6
    assert form("cabinet-two-door-white")["doors"] == 2


def test_statements_agree_with_numbers_and_squares_with_rectangles() -> None:
    assert agrees("yes", 3)
    assert agrees("no", 0)
    assert agrees("square", "rectangular")
    assert not agrees("yes", 0)
    assert not agrees(2, 3)
    assert compare({"top": "round", "back": "high"}, {"top": "oval", "base": "sled"}) == {"top": False}
