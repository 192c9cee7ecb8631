"""What is seen where a table's top is does not stand on the floor behind it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.projection import visible_bounds
from diorama_core.perception.metrology import placement
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.problem import Cuboids, View, corners_camera
from diorama_core.perception.metrology.seen_through_tops import seen_through_top
from diorama_core.perception.metrology.settings import SETTINGS
from tests.perception.metrology.test_metrology import K, RequestedObject, rotation, seen

VIEW, HEIGHT_M = View(K, rotation(18.0)), 1.4
TABLE = Cuboids(np.array([[0.0, 2.0, 0.37]]), np.array([0.3]), np.array([[0.8, 1.5, 0.74]]))


def one(centre: tuple[float, float, float], size: tuple[float, float, float]) -> Cuboids:
    return Cuboids(np.array([centre]), np.zeros(1), np.array([size]))


def box_of(cuboid: Cuboids) -> np.ndarray:
    corners = corners_camera(cuboid, np.array([HEIGHT_M]), VIEW)
    return visible_bounds(corners, K)[0][0]


def larger(cuboid: Cuboids) -> Cuboids:
    """What looks the same from the camera and stands on the floor."""
    factor = HEIGHT_M / (HEIGHT_M - float(cuboid.base_m[0]))
    eye = np.array([0.0, 0.0, HEIGHT_M])
    return Cuboids(eye + factor * (cuboid.centre - eye), cuboid.yaw_rad, factor * cuboid.size_m)


def test_a_thing_on_a_table_would_be_seen_through_its_top_from_the_floor() -> None:
    on_it = one((0.2, 2.1, 0.86), (0.2, 0.3, 0.24))
    far = larger(on_it)
    assert far.base_m[0] == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(box_of(far), box_of(on_it), atol=1e-6)
    assert seen_through_top(box_of(on_it), far, TABLE, HEIGHT_M, VIEW) == 1.0


@pytest.mark.parametrize(
    ("centre", "height_m"),
    [((0.2, 1.0, 0.12), HEIGHT_M), ((2.2, 2.4, 0.12), HEIGHT_M), ((0.2, 6.5, 0.12), HEIGHT_M), ((0.2, 2.1, 0.1), 0.6)],
)
def test_before_beside_over_and_below_the_top_nothing_is_hidden(centre, height_m) -> None:
    standing = one(centre, (0.3, 0.3, 0.24))
    box = visible_bounds(corners_camera(standing, np.array([height_m]), VIEW), K)[0][0]
    assert seen_through_top(box, standing, TABLE, height_m, VIEW) == 0.0


@pytest.mark.parametrize(
    ("name", "size_m"), [("box", (0.1, 0.14, 0.1)), ("basket", (0.15, 0.15, 0.2)), ("object", (0.2, 0.35, 0.2))]
)
def test_what_seems_to_stand_behind_a_table_as_well_is_on_it(name, size_m) -> None:
    table = RequestedObject("table", (0.0, 2.0, 0.37), (0.8, 1.5, 0.74))
    items = (table, RequestedObject(name, (0.3, 2.05, 0.74 + size_m[2] / 2), size_m))
    room = gather(seen(items, VIEW.R_world_camera, HEIGHT_M), K.width, K.height)
    assert placement.place_all(room, VIEW, HEIGHT_M)[1].supporter == 0
    seen_through = replace(SETTINGS, placement=replace(SETTINGS.placement, through_top_cost=0.0))
    assert placement.place_all(room, VIEW, HEIGHT_M, seen_through)[1].supporter == placement.FLOOR
