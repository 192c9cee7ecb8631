"""Shapes that a prompt's words mean."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import Shape
from diorama_core.text.prompt import RequestedObject, Wish
from diorama_core.text.requested_shapes import SEAT_WIDTH_M, TALL_PLANT_M, dressed, requested_shapes
from tests.text.edited import living_room


def shapes(*wanted: RequestedObject, seed: int = 0) -> tuple[Shape, ...]:
    """For the first of them."""
    return requested_shapes(built_in_library(), np.random.default_rng(seed), wanted[0], wanted)


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
    assert dressed(scene, "sofa_1", shape, ("purple",)).object("sofa_1").colour is not None
    assert dressed(scene, "sofa_1", shape, ("dark", "zorkmid")) is scene
