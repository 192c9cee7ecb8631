"""Maps that lie mirrored or upside down over their photo."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.perception.inputs.depth.flips import turned, turned_over
from tests.perception.inputs.depth.rooms import room

DEPTH, _ = room()
DEPTH = DEPTH[:, :140]  # not alike left and right
NOISE = np.random.default_rng(0).normal(0, 3, (*DEPTH.shape, 1))
PHOTO = np.clip(60 + 30 * DEPTH[..., None] + NOISE, 0, 255).repeat(3, axis=2).astype(np.uint8)


@pytest.mark.parametrize("how", ["mirrored", "upside down", "upside down and mirrored"])
@pytest.mark.parametrize("inverse", [True, False])
def test_turned_maps_are_told_and_turned(how: str, inverse: bool) -> None:
    values = 1 / DEPTH if inverse else DEPTH
    over = turned(values, how)
    assert turned_over(over, over > 0, PHOTO) == how
    np.testing.assert_array_equal(turned(over, how), values)


def test_right_maps_and_plain_photos_say_nothing() -> None:
    assert turned_over(DEPTH, DEPTH > 0, PHOTO) is None
    assert turned_over(DEPTH, DEPTH > 0, np.full_like(PHOTO, 90)) is None
    holes = DEPTH * (np.random.default_rng(1).random(DEPTH.shape) > 0.9)
    assert turned_over(holes, holes > 0, PHOTO) is None
