"""Which readings have their backs at a wall."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.perception.metrology.backs import back_costs
from diorama_core.perception.metrology.problem import Cuboids
from tests.synthetic_rooms import box_room

WALLS = tuple(p for p in box_room(-2.0, 2.0, 6.0, 2.6) if p.role == "wall")
FOOT = np.zeros(3)


def costs(*rows: tuple[tuple[float, float], float]) -> np.ndarray:
    """Of cases 0.4 deep and 1.6 wide, by centre and heading in degrees."""
    centres = np.array([[*centre, 0.4] for centre, _ in rows])
    return back_costs(
        Cuboids(centres, np.deg2rad([yaw for _, yaw in rows]), np.tile([0.4, 1.6, 0.8], (len(rows), 1))), WALLS, FOOT
    )


@pytest.mark.parametrize(
    ("centre", "yaw"), [((-1.8, 3.0), 0.0), ((-1.8, 3.0), 180.0), ((1.8, 3.0), 0.0), ((0.0, 5.8), 90.0)]
)
def test_a_back_at_a_wall_costs_nothing(centre: tuple[float, float], yaw: float) -> None:
    assert costs((centre, yaw))[0] == pytest.approx(0.0, abs=1e-6)


def test_a_narrow_side_at_the_wall_is_no_back() -> None:
    back, side = costs(((-1.8, 3.0), 0.0), ((-1.2, 3.0), 90.0))
    assert side > back + 3.0


def test_the_farther_from_the_wall_the_dearer_but_never_beyond_a_bound() -> None:
    near, off, middle = costs(((-1.8, 3.0), 0.0), ((-1.4, 3.0), 0.0), ((0.0, 3.0), 0.0))
    assert near < off < middle < 8.0


def test_without_walls_nothing_is_told() -> None:
    boxes = Cuboids(np.array([[0.0, 3.0, 0.4], [1.0, 3.0, 0.4]]), np.zeros(2), np.ones((2, 3)))
    found = back_costs(boxes, (), FOOT)
    assert found[0] == pytest.approx(found[1], abs=0.6)


def test_the_camera_may_stand_anywhere_in_the_room() -> None:
    foot = np.array([0.5, 1.0, 0.0])
    boxes = Cuboids(np.array([[-2.3, 2.0, 0.4]]), np.zeros(1), np.array([[0.4, 1.6, 0.8]]))
    assert back_costs(boxes, WALLS, foot)[0] == pytest.approx(0.0, abs=1e-6)
