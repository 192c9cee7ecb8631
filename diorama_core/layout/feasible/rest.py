"""How an object rests on what holds it up: its contact face on the support, its front as it was seen, and how much of
its footprint has room there.
"""

from __future__ import annotations

from itertools import combinations
from math import hypot, sqrt

import numpy as np
from jaxtyping import Float
from scipy.optimize import linprog

from diorama_core.arrangement.surfaces import RestingSurface, is_wall_like
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.vectors import cross

UPRIGHT_WITHIN = float(np.cos(np.deg2rad(35.0)))
"""Objects hung within this angle of upright hang upright; others keep their roll."""
_IDENTITY = np.eye(3)
_FRONT_FIRST = np.array([2.25, 1.0, 1.0])


def align(
    R: np.ndarray, contact: np.ndarray, surface: RestingSurface, against: list[tuple[np.ndarray, np.ndarray]]
) -> np.ndarray:
    """Swing the contact face onto the support, then twist about the normal to the observed front, or to a wall.

    Args:
        R: observed rotation.
        contact: outward normal of the touching face, object frame.
        surface: where it rests, world.
        against: normals of walls (world) with the object's faces there (object frame).
    """
    n = surface.normal
    swung = swing(R @ contact, -n) @ R
    if against:
        wall, face = against[0]
        return _twist(swung, n, face, -wall)
    if is_wall_like(surface):
        up = np.array([0.0, 0.0, 1.0])
        flat_up = up - (up @ n) * n
        horizontal = swung[:, 2] - (swung[:, 2] @ n) * n
        if float(horizontal @ flat_up) > UPRIGHT_WITHIN * float(np.linalg.norm(horizontal) * np.linalg.norm(flat_up)):
            return _twist(swung, n, np.array([0.0, 0.0, 1.0]), up)
        return swung
    # The front, unless another axis lies much flatter on the support.
    axis = int(((1.0 - (n @ swung) ** 2) * _FRONT_FIRST).argmax())
    return _twist(swung, n, _IDENTITY[axis], R[:, axis])


def swing(a: Float[np.ndarray, "3"], b: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """The smallest rotation that takes unit vector a to unit vector b."""
    c = float(a @ b)
    if c < -1.0 + 1e-9:
        perpendicular = cross(a, np.eye(3)[int(np.abs(a).argmin())])
        perpendicular /= np.linalg.norm(perpendicular)
        return 2.0 * np.outer(perpendicular, perpendicular) - np.eye(3)
    x, y, z = cross(a, b)
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return _IDENTITY + K + K @ K / (1.0 + c)


def _twist(R: np.ndarray, n: np.ndarray, axis_object: np.ndarray, toward: np.ndarray) -> np.ndarray:
    """Turn about n until an object axis points toward a world direction, both seen along n."""
    have, want = R @ axis_object, np.asarray(toward)
    have, want = have - (have @ n) * n, want - (want @ n) * n
    length = sqrt(float(have @ have) * float(want @ want))
    if length < 1e-9:
        return R
    sine, cosine = float(n @ cross(have, want)) / length, float(have @ want) / length
    if abs(sine) < 1e-12 and cosine > 0:
        return R
    norm = hypot(sine, cosine)
    sine, cosine = sine / norm, cosine / norm
    x, y, z = n.tolist()
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return (_IDENTITY + sine * K + (1.0 - cosine) * (K @ K)) @ R


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
