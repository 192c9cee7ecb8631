"""Rooms for what is asked: as large as their furniture needs, with what such rooms have."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import Shape
from diorama_core.scene.types import Scene
from diorama_core.text.prompt import RequestedObject, RoomRequest, Wish
from diorama_core.text.requested_room import (
    SEAT_WIDTH_M,
    TALL_PLANT_M,
    dress,
    empty_room,
    shapes_for,
    with_essentials,
)
from tests.text.edited import living_room


def counts(request: RoomRequest) -> dict[str, int]:
    return {o.category: o.count for o in with_essentials(request)[0]}


def test_a_named_room_has_what_its_kind_has_unless_something_does_the_same() -> None:
    asked = (RequestedObject("toilet", "toilet"), RequestedObject("shower", "shower"))
    assert counts(RoomRequest("bathroom", asked, named=True)) == {"toilet": 1, "shower": 1, "sink": 1}
    assert with_essentials(RoomRequest("bathroom", asked, named=True))[1] == ("sink",)
    assert counts(RoomRequest("bathroom", asked)) == {"toilet": 1, "shower": 1}


def test_what_lies_on_furniture_gets_some_where_none_is_asked_for() -> None:
    lamps = RequestedObject("lamp", "lamp", 3)
    assert counts(RoomRequest("living", (lamps,))) == {"lamp": 3, "side table": 2}
    assert counts(RoomRequest("bedroom", (lamps,))) == {"lamp": 3, "night stand": 2}
    assert counts(RoomRequest("living", (lamps, RequestedObject("desk", "desk")))) == {"lamp": 3, "desk": 1}
    placed = RequestedObject("lamp", "lamp", wishes=(Wish("on", ("piano",)),))
    assert counts(RoomRequest("living", (placed,))) == {"lamp": 1}


def area_m2(scene: Scene) -> float:
    assert scene.architecture.floor is not None
    return float(np.prod(np.ptp(scene.architecture.floor.polygon[:, :2], axis=0)))


def room_for(request: RoomRequest, attempt: int = 0) -> Scene:
    library = built_in_library()
    shapes = {k: library.in_category(o.category)[:1] for k, o in enumerate(request.objects)}
    return empty_room(request, library, np.random.default_rng(5), request.objects, shapes, attempt)


def test_more_furniture_a_wish_for_size_and_later_attempts_make_rooms_larger() -> None:
    few, many = (RoomRequest("living", (RequestedObject("sofa", "sofa", n),)) for n in (1, 12))
    assert area_m2(room_for(few)) < area_m2(room_for(many))
    assert area_m2(room_for(few)) < area_m2(room_for(RoomRequest("living", few.objects, size=1.3)))
    assert area_m2(room_for(few, 2)) == pytest.approx(area_m2(room_for(few)) * 1.16**2)


def test_every_room_has_a_door_and_as_many_windows_as_are_asked_for() -> None:
    windows = RequestedObject("window", "window", 3)
    made = [o.category for o in room_for(RoomRequest("living", (windows,))).objects]
    assert made.count("door") == 1
    assert made.count("window") == 3
    corridor = [o.category for o in room_for(RoomRequest("corridor", ())).objects]
    assert (corridor.count("door"), corridor.count("window")) == (1, 0)


def shapes(*wanted: RequestedObject, seed: int = 0) -> tuple[Shape, ...]:
    """For the first of them."""
    return shapes_for(built_in_library(), np.random.default_rng(seed), wanted[0], wanted)


def test_plants_stand_on_the_floor_unless_they_are_put_on_something() -> None:
    floor = shapes(RequestedObject("plant", "plant"))
    assert all(s.size_m[2] > TALL_PLANT_M for s in floor)
    on = shapes(RequestedObject("plant", "plant", wishes=(Wish("on", ("desk",)),)))
    assert any(s.size_m[2] < TALL_PLANT_M for s in on)


@pytest.mark.parametrize("around", [(), (Wish("around", ("table",)),)], ids=["as usual", "as wished"])
def test_a_table_has_room_for_those_who_sit_at_it(around: tuple[Wish, ...]) -> None:
    chairs = RequestedObject("chair", "chair", 8, wishes=around)
    for shape in shapes(RequestedObject("table", "dining table"), chairs):
        assert 2.0 * sum(shape.size_m[:2]) >= 8 * SEAT_WIDTH_M
    smallest = min(sum(s.size_m[:2]) for s in shapes(RequestedObject("table", "dining table")))
    assert 2.0 * smallest < 8 * SEAT_WIDTH_M


def test_a_double_bed_is_wide_and_chance_decides_among_equals() -> None:
    double = RequestedObject("bed", "double bed")
    assert all(s.size_m[1] > 1.3 for s in shapes(double))
    orders = {tuple(s.id for s in shapes(double, seed=seed)) for seed in range(4)}
    assert len(orders) > 1
    assert len({frozenset(order) for order in orders}) == 1


def test_a_single_bed_is_narrow() -> None:
    single = shapes(RequestedObject("bed", "bed", 2, ("single",)))
    assert single
    assert all(s.size_m[1] <= 1.3 for s in single)


def test_colours_that_a_shape_lacks_are_painted_on() -> None:
    scene = living_room()
    shape = next(s for s in built_in_library().in_category("sofa") if s.id == scene.object("sofa_1").shape_id)
    assert dress(scene, "sofa_1", shape, ("purple",)).object("sofa_1").colour is not None
    assert dress(scene, "sofa_1", shape, ("dark", "zorkmid")) is scene
