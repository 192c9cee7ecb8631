"""Numbers that mean that nothing was measured."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.perception.inputs.depth.voids import find_measured_pixels
from tests.perception.inputs.depth.rooms import room

DEPTH, _ = room()
HOLE = np.zeros(DEPTH.shape, bool)
HOLE[20:60, 30:90] = True


@pytest.mark.parametrize("void", [0, 65535, 65534, 32767, 9999, 10000, 1, 60000])
def test_voids_of_whole_numbers(void: int) -> None:
    seen, notes = find_measured_pixels(np.where(HOLE, void, DEPTH * 1000).astype(np.uint16))
    np.testing.assert_array_equal(seen, ~HOLE)
    assert (notes == ()) == (void == 0)
    assert all(f"the number {void}" in note for note in notes)


@pytest.mark.parametrize("void", [np.nan, np.inf, -1.0, 0.0, 1e10, 9999.0, 100.0, 65.535, 1e-6])
def test_voids_of_floats(void: float) -> None:
    seen, _ = find_measured_pixels(np.where(HOLE, np.float32(void), DEPTH))
    np.testing.assert_array_equal(seen, ~HOLE)


def test_a_far_wall_is_a_measurement() -> None:
    for values in (DEPTH, (DEPTH * 1000).astype(np.uint16)):
        seen, notes = find_measured_pixels(values)
        assert seen.all()
        assert notes == ()
    steps = np.where(HOLE, np.float32(2.0), np.float32(3.0))
    assert find_measured_pixels(steps)[0].all()
