"""A shape whose surfaces are where things lie costs nothing; others cost more, up to a limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.artefacts import Cuboid
from diorama_core.pose.levels import level_cost
from diorama_core.scene.types import Pose
from tests.primitives import PrimitiveLibrary

TABLE = PrimitiveLibrary().shape("table")
TOP_M = TABLE.surfaces[0].height_m


def lying_at(base_m: float) -> Cuboid:
    size = np.array([0.2, 0.2, 0.1])
    return Cuboid("cup", np.eye(3), np.array([0.0, 0.0, base_m + 0.05]), size, 0.9)


def pose(scale: float = 1.0) -> Pose:
    return Pose(np.eye(3), np.array([0.0, 0.0, 0.5]), np.array([1.0, 1.0, scale]))


def test_a_thing_on_a_surface_costs_nothing() -> None:
    assert level_cost(TABLE, pose(), [lying_at(0.5 + TOP_M)]) == pytest.approx(0.0)
    assert level_cost(TABLE, pose(1.5), [lying_at(0.5 + 1.5 * TOP_M)]) == pytest.approx(0.0)


@given(off=st.floats(0.0, 5.0), farther=st.floats(0.0, 5.0))
def test_the_farther_off_the_dearer_up_to_a_limit(off: float, farther: float) -> None:
    near, far = (level_cost(TABLE, pose(), [lying_at(0.5 + TOP_M + d)]) for d in (off, off + farther))
    assert 0.0 <= near <= far <= 4.0


def test_many_things_say_as_much_as_one() -> None:
    one = level_cost(TABLE, pose(), [lying_at(0.6 + TOP_M)])
    assert level_cost(TABLE, pose(), [lying_at(0.6 + TOP_M)] * 6) == pytest.approx(one)


def test_nothing_known_of_surfaces_or_nothing_carried_costs_nothing() -> None:
    assert level_cost(replace(TABLE, surfaces=()), pose(), [lying_at(3.0)]) == 0.0
    assert level_cost(TABLE, pose(), []) == 0.0
