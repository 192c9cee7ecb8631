"""What is beside an object and on it makes kinds likelier."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from diorama_core.artefacts import Cuboid, DetectedObject
from diorama_core.retrieval.neighbours import gap_m, with_neighbours
from diorama_core.scene.types import Support


def detected(name: str, category: str) -> DetectedObject:
    return DetectedObject(name, category, category, (0.0, 0.0, 9.0, 9.0), np.zeros((1, 1), bool), 1, 1.0)


def box(name: str, x: float, size=(1.0, 1.0, 0.8)) -> Cuboid:
    return Cuboid(name, np.eye(3), np.array([x, 0.0, size[2] / 2]), np.array(size), 1.0)


CHAIR, TABLE = {"chair": 0.8, "office chair": 0.2}, {"table": 0.8, "desk": 0.2}


def ratio(found: Mapping[str, float], one: str, other: str) -> float:
    return found[one] / found[other]


@pytest.mark.parametrize(("x", "factor"), [(1.2, 4.0), (5.0, 1.0)])
def test_a_chair_at_a_desk_is_likelier_an_office_chair(x, factor) -> None:
    objects, cuboids = [detected("a", "chair"), detected("b", "desk")], [box("a", 0.0), box("b", x)]
    found = with_neighbours([CHAIR, {"desk": 1.0}], objects, cuboids, ())
    assert ratio(found[0], "office chair", "chair") == pytest.approx(0.25 * factor)
    assert sum(found[0].values()) == pytest.approx(1.0)


def test_a_table_that_carries_a_monitor_is_likelier_a_desk() -> None:
    objects, cuboids = [detected("a", "table"), detected("b", "monitor")], [box("a", 0.0), box("b", 0.0)]
    on_it = with_neighbours([TABLE, {"monitor": 1.0}], objects, cuboids, (Support("b", "a"),))[0]
    beside = with_neighbours([TABLE, {"monitor": 1.0}], objects, cuboids, ())[0]
    assert ratio(on_it, "desk", "table") > ratio(beside, "desk", "table") == pytest.approx(0.25)


def test_what_a_neighbour_may_be_counts_by_how_likely_it_is() -> None:
    objects, cuboids = [detected("a", "chair"), detected("b", "table")], [box("a", 0.0), box("b", 1.2)]
    shares = [
        with_neighbours([CHAIR, {"table": 1.0 - p, "desk": p}], objects, cuboids, ())[0]["office chair"]
        for p in (0.01, 0.3, 0.99)
    ]
    assert 0.1 < shares[0] < shares[1] < shares[2]


def test_a_monitor_makes_desk_and_chair_likelier_of_each_other() -> None:
    objects = [detected("a", "chair"), detected("b", "table"), detected("c", "monitor")]
    cuboids = [box("a", 0.0), box("b", 1.2), box("c", 3.0)]
    alone = [CHAIR, TABLE, {"monitor": 1.0}]
    with_it = with_neighbours(alone, objects, cuboids, (Support("c", "b"),))
    without = with_neighbours(alone[:2], objects[:2], cuboids[:2], ())
    assert with_it[1]["desk"] > without[1]["desk"]
    assert with_it[0]["office chair"] > without[0]["office chair"]


def test_gaps_are_between_the_nearest_sides() -> None:
    assert gap_m(box("a", 0.0), box("b", 2.5)) == pytest.approx(1.5)
    assert gap_m(box("a", 0.0), box("b", 0.5)) == 0.0
