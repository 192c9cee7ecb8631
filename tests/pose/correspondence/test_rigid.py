from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.pose.correspondence.rigid import ransac_umeyama, umeyama
from diorama_core.scene.types import yaw_rotation


def cloud(seed: int, count: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(count, 3))


@given(st.integers(0, 99), st.floats(-3, 3), st.floats(0.3, 3.0), st.floats(-4, 4))
def test_exact_pairs_give_the_transform_back(seed: int, yaw: float, scale: float, shift: float) -> None:
    source, R = cloud(seed, 7), yaw_rotation(yaw)
    target = scale * source @ R.T + [shift, 1.0, -shift]
    found_scale, found_R, t = umeyama(source[None], target[None])
    assert found_scale[0] == pytest.approx(scale)
    assert np.allclose(found_R[0], R)
    assert np.allclose(t[0], [shift, 1.0, -shift])


def test_mirrored_points_still_give_a_rotation() -> None:
    source = cloud(1, 6)
    _, R, _ = umeyama(source[None], (source * [1, 1, -1])[None])
    assert np.linalg.det(R[0]) == pytest.approx(1.0)


def test_wrong_pairs_are_outvoted() -> None:
    source, R = cloud(2, 40), yaw_rotation(0.7)
    target = 1.3 * source @ R.T + [1, 2, 3]
    target[:16] = cloud(3, 16) * 4
    found = ransac_umeyama(source, target, 0.05)
    assert found is not None
    assert found.scale == pytest.approx(1.3)
    assert np.allclose(found.R, R)
    assert not found.inliers[:16].any()
    assert found.inliers[16:].all()


@pytest.mark.parametrize("count", [0, 3])
def test_too_few_pairs_give_nothing(count: int) -> None:
    assert ransac_umeyama(cloud(0, count), cloud(1, count), 0.1) is None


def test_points_in_one_place_give_nothing_odd() -> None:
    found = ransac_umeyama(np.zeros((8, 3)), np.ones((8, 3)), 0.1)
    assert found is None or np.isfinite([found.scale, *found.t]).all()
