from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.sight import MAX_NEARER, nearness

EYE, TOWARD = np.array([0.0, 0.0, 1.5]), np.array([0.0, -1.0, 0.0])


def test_a_load_comes_to_the_plane_of_its_supporter() -> None:
    assert nearness(EYE, TOWARD, np.array([1.0, 4.0, 1.0]), np.array([0.0, 5.0, 1.2])) == pytest.approx(0.8)


def test_seen_edge_on_the_supporters_distance_counts() -> None:
    edge_on = np.array([1.0, 0.0, 0.0])
    assert nearness(EYE, edge_on, np.array([0.0, 4.0, 1.5]), np.array([0.0, 5.0, 1.5])) == pytest.approx(0.8)


def test_no_load_is_brought_far() -> None:
    assert nearness(EYE, TOWARD, np.array([0.0, 9.0, 1.0]), np.array([0.0, 3.0, 1.0])) == MAX_NEARER
    assert nearness(EYE, TOWARD, np.array([0.0, 4.0, 1.0]), np.array([0.0, -4.0, 1.0])) == 1.0
