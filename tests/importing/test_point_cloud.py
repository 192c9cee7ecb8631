"""Clouds that do not say their unit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.importing.point_cloud import UNITS, Unit, likely_unit
from tests.importing.scans import room_points

UP = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.name)
@pytest.mark.parametrize("up", [UP, None], ids=["up known", "up unknown"])
def test_a_room_is_recognised_in_every_unit(unit: Unit, up: np.ndarray | None) -> None:
    assert likely_unit(room_points() / unit.metres, up) is unit


@given(width=st.floats(1.5, 15.0), depth=st.floats(1.5, 15.0), height=st.floats(2.1, 4.5))
def test_what_may_be_a_room_in_metres_is_in_metres(width: float, depth: float, height: float) -> None:
    corners = np.array([[x, y, z] for x in (0, width) for y in (0, depth) for z in (0, height)])
    assert likely_unit(np.tile(corners, (50, 1)), UP).metres == 1.0


def test_no_extent_is_no_error() -> None:
    assert likely_unit(np.zeros((100, 3)), None) in UNITS
