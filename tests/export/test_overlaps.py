"""What soft objects lie on: every place below them, not the highest alone."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from diorama_core.export.overlaps import SKIN_M, seated


def box(lower: tuple[float, float, float], upper: tuple[float, float, float]) -> np.ndarray:
    corners = np.array(np.meshgrid(*zip(lower, upper, strict=True), indexing="ij"))
    return corners.reshape(3, -1).T


def test_a_pillow_across_a_step_lies_on_both_sides_of_it() -> None:
    bed, pillows = box((0, 0, 0), (1, 1, 0.5)), box((0, 0.8, 0.5), (1, 1, 0.52))
    pillow = box((0.3, 0.4, 0.52 + SKIN_M), (0.7, 0.9, 0.7))
    pieces, held = seated(pillow, 0.49, [bed, pillows])
    assert min(p[:, 2].min() for p in pieces) == np.float64(0.5 + SKIN_M)
    assert all(p[:, 1].max() < 0.8 for p in pieces)
    hull = ConvexHull(np.concatenate(held)[:, :2])
    middle = pillow[:, :2].mean(axis=0)
    assert (hull.equations[:, :2] @ middle + hull.equations[:, 2] < 0).all()


def test_it_does_not_reach_what_is_lower_than_it_lay() -> None:
    pieces, held = seated(box((0, 0, 0.6), (1, 1, 0.8)), 0.55, [box((0, 0, 0), (1, 1, 0.5))])
    assert not pieces
    assert not held
