"""Poses from the matrices of files that other programs wrote."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.errors import InputError
from diorama_core.importing.restore import pose_of


@pytest.mark.parametrize("number", [np.nan, np.inf, 1e200])
@pytest.mark.parametrize("place", [(0, 0), (1, 2), (0, 3)])
def test_numbers_that_cannot_be_a_pose_are_refused(number: float, place: tuple[int, int]) -> None:
    matrix = np.eye(4)
    matrix[place] = number
    if number == 1e200 and place[1] == 3:
        assert np.isfinite(pose_of(matrix)[0].position).all()
        return
    with pytest.raises(InputError, match="too large or none"):
        pose_of(matrix)


def test_an_object_without_thickness_is_refused() -> None:
    with pytest.raises(InputError, match="no size along one axis"):
        pose_of(np.diag([1.0, 0.0, 1.0, 1.0]))


def test_turn_and_scale_are_told_apart() -> None:
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn @ np.diag([2.0, 0.5, 1.0]), (1.0, 2.0, 3.0)
    pose, given_up = pose_of(matrix)
    assert not given_up
    np.testing.assert_allclose(pose.R_world_object, turn, atol=1e-12)
    np.testing.assert_allclose(pose.scale, (2.0, 0.5, 1.0))
    np.testing.assert_allclose(pose.position, (1.0, 2.0, 3.0))
