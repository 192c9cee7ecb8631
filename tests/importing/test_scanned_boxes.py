"""Boxes around what stands in a scanned room."""

from __future__ import annotations

import numpy as np
import pytest
from shapely.geometry import box

from diorama_core.importing.scanned_boxes import ScannedRoom, boxes_in, rugs_in

ROOM = ScannedRoom(box(-2.0, -2.0, 2.0, 2.0), 2.5)


def block(low: tuple[float, float, float], high: tuple[float, float, float]) -> np.ndarray:
    """Points on the faces of a block."""
    rng = np.random.default_rng(3)
    points = rng.uniform(low, high, (4000, 3))
    face = rng.integers(0, 3, 4000)
    points[np.arange(4000), face] = np.where(rng.random(4000) < 0.5, np.array(low)[face], np.array(high)[face])
    return points


def test_a_block_at_a_wall_has_its_back_there() -> None:
    boxes, left_out = boxes_in(block((-1.98, -0.6, 0.0), (-1.5, 0.6, 1.8)), ROOM)
    assert left_out == 0
    (found,) = boxes
    assert np.allclose(found.centre, [-1.72, 0.0, 0.9], atol=0.06)
    assert found.size_m == pytest.approx([0.45, 1.2, 1.8], abs=0.08)
    assert found.R_world_box[:, 0] == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)


def test_what_is_small_or_a_wall_is_none() -> None:
    assert boxes_in(block((0.0, 0.0, 0.5), (0.08, 0.08, 0.6)), ROOM) == ((), 0)
    assert boxes_in(block((0.0, -1.0, 0.0), (0.03, 1.0, 2.45)), ROOM) == ((), 0)
    assert rugs_in(block((0.0, 0.0, 0.0), (0.5, 0.5, 0.5)), ROOM) == ()


def test_what_stands_on_nothing_is_of_no_kind() -> None:
    (floating,), _ = boxes_in(block((0.0, 0.0, 1.1), (0.3, 0.3, 1.6)), ROOM)
    assert dict(floating.kinds) == {"object": 1.0}
    (hung,), _ = boxes_in(block((-1.95, 0.0, 1.3), (-1.7, 0.3, 1.75)), ROOM)
    assert len(hung.kinds) > 1
    (lamp,), _ = boxes_in(block((0.0, 0.0, 1.5), (0.3, 0.3, 1.75)), ROOM)
    assert "ceiling lamp" in lamp.kinds
