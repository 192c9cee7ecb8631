"""What is beside an object and on it makes kinds likelier, and what is not there less likely."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from diorama_core.artefacts import Cuboid, DetectedObject
from diorama_core.retrieval.neighbours import gap_m, is_before, with_neighbours
from diorama_core.scene.types import Support


def detected(name: str, category: str) -> DetectedObject:
    return DetectedObject(name, category, category, (0.0, 0.0, 9.0, 9.0), np.zeros((1, 1), bool), 1, 1.0)


def box(name: str, x: float, size=(1.0, 1.0, 0.8)) -> Cuboid:
    return Cuboid(name, np.eye(3), np.array([x, 0.0, size[2] / 2]), np.array(size), 1.0)


CHAIR, TABLE = {"chair": 0.8, "office chair": 0.2}, {"table": 0.8, "desk": 0.2}


def ratio(found: Mapping[str, float], one: str, other: str) -> float:
    return found[one] / found[other]


def test_a_chair_at_a_desk_is_likelier_an_office_chair_and_one_by_itself_less_likely() -> None:
    objects = [detected("a", "chair"), detected("b", "desk")]
    at_it, apart = (
        with_neighbours([CHAIR, {"desk": 1.0}], objects, [box("a", 0.0), box("b", x)], ())[0] for x in (1.2, 5.0)
    )
    assert apart["office chair"] < CHAIR["office chair"] < at_it["office chair"]
    assert sum(at_it.values()) == pytest.approx(1.0)


def test_a_table_that_carries_a_monitor_is_likelier_a_desk() -> None:
    objects, cuboids = [detected("a", "table"), detected("b", "monitor")], [box("a", 0.0), box("b", 0.0)]
    on_it = with_neighbours([TABLE, {"monitor": 1.0}], objects, cuboids, (Support("b", "a"),))[0]
    beside = with_neighbours([TABLE, {"monitor": 1.0}], objects, cuboids, ())[0]
    assert ratio(on_it, "desk", "table") > ratio(beside, "desk", "table")


def test_what_a_neighbour_may_be_counts_by_how_likely_it_is() -> None:
    objects, cuboids = [detected("a", "chair"), detected("b", "table")], [box("a", 0.0), box("b", 1.2)]
    shares = [
        with_neighbours([CHAIR, {"table": 1.0 - p, "desk": p}], objects, cuboids, ())[0]["office chair"]
        for p in (0.01, 0.3, 0.99)
    ]
    assert shares[0] < shares[1] < shares[2]


def test_a_monitor_makes_desk_and_chair_likelier_of_each_other() -> None:
    objects = [detected("a", "chair"), detected("b", "table"), detected("c", "monitor")]
    cuboids = [box("a", 0.0), box("b", 1.2), box("c", 3.0)]
    alone = [CHAIR, TABLE, {"monitor": 1.0}]
    with_it = with_neighbours(alone, objects, cuboids, (Support("c", "b"),))
    without = with_neighbours(alone[:2], objects[:2], cuboids[:2], ())
    assert with_it[1]["desk"] > without[1]["desk"]
    assert with_it[0]["office chair"] > without[0]["office chair"]


def test_a_table_before_a_sofa_is_a_coffee_table_and_one_at_its_end_a_side_table() -> None:
    low = {"coffee table": 0.5, "side table": 0.5}
    objects, sofa = [detected("a", "table"), detected("b", "sofa")], box("b", 0.0, (0.9, 2.0, 0.8))

    def found(x: float, y: float) -> Mapping[str, float]:
        table = Cuboid("a", np.eye(3), np.array([x, y, 0.2]), np.array([0.5, 0.5, 0.4]), 1.0)
        return with_neighbours([low, {"sofa": 1.0}], objects, [table, sofa], ())[0]

    assert found(1.0, 0.2)["coffee table"] > 0.7
    assert found(0.1, 1.4)["side table"] > 0.7
    assert is_before(box("a", 1.0), sofa)
    assert not is_before(box("a", 0.2), sofa)


def test_what_is_seldom_alone_is_less_likely_where_its_companion_is_not() -> None:
    objects, cuboids = [detected("a", "cabinet")], [box("a", 0.0)]
    alone = with_neighbours([{"cabinet": 0.5, "tv stand": 0.5}], objects, cuboids, ())[0]
    assert alone["tv stand"] < 0.3


def test_gaps_are_between_the_nearest_sides() -> None:
    assert gap_m(box("a", 0.0), box("b", 2.5)) == pytest.approx(1.5)
    assert gap_m(box("a", 0.0), box("b", 0.5)) == 0.0
