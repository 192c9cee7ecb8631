"""What soft objects lie on: every place below them, not the highest alone."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from diorama_core.export.bodies import hull_volume
from diorama_core.export.overlaps import GAP_M, MIN_PIECE_M, SKIN_M, drape, subtract_convex


def box(lower: tuple[float, float, float], upper: tuple[float, float, float]) -> np.ndarray:
    corners = np.array(np.meshgrid(*zip(lower, upper, strict=True), indexing="ij"), dtype=float)
    return corners.reshape(3, -1).T


def test_a_pillow_across_a_step_lies_on_both_sides_of_it() -> None:
    bed, pillows = box((0, 0, 0), (1, 1, 0.5)), box((0, 0.8, 0.5), (1, 1, 0.52))
    pillow = box((0.3, 0.4, 0.52 + SKIN_M), (0.7, 0.9, 0.7))
    pieces, held = drape(pillow, 0.49, [bed, pillows])
    assert min(p[:, 2].min() for p in pieces) == np.float64(0.5 + SKIN_M)
    assert all(p[:, 1].max() < 0.8 for p in pieces)
    hull = ConvexHull(np.concatenate(held)[:, :2])
    middle = pillow[:, :2].mean(axis=0)
    assert (hull.equations[:, :2] @ middle + hull.equations[:, 2] < 0).all()


def test_it_does_not_reach_what_is_lower_than_it_lay() -> None:
    pieces, held = drape(box((0, 0, 0.6), (1, 1, 0.8)), 0.55, [box((0, 0, 0), (1, 1, 0.5))])
    assert not pieces
    assert not held


def test_a_hole_takes_from_a_part_what_both_fill_and_nothing_else() -> None:
    part, hole = box((0, 0, 0), (1, 1, 1)), box((0.7, 0.6, -1), (2, 2, 2))
    pieces = subtract_convex(part, hole)
    assert np.isclose(sum(map(hull_volume, pieces)), 1 - (0.3 + GAP_M) * (0.4 + GAP_M), atol=0.01)
    for piece in pieces:
        assert piece[:, 0].max() <= 0.7 - GAP_M + 1e-6 or piece[:, 1].max() <= 0.6 - GAP_M + 1e-6


def test_what_is_inside_a_hole_or_thinner_than_a_piece_is_gone() -> None:
    hole = box((0, 0, 0), (1, 1, 1))
    assert subtract_convex(box((0.2, 0.2, 0.2), (0.4, 0.4, 0.4)), hole) == []
    assert subtract_convex(box((0.2, 0.2, 0.2), (1 + GAP_M + MIN_PIECE_M / 2, 0.4, 0.4)), hole) == []
