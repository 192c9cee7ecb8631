from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.placement import place_all
from diorama_core.perception.metrology.priors import size_modes
from diorama_core.perception.metrology.problem import Cuboids, View
from diorama_core.perception.metrology.rows import row
from diorama_core.perception.metrology.seats import at_table, tables_of_seats
from diorama_core.perception.metrology.settings import SETTINGS
from tests.perception.metrology.test_metrology import K, RequestedObject, rotation, seen

R, HEIGHT_M = rotation(14.0), 1.5
TABLE = RequestedObject("table", (0.0, 2.6, 0.375), (0.9, 1.6, 0.75))
CHAIR = RequestedObject("chair", (0.2, 3.3, 0.44), (0.52, 0.48, 0.88))


def box(x: float, y: float, depth: float, width: float, yaw: float = 0.0) -> Cuboids:
    return Cuboids(np.array([[x, y, 0.4]]), np.array([yaw]), np.array([[depth, width, 0.8]]))


def test_a_seat_belongs_to_the_table_whose_edge_is_nearest() -> None:
    observations = gather(seen((TABLE, CHAIR, TABLE, replace(CHAIR, category="sofa")), R, HEIGHT_M), K.width, K.height)
    long, small = box(0.0, 3.0, 3.0, 0.8), box(2.4, 3.0, 0.4, 0.4)
    boxes = {0: long, 1: box(1.6, 3.0, 0.5, 0.5), 2: small, 3: box(-2.0, 3.0, 0.9, 2.0)}
    assert tables_of_seats(boxes, observations) == {1: 0}
    assert tables_of_seats({i: b for i, b in boxes.items() if i not in (0, 2)}, observations) == {}


def test_at_a_table_is_around_it_by_a_seats_depth() -> None:
    observations = gather(seen((CHAIR,), R, HEIGHT_M), K.width, K.height)
    mode = size_modes("chair")[0]
    rows = row(observations, 0, mode, camera_height_m=HEIGHT_M, yaw_rad=0.0)
    placed = at_table(rows, box(0.3, 2.6, 0.9, 1.6, 0.2))
    beside = float(np.exp(mode.log_size[0])) + SETTINGS.placement.stands_off_m
    np.testing.assert_allclose(placed.footprint[0], [0.3, 2.6, 0.2, 0.45 + beside, 0.8 + beside])
    assert placed.footprint_sigma_m[0] == SETTINGS.placement.stands_off_sigma_m


@pytest.mark.parametrize("shown", [0.25, 0.4])
def test_a_chair_of_which_only_the_back_shows_over_a_table_stands_behind_it(shown: float) -> None:
    table, chair = seen((TABLE, CHAIR), R, HEIGHT_M)
    x1, y1, x2, y2 = chair.box
    chair = replace(chair, box=(x1, y1, x2, y1 + shown * (y2 - y1)))
    found = place_all(gather((table, chair), K.width, K.height), View(K, R), HEIGHT_M)
    assert found[1].cuboid.centre[0, 1] == pytest.approx(CHAIR.centre[1], abs=0.45)
