from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

from diorama_core.geometry.convex import box_part, hull_part
from diorama_core.geometry.sat import pack_parts, pair_axes, place_bodies


def rotation(rng: np.random.Generator) -> np.ndarray:
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q if np.linalg.det(q) > 0 else -q


def touch(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether two hulls share a point, by a linear program."""
    n, m = len(a), len(b)
    equal = np.vstack(
        [np.hstack([a.T, -b.T]), np.hstack([np.ones(n), np.zeros(m)]), np.hstack([np.zeros(n), np.ones(m)])]
    )
    return linprog(np.zeros(n + m), A_eq=equal, b_eq=[0, 0, 0, 1, 1]).status == 0


def test_depth_of_two_boxes() -> None:
    packed = pack_parts([[box_part([-1, -1, -1], [1, 1, 1])], [box_part([-1, -1, -1], [1, 1, 1])]])
    bodies = place_bodies(
        packed, np.tile(np.eye(3), (2, 1, 1)), np.array([[0.0, 0, 0], [1.7, 0.2, 0]]), np.ones((2, 3))
    )
    (block,) = pair_axes(bodies, np.array([0]), np.array([1]))
    assert block.gaps.max() == pytest.approx(-0.3)
    assert block.separations(np.array([[-0.4, 0, 0]])).max() == pytest.approx(0.1)


@given(st.integers(0, 10_000))
def test_agrees_with_a_linear_program(seed: int) -> None:
    rng = np.random.default_rng(seed)
    parts = [[box_part(-rng.uniform(0.2, 1, 3), rng.uniform(0.2, 1, 3))], [hull_part(rng.normal(size=(9, 3)) * 0.6)]]
    R = np.array([rotation(rng), rotation(rng)])
    bodies = place_bodies(pack_parts(parts), R, rng.normal(size=(2, 3)) * 0.8, rng.uniform(0.5, 1.5, (2, 3)))
    (block,) = pair_axes(bodies, np.array([0]), np.array([1]))
    move = rng.normal(size=3) * 0.5
    gap = float(block.separations(move[None]).max())
    if abs(gap) > 1e-6:
        assert touch(bodies.vertices[0] + move, bodies.vertices[1]) == (gap < 0)
