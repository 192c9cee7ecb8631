"""What is seen where a table's top is does not stand on the floor behind it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.projection import visible_bounds
from diorama_core.perception.metrology import mutual_costs, placement
from diorama_core.perception.metrology.box_observations import BoxObservations, gather
from diorama_core.perception.metrology.mutual_costs import CarriedCosts, share_seen_through_top
from diorama_core.perception.metrology.problem import Cuboids, View, corners_camera
from diorama_core.perception.metrology.settings import SETTINGS
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
    costs = CarriedCosts(observed(TABLE, KEYBOARD), VIEW, HEIGHT_M).costs({0: readings(TABLE, 0.5, 1.0, 2.2)})[0]
    assert costs[1] < costs[0] - 1.0
    assert costs[1] < costs[2] - 1.0


def test_one_reading_and_what_carries_nothing_cost_nothing() -> None:
    found = CarriedCosts(observed(TABLE, KEYBOARD, SOFA), VIEW, HEIGHT_M).costs(
        {0: readings(TABLE, 1.0), 2: readings(SOFA, 0.9, 1.1)}
    )
    assert found[0].tolist() == [0.0]
    assert found[2].tolist() == [0.0, 0.0]


def test_only_new_readings_are_solved_and_alike_with_others_and_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    observations = observed(TABLE, KEYBOARD)
    whole = CarriedCosts(observations, VIEW, HEIGHT_M).costs({0: readings(TABLE, 0.8, 1.0, 1.3)})[0]
    solved: list[int] = []

    def counted(rows, view, settings):
        solved.append(len(rows))
        return original(rows, view, settings)

    original = mutual_costs.solve_all
    monkeypatch.setattr(mutual_costs, "solve_all", counted)
    costs = CarriedCosts(observations, VIEW, HEIGHT_M)
    first = costs.costs({0: readings(TABLE, 0.8, 1.0)})[0]
    again = costs.costs({0: readings(TABLE, 1.0, 1.3, 0.8)})[0]
    assert costs.costs({0: readings(TABLE, 0.8, 1.0)})[0].tolist() == first.tolist()
    assert len(solved) == 2
    assert solved[1] * 2 == solved[0]
    np.testing.assert_allclose(first, whole[:2], atol=1e-6)
    np.testing.assert_allclose(again, whole[[1, 2, 0]], atol=1e-6)


LOW_VIEW, LOW_M = View(K, rotation(18.0)), 1.4
TOP = Cuboids(np.array([[0.0, 2.0, 0.37]]), np.array([0.3]), np.array([[0.8, 1.5, 0.74]]))


def one(centre: tuple[float, float, float], size: tuple[float, float, float]) -> Cuboids:
    return Cuboids(np.array([centre]), np.zeros(1), np.array([size]))


def box_of(cuboid: Cuboids) -> np.ndarray:
    corners = corners_camera(cuboid, np.array([LOW_M]), LOW_VIEW)
    return visible_bounds(corners, K)[0][0]


def larger(cuboid: Cuboids) -> Cuboids:
    """What looks the same from the camera and stands on the floor."""
    factor = LOW_M / (LOW_M - float(cuboid.base_m[0]))
    eye = np.array([0.0, 0.0, LOW_M])
    return Cuboids(eye + factor * (cuboid.centre - eye), cuboid.yaw_rad, factor * cuboid.size_m)


def test_a_thing_on_a_table_would_be_seen_through_its_top_from_the_floor() -> None:
    on_it = one((0.2, 2.1, 0.86), (0.2, 0.3, 0.24))
    far = larger(on_it)
    assert far.base_m[0] == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(box_of(far), box_of(on_it), atol=1e-6)
    assert share_seen_through_top(box_of(on_it), far, TOP, LOW_M, LOW_VIEW) == 1.0


@pytest.mark.parametrize(
    ("centre", "height_m"),
    [((0.2, 1.0, 0.12), LOW_M), ((2.2, 2.4, 0.12), LOW_M), ((0.2, 6.5, 0.12), LOW_M), ((0.2, 2.1, 0.1), 0.6)],
)
def test_before_beside_over_and_below_the_top_nothing_is_hidden(centre, height_m) -> None:
    standing = one(centre, (0.3, 0.3, 0.24))
    box = visible_bounds(corners_camera(standing, np.array([height_m]), LOW_VIEW), K)[0][0]
    assert share_seen_through_top(box, standing, TOP, height_m, LOW_VIEW) == 0.0


@pytest.mark.parametrize(("name", "size_m"), [("box", (0.1, 0.14, 0.1)), ("basket", (0.15, 0.15, 0.2))])
def test_what_seems_to_stand_behind_a_table_as_well_is_on_it(name, size_m) -> None:
    table = RequestedObject("table", (0.0, 2.0, 0.37), (0.8, 1.5, 0.74))
    items = (table, RequestedObject(name, (0.3, 2.05, 0.74 + size_m[2] / 2), size_m))
    objects = seen(items, LOW_VIEW.R_world_camera, LOW_M)
    room = gather(objects, K.width, K.height)
    assert placement.place_all(room, LOW_VIEW, LOW_M)[1].supporter == 0
    free = replace(SETTINGS, placement=replace(SETTINGS.placement, through_top_cost=0.0))
    seen_through = gather(objects, K.width, K.height, free)
    assert placement.place_all(seen_through, LOW_VIEW, LOW_M)[1].supporter == placement.FLOOR
