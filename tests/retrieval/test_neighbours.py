"""What is beside an object and on it makes kinds likelier."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import Cuboid, DetectedObject
from diorama_core.retrieval.neighbours import gap_m, neighbour_factors
from diorama_core.scene.types import Support


def detected(name: str, category: str) -> DetectedObject:
    return DetectedObject(name, category, category, (0.0, 0.0, 9.0, 9.0), np.zeros((1, 1), bool), 1, 1.0)


def box(name: str, x: float, size=(1.0, 1.0, 0.8)) -> Cuboid:
    return Cuboid(name, np.eye(3), np.array([x, 0.0, size[2] / 2]), np.array(size), 1.0)


@pytest.mark.parametrize(("x", "factor"), [(1.2, 4.0), (5.0, 1.0)])
def test_a_chair_at_a_desk_is_likelier_an_office_chair(x, factor) -> None:
    objects, cuboids = [detected("a", "chair"), detected("b", "desk")], [box("a", 0.0), box("b", x)]
    found = neighbour_factors(0, ("chair", "office chair"), objects, cuboids, ())
    assert found == {"chair": 1.0, "office chair": factor}


def test_a_table_that_carries_a_monitor_is_likelier_a_desk() -> None:
    objects, cuboids = [detected("a", "table"), detected("b", "monitor")], [box("a", 0.0), box("b", 0.0)]
    assert neighbour_factors(0, ("desk",), objects, cuboids, (Support("b", "a"),))["desk"] > 1.0
    assert neighbour_factors(0, ("desk",), objects, cuboids, ())["desk"] == 1.0


def test_gaps_are_between_the_nearest_sides() -> None:
    assert gap_m(box("a", 0.0), box("b", 2.5)) == pytest.approx(1.5)
    assert gap_m(box("a", 0.0), box("b", 0.5)) == 0.0
