"""Convex bodies of planes: the floor reaches beyond the room, walls around a hole leave it open."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.export.bodies import hull_volume
from diorama_core.export.slabs import GROUND_BEYOND_M, MIN_SLAB_M, ground_piece, slab_pieces
from diorama_core.scene.types import Plane
from tests.primitives import box_room


def test_a_wall_is_one_prism_and_one_around_a_hole_leaves_it_open() -> None:
    wall = next(p for p in box_room().planes if p.role == "wall")
    (piece,) = slab_pieces(wall)
    size = np.ptp(wall.polygon, axis=0)
    area = float(np.linalg.norm(size[:2]) * size[2])
    assert hull_volume(piece) == pytest.approx(area * max(wall.thickness, MIN_SLAB_M), rel=1e-6)
    door = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 2], [2, 0, 2], [2, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]], float)
    pieces = slab_pieces(Plane("w", "wall", door))
    assert sum(map(hull_volume, pieces)) == pytest.approx((12 - 2) * MIN_SLAB_M, rel=1e-6)


def test_the_floor_reaches_beyond_the_room() -> None:
    floor = next(p for p in box_room().planes if p.role == "floor")
    (ground,) = ground_piece(floor)
    assert np.ptp(ground[:, 0]) == pytest.approx(np.ptp(floor.polygon[:, 0]) + 2 * GROUND_BEYOND_M)
