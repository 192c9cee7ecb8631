from __future__ import annotations

import numpy as np
import pytest

from diorama_core.perception.metrology import carried_costs
from diorama_core.perception.metrology.box_observations import BoxObservations, gather
from diorama_core.perception.metrology.carried_costs import CarriedCosts
from diorama_core.perception.metrology.problem import Cuboids, View
from tests.perception.metrology.test_metrology import K, RequestedObject, rotation, seen

R = rotation(14.0)
VIEW = View(K, R)
HEIGHT_M = 1.5
TABLE = RequestedObject("table", (0.2, 2.8, 0.36), (0.85, 1.4, 0.72))
SOFA = RequestedObject("sofa", (-1.5, 3.6, 0.4), (0.9, 1.6, 0.8))
KEYBOARD = RequestedObject("keyboard", (0.3, 2.65, 0.735), (0.14, 0.44, 0.03))


def observed(*items: RequestedObject) -> BoxObservations:
    return gather(seen(items, R, HEIGHT_M), K.width, K.height)


def readings(of: RequestedObject, *larger: float) -> Cuboids:
    """The object made larger about the camera's foot: it looks the same, but for what stands on it."""
    factors = np.array(larger)[:, None]
    return Cuboids(np.array(of.centre) * factors, np.full(len(larger), -np.pi / 2), np.array(of.size) * factors)


def test_the_reading_costs_least_on_which_the_load_has_its_usual_size() -> None:
    costs = CarriedCosts(observed(TABLE, KEYBOARD), VIEW, HEIGHT_M).of({0: readings(TABLE, 0.5, 1.0, 2.2)})[0]
    assert costs[1] < costs[0] - 1.0
    assert costs[1] < costs[2] - 1.0


def test_one_reading_and_what_carries_nothing_cost_nothing() -> None:
    found = CarriedCosts(observed(TABLE, KEYBOARD, SOFA), VIEW, HEIGHT_M).of(
        {0: readings(TABLE, 1.0), 2: readings(SOFA, 0.9, 1.1)}
    )
    assert found[0].tolist() == [0.0]
    assert found[2].tolist() == [0.0, 0.0]


def test_only_new_readings_are_solved_and_alike_with_others_and_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    observations = observed(TABLE, KEYBOARD)
    whole = CarriedCosts(observations, VIEW, HEIGHT_M).of({0: readings(TABLE, 0.8, 1.0, 1.3)})[0]
    solved: list[int] = []

    def counted(rows, view, settings):
        solved.append(len(rows))
        return original(rows, view, settings)

    original = carried_costs.solve_all
    monkeypatch.setattr(carried_costs, "solve_all", counted)
    costs = CarriedCosts(observations, VIEW, HEIGHT_M)
    first = costs.of({0: readings(TABLE, 0.8, 1.0)})[0]
    again = costs.of({0: readings(TABLE, 1.0, 1.3, 0.8)})[0]
    assert costs.of({0: readings(TABLE, 0.8, 1.0)})[0].tolist() == first.tolist()
    assert len(solved) == 2
    assert solved[1] * 2 == solved[0]
    np.testing.assert_allclose(first, whole[:2], atol=1e-6)
    np.testing.assert_allclose(again, whole[[1, 2, 0]], atol=1e-6)
