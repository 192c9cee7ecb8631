"""How much of a footprint has room on a support surface."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from scipy.optimize import linprog

from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.vectors import cross

INSET_M = 2e-4
"""Kept between a contact face and the edge of its support, and under a shelf's ceiling."""


def largest_share(m: np.ndarray, h: np.ndarray, reach: np.ndarray) -> float:
    """The largest share t of a footprint that fits somewhere on a surface: m x <= h - t reach; at most 1."""
    h = h - INSET_M
    if (h - reach >= 0).all():
        return 1.0
    u, v = plane_axes(cross(m[0], m[1]) / max(float(np.linalg.norm(cross(m[0], m[1]))), 1e-9))
    A = np.column_stack([m @ u, m @ v, reach])
    share = _highest_vertex(A, h) if len(A) <= 10 else _highest(A, h)
    return share if share < 1.0 - 1e-9 else 1.0


def _highest(A: np.ndarray, h: np.ndarray) -> float:
    solution = linprog([0.0, 0.0, -1.0], A_ub=A, b_ub=h, bounds=[(None, None), (None, None), (0.0, 1.0)])
    return float(np.asarray(solution.x)[2]) if solution.status == 0 else 0.0


def _highest_vertex(A: np.ndarray, h: np.ndarray) -> float:
    """The largest share through all corners of A x <= h at once: a tenth of the time for the few sides of most tops."""
    triples = np.array(list(combinations(range(len(A)), 3)))
    corners, bounds = A[triples], h[triples]
    firm = np.abs(np.linalg.det(corners)) > 1e-9
    x = np.linalg.solve(corners[firm], bounds[firm][..., None])[..., 0]
    inside = (x @ A.T <= h + 1e-9).all(axis=1)
    return float(np.clip(x[inside, 2].max(initial=0.0), 0.0, 1.0))
