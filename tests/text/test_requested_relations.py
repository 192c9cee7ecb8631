"""Wishes in a scene: what they name is found there, and placed before them."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.editing.relations import Relation
from diorama_core.scene.types import Scene
from diorama_core.text.prompt import RequestedObject, Wish
from diorama_core.text.requested_relations import (
    is_sat_around,
    place_seat,
    placement_order,
    row_relations,
    seats_at,
    stands_between,
    targets_of,
    usual_relations,
)
from tests.editing.objects import item
from tests.pose.rooms import BlockLibrary

SCENE = Scene(
    objects=(
        item("sofa", (0.9, 2.0, 0.8), 0.0, 0.0),
        item("coffee table", (0.6, 1.0, 0.4), 1.2, 0.0),
        item("desk", (0.6, 1.2, 0.75), 3.0, 0.0),
    )
)


def order(*wanted: RequestedObject) -> list[str]:
    return [wanted[k].category for k in placement_order(wanted)]


def test_what_others_refer_to_comes_first_and_the_floor_before_walls_and_tables() -> None:
    lamp = RequestedObject("lamp", "lamp", wishes=(Wish("on", ("night stand",)),))
    stand = RequestedObject("night stand", "night stand", 2, wishes=(Wish("beside", ("bed",)),))
    picture, bed = RequestedObject("picture", "picture"), RequestedObject("bed", "bed")
    assert order(lamp, picture, stand, bed) == ["bed", "night stand", "picture", "lamp"]


def test_circles_of_wishes_have_an_order_too() -> None:
    sofa = RequestedObject("sofa", "sofa", wishes=(Wish("opposite", ("piano",)),))
    piano = RequestedObject("piano", "piano", wishes=(Wish("opposite", ("sofa",)),))
    assert sorted(order(sofa, piano)) == ["piano", "sofa"]


def test_copies_share_what_they_name_and_what_is_absent_is_nothing() -> None:
    assert targets_of(SCENE, Wish("beside", ("sofa",)), 3) == ("sofa",)
    assert targets_of(SCENE, Wish("between", ("sofa", "desk")), 0) == ("sofa", "desk")
    assert targets_of(SCENE, Wish("beside", ("piano",)), 0) == ()


def test_what_is_usual_yields_to_what_is_said() -> None:
    plain = usual_relations(SCENE, RequestedObject("coffee table", "coffee table"), 0)
    assert plain == [Relation("in front of", ("sofa",))]
    in_corner = RequestedObject("side table", "side table", wishes=(Wish("in corner"),))
    assert usual_relations(SCENE, in_corner, 0) == []
    seat = RequestedObject("armchair", "armchair", wishes=(Wish("in front of", ("sofa",)),))
    assert Relation("facing", ("sofa",)) in usual_relations(SCENE, seat, 0)


def test_a_night_stand_between_beds_is_there_before_them() -> None:
    stand = RequestedObject("night stand", "night stand", wishes=(Wish("between", ("bed",)),))
    beds = RequestedObject("bed", "bed", 2)
    assert stands_between(stand, [beds, stand]) == "bed"
    assert stands_between(stand, [RequestedObject("bed", "bed"), stand]) == ""
    assert order(beds, stand) == ["night stand", "bed"]


def test_a_table_to_sit_around_needs_room_on_all_sides() -> None:
    table = RequestedObject("coffee table", "coffee table")
    seats = RequestedObject("armchair", "armchair", 3, wishes=(Wish("around", ("coffee table",)),))
    assert is_sat_around(table, [table, seats])
    assert not is_sat_around(table, [table])


def test_seats_in_a_row_have_a_place_each() -> None:
    chair = BlockLibrary().in_category("chair")[0]
    width = float(chair.size_m[1])
    seats = RequestedObject("armchair", "armchair", 2, wishes=(Wish("opposite", ("sofa",)),))
    rows = [
        row_relations([Relation("opposite", ("sofa",)), Relation("near", ("sofa",))], seats, k, chair) for k in (0, 1)
    ]
    assert rows[0][0].aside_m == pytest.approx(-rows[1][0].aside_m)
    assert rows[1][0].aside_m - rows[0][0].aside_m > width
    assert rows[0][1].aside_m == 0.0
    alone = RequestedObject("armchair", "armchair")
    assert row_relations([Relation("opposite", ("sofa",))], alone, 0, chair) == [Relation("opposite", ("sofa",))]


@pytest.mark.parametrize(("count", "on_sides"), [(2, 2), (4, 4), (6, 4), (8, 6)])
def test_seats_face_each_other_across_a_long_table_and_the_ends_come_last(count: int, on_sides: int) -> None:
    places = np.array(seats_at((0.9, 2.0, 0.74), count))
    sides = np.abs(places[:, 0]) > 0.3
    assert len(places) == count
    assert int(sides.sum()) == on_sides
    assert sides[:on_sides].all()
    gaps = [np.linalg.norm(a - b) for k, a in enumerate(places) for b in places[:k]]
    assert min(gaps) > 0.55
    assert np.allclose(places[:on_sides].sum(axis=0), 0.0)


def test_a_round_table_has_no_places_and_a_seat_knows_its_own() -> None:
    assert seats_at((1.0, 1.0, 0.74), 4) == ()
    scene = Scene(objects=(item("table", (0.9, 2.0, 0.74), 0.0, 0.0),))
    chairs = RequestedObject("chair", "chair", 4)
    places = {place_seat(scene, [Relation("around", ("table",))], chairs, k)[0].seat_m for k in range(4)}
    assert len(places) == 4
    assert None not in places
