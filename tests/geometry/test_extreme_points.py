"""Derivatives of bounds against differences of bounds."""

from __future__ import annotations

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from diorama_core.geometry.extreme_points import extreme_points
from diorama_core.geometry.projection import cuboid_corners, frustum_normals, frustum_slack, visible_bounds
from tests.geometry.test_projection import FROM_WORLD, K

STEP = 1e-6
size = st.floats(0.2, 2.5)


def corners_at(x: float, y: float, z: float, yaw: float, sizes: tuple) -> np.ndarray:
    return cuboid_corners(np.array([[x, y, z]]), np.array([yaw]), np.array([sizes])) @ FROM_WORLD.T


@given(
    x=st.floats(-3, 3), y=st.floats(0.8, 5), z=st.floats(-2, 2), yaw=st.floats(-3.2, 3.2),
    sizes=st.tuples(size, size, size),
)  # fmt: skip
@example(x=0.0, y=3.0, z=0.0, yaw=0.3, sizes=(0.5, 0.6, 0.7))  # whole
@example(x=-2.0, y=3.0, z=0.0, yaw=0.3, sizes=(0.5, 0.6, 0.7))  # cut by the left side
@example(x=0.0, y=1.5, z=0.0, yaw=0.3, sizes=(0.9, 2.4, 2.4))  # larger than the picture
@example(x=4.0, y=2.0, z=0.0, yaw=0.3, sizes=(0.5, 0.6, 0.7))  # beside the picture
def test_bounds_move_as_their_points_do(x: float, y: float, z: float, yaw: float, sizes: tuple) -> None:
    corners = corners_at(x, y, z, yaw, sizes)
    bounds, visible = visible_bounds(corners, K)
    at = extreme_points(corners, bounds, visible, K)
    if not at.told[0]:
        assert not visible[0] or corners[0, :, 2].min() < 0.05
        return
    pixels = np.stack([K.fx * at.camera[0] / at.camera[2] + K.cx, K.fy * at.camera[1] / at.camera[2] + K.cy])
    seen = np.array([pixels[0, 0, 0], pixels[1, 1, 0], pixels[0, 2, 0], pixels[1, 3, 0]])
    np.testing.assert_allclose(seen[~at.fixed[:, 0]], bounds[0][~at.fixed[:, 0]], atol=1e-6)
    ways = np.eye(3)
    slopes = at.slopes(np.broadcast_to(ways[:, :, None, None], (3, 3, 4, 1)), K)[..., 0]
    for way, slope in zip(ways, slopes, strict=True):
        sides = [(visible_bounds(corners + s * STEP * way, K)[0][0] - bounds[0]) / (s * STEP) for s in (1.0, -1.0)]
        slack = 0.02 * (1.0 + np.abs(sides).max(axis=0))
        assert (slope >= np.min(sides, axis=0) - slack).all(), "between both sides, which differ where two points tie"
        assert (slope <= np.max(sides, axis=0) + slack).all()


def test_what_the_near_plane_cuts_is_not_told() -> None:
    corners = corners_at(0.0, 0.3, 0.0, 0.2, (1.0, 1.0, 1.0))
    bounds, visible = visible_bounds(corners, K)
    assert visible[0]
    assert not extreme_points(corners, bounds, visible, K).told[0]


def test_normals_are_the_slopes_of_slack() -> None:
    point = np.array([[0.3], [-0.2], [2.0]])
    differences = [(frustum_slack(point + STEP * way[:, None], K) - frustum_slack(point, K))[:, 0] for way in np.eye(3)]
    np.testing.assert_allclose(np.transpose(differences) / STEP, frustum_normals(K), rtol=1e-5, atol=1e-4)
