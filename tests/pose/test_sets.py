"""Things of one set share their scale."""

from __future__ import annotations

import numpy as np

from diorama_core.pose.sets import shared_scales


def test_the_well_seen_ones_tell_the_size() -> None:
    scales = np.array([[1.0, 1.0, 1.0], [1.02, 1.0, 1.0], [0.85, 0.9, 1.1]])
    shared = shared_scales(["chair"] * 3, ["a"] * 3, scales, [0.9, 0.8, 0.1])
    assert np.allclose(shared, shared[0])
    assert np.allclose(shared[0], [1.0, 1.0, 1.0])


def test_other_shapes_other_kinds_and_other_sizes_keep_their_own() -> None:
    scales = np.array([[1.0, 1.0, 1.0], [1.2, 1.2, 1.2]])
    assert np.array_equal(shared_scales(["chair"] * 2, ["a", "b"], scales, [1.0, 1.0]), scales)
    assert np.array_equal(shared_scales(["books"] * 2, ["a", "a"], scales, [1.0, 1.0]), scales)
    far = np.array([[1.0, 1.0, 1.0], [1.0, 1.0, 1.9]])
    assert np.array_equal(shared_scales(["chair"] * 2, ["a", "a"], far, [1.0, 0.5]), far)
