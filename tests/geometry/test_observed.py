"""What a mask says of a shape's outline."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.observed import observe, open_below
from tests.synthetic_rooms import look

CELLS, BOX = 24, (40.0, 30.0, 100.0, 110.0)


def table(cells: int = CELLS) -> np.ndarray:
    """A top on two legs, seen from the front, in the cells of a window."""
    grid = np.zeros((cells, cells), dtype=bool)
    grid[4:7, 4:20] = True
    grid[7:20, [5, 18]] = True
    return grid


def test_open_is_what_is_below_something_and_above_the_foot():
    found = open_below(table().reshape(1, -1), CELLS).reshape(CELLS, CELLS)
    assert found[7:20, 6:18].all()
    assert not found[:7].any()
    assert not found[20:].any()


def seen(confidence: float):
    mask = np.zeros((150, 160), dtype=bool)
    mask[30:110, 40:100] = True  # the space between the legs is filled
    return observe(look(0, 0), BOX, mask, confidence, (), CELLS)


@pytest.mark.parametrize(("confidence", "told"), [(1.0, True), (0.9, False)])
def test_only_a_drawn_mask_tells_that_there_is_no_space_between_legs(confidence, told):
    of = seen(confidence)
    whole = of.covered > 0.5
    rows = np.arange(CELLS * CELLS) // CELLS
    columns = np.arange(CELLS * CELLS) % CELLS
    inner = whole & (rows > 10) & (columns > 7) & (columns < 16)
    closed, open_ = of.agreement(np.stack([whole, whole & ~inner]))
    assert closed > open_
    assert (closed - open_ > 0.15) == told
