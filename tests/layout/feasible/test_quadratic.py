from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.layout.feasible.quadratic import HARD, SOFT, least_distance


def test_nearest_point_of_a_corner() -> None:
    y = least_distance(np.eye(2), np.array([1.0, 2.0]), np.full(2, HARD))
    assert y == pytest.approx([1.0, 2.0], abs=1e-6)


def test_nothing_violated_is_exactly_zero() -> None:
    assert (least_distance(np.eye(3), -np.ones(3), np.full(3, HARD)) == 0).all()


def test_conflict_yields_softly_and_hard_rows_hold() -> None:
    rows, need = np.array([[1.0], [-1.0]]), np.array([1.0, 0.0])
    y = least_distance(rows, need, np.array([SOFT, HARD]))
    assert y[0] == pytest.approx(0.0, abs=1e-3)


@given(st.integers(0, 10_000))
def test_optimality_conditions(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m, v = int(rng.integers(1, 25)), int(rng.integers(1, 8))
    G = rng.normal(size=(m, v))
    h = G @ rng.normal(size=v) - rng.uniform(0, 0.5, m)
    y = least_distance(G, h, np.full(m, HARD))
    assert (G @ y >= h - 1e-5).all()
    tight = G @ y <= h + 1e-5
    if tight.any():
        from scipy.optimize import nnls

        assert nnls(G[tight].T, y)[1] < 1e-4 * max(1.0, float(np.linalg.norm(y)))
    else:
        assert np.allclose(y, 0)
