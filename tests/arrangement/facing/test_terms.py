"""The fitted weights and what is told of them. Where each term would have things face, seen from above."""

from __future__ import annotations

import json
from dataclasses import asdict, fields, replace

import numpy as np
import pytest

from diorama_core.arrangement.facing.evidence import FacingRoom
from diorama_core.arrangement.facing.terms import PATH, TERMS, FacingWeights, Term, facing_weights
from tests.arrangement.facing.rooms import heading_deg, room, thing, wall_along_y


def test_every_weight_is_fitted_and_says_what_leaving_it_out_costs() -> None:
    document = json.loads(PATH.read_text())
    weights = asdict(facing_weights())
    assert all(weight > 0 for weight in weights.values())
    assert document["command"].startswith("python -m diorama_core.training facings")
    assert set(document["change of that without a term"]) == set(weights)


BY_NAME = {term.name: term for term in TERMS}


def best_deg(name: str, seen: FacingRoom, i: int = 0) -> int | None:
    """The heading that a term of single objects likes most; None where it says nothing."""
    found = BY_NAME[name].one(seen, i)
    return None if found is None else heading_deg(seen.objects[i], int(found.argmax()))


def alike_deg(term: Term, seen: FacingRoom, i: int, j: int, heading: int) -> int:
    """The heading of one object that a term of pairs likes most, given that of another."""
    found = term.pair(seen, i, j)
    return heading_deg(seen.objects[i], int(found[:, heading].argmax()))


def test_every_term_has_a_weight_and_every_weight_but_the_picture_s_a_term() -> None:
    assert {f.name for f in fields(FacingWeights)} == {"picture", *BY_NAME}


@pytest.mark.parametrize("name", [n for n in BY_NAME if n.startswith("shown")])
def test_only_one_of_the_terms_of_showing_speaks_of_each_kind(name: str) -> None:
    kinds = ("chair", "sofa", "dresser", "monitor", "bed", "plant")
    speaking = [k for k in kinds if BY_NAME[name].one(room(thing(k, 0.0, 3.0)), 0) is not None]
    assert len(speaking) == 1
    assert best_deg(name, room(thing(speaking[0], 0.0, 3.0))) == -90


@pytest.mark.parametrize(("x", "y", "wanted"), [(1.0, 3.0, 180), (-1.0, 3.4, 0), (0.0, 4.6, -90), (0.3, 1.5, 90)])
def test_a_chair_faces_the_side_of_the_table_where_it_stands(x: float, y: float, wanted: int) -> None:
    table = thing("table", 0.0, 3.0, (0.8, 2.0, 0.7), 0.0)
    found = best_deg("at_table", room(thing("chair", x, y), table))
    assert found % 360 == wanted % 360, "square to the side, whatever the table's middle"


def test_a_chair_far_from_any_table_faces_none() -> None:
    assert best_deg("at_table", room(thing("chair", 3.0, 3.0), thing("table", 0.0, 3.0))) is None


def test_a_monitor_faces_its_keyboard_or_else_the_seat() -> None:
    desk, seat = thing("desk", 0.0, 3.0, (0.7, 1.4, 0.75), 90.0), thing("office chair", 0.0, 3.8)
    monitor = thing("monitor", 0.0, 2.8, (0.2, 0.5, 0.4), carrier=1)
    keyboard = thing("keyboard", 0.3, 2.8, (0.15, 0.4, 0.02), carrier=1)
    assert best_deg("at_user", room(monitor, desk, seat)) == 90
    assert best_deg("at_user", room(monitor, desk, seat, keyboard)) == 0


def test_storage_turns_its_back_to_the_wall_that_is_near() -> None:
    walls = wall_along_y(-1.0)
    assert best_deg("back_at_wall", room(thing("dresser", -0.7, 3.0), walls=walls)) == 0
    far = BY_NAME["back_at_wall"].one(room(thing("dresser", 1.5, 3.0), walls=walls), 0)
    assert np.abs(far).max() < 1e-9


def test_what_hangs_looks_out_of_its_wall_and_what_was_told_holds() -> None:
    hung = thing("picture", -1.0, 3.0, out_of_wall=np.array([1.0, 0.0]))
    assert best_deg("out_of_wall", room(hung)) == 0
    assert best_deg("as_told", room(thing("desk", 0.0, 3.0, turn_deg=90.0, front_known=True))) == 90


def test_pillows_lean_across_a_sofa_and_along_a_bed() -> None:
    sofa, bed = thing("sofa", -2.0, 3.0, (0.9, 2.2, 0.8), 0.0), thing("bed", 2.0, 3.0, (2.0, 1.6, 0.6), 0.0)
    on_sofa = thing("pillow", -2.0, 3.3, (0.2, 0.5, 0.4), 90.0, carrier=2)
    on_bed = thing("pillow", 1.3, 3.0, (0.2, 0.5, 0.4), 90.0, carrier=3)
    seen = room(on_sofa, on_bed, sofa, bed)
    assert [best_deg("leaning", seen, i) for i in (0, 1)] == [0, 0]


def test_furniture_faces_the_middle_and_seats_do_not() -> None:
    others = (thing("plant", 2.0, 3.0), thing("plant", 3.0, 3.0))
    assert best_deg("at_middle", room(thing("dresser", 0.0, 3.0), *others)) == 0
    assert best_deg("at_middle", room(thing("chair", 0.0, 3.0), *others)) is None


@pytest.mark.parametrize("heading", [0, 6, 12])
def test_books_show_their_spines_as_their_shelf_its_front(heading: int) -> None:
    books, shelf = thing("books", 0.0, 3.0, (0.2, 0.3, 0.25), carrier=1), thing("bookshelf", 0.0, 3.0)
    seen = room(books, shelf)
    assert alike_deg(BY_NAME["as_carrier"], seen, 0, 1, heading) == heading_deg(shelf, heading)
    assert BY_NAME["as_carrier"].pair(seen, 1, 0) is None


def test_chairs_side_by_side_face_alike_and_those_in_a_file_may_not() -> None:
    row = BY_NAME["side_by_side"].pair(room(thing("chair", 0.0, 3.0), thing("chair", 0.7, 3.0)), 0, 1)
    file = BY_NAME["side_by_side"].pair(room(thing("chair", 0.0, 3.0), thing("chair", 0.0, 3.7)), 0, 1)
    assert row[0, 0] > 0.9 > 0.1 > abs(file[0, 0])
    assert BY_NAME["side_by_side"].pair(room(thing("chair", 0.0, 3.0), thing("chair", 2.0, 3.0)), 0, 1) is None


def test_a_refrigerator_at_the_end_of_a_counter_faces_as_that_does() -> None:
    found = BY_NAME["side_by_side"].pair(
        room(thing("refrigerator", 0.0, 3.0), thing("kitchen counter", 0.7, 3.0)), 0, 1
    )
    assert found[0, 0] > 0.9


def test_a_night_stand_faces_as_the_bed_beside_it() -> None:
    bed = thing("bed", 0.0, 3.0, (2.0, 1.6, 0.6), 0.0)
    stand = thing("night stand", -0.7, 4.1)
    assert alike_deg(BY_NAME["as_bed"], room(stand, bed), 0, 1, 0) == 0
    assert BY_NAME["as_bed"].pair(room(replace(stand, kind="plant"), bed), 0, 1) is None
