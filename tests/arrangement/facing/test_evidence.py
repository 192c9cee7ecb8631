"""What the pictures of objects say of their headings."""

from __future__ import annotations

import numpy as np

from diorama_core.arrangement.facing.evidence import HEADINGS, UNSEEN, HeadingCosts, picture_of, unit
from diorama_core.scene.types import yaw_rotation
from tests.arrangement.facing.rooms import room, thing


def rotations(*deg: float) -> np.ndarray:
    return np.array([yaw_rotation(np.deg2rad(d)) for d in deg])


def test_the_best_pose_near_a_heading_counts_and_what_was_not_tried_is_unlikely() -> None:
    found = picture_of(rotations(90)[0], [rotations(90, 94, 180)], [np.array([1.0, 3.0, 2.0])], [1])
    assert found[0] == 0.0
    assert found[6] == -1.0
    assert (np.delete(found, [0, 6]) == UNSEEN).all()


def test_turns_that_look_the_same_are_as_likely() -> None:
    found = picture_of(rotations(0)[0], [rotations(30)], [np.zeros(1)], [4])
    assert np.flatnonzero(found == 0.0).tolist() == [2, 8, 14, 20]


def test_nothing_posed_says_nothing() -> None:
    assert (picture_of(np.eye(3), [], [], []) == 0.0).all()


def test_costs_between_headings_are_in_proportion_all_around() -> None:
    costs = HeadingCosts(0.0, np.arange(HEADINGS, dtype=float))
    np.testing.assert_allclose(costs.cost(rotations(15, 22.5, 352.5)), [1.0, 1.5, 11.5])


def test_gaps_are_between_boxes_as_they_are_turned() -> None:
    long = thing("table", 0.0, 3.0, (0.8, 2.0, 0.7), 0.0)
    assert np.isclose(room(long, thing("chair", 1.0, 3.0)).gap_m(0, 1), 0.35)
    assert np.isclose(room(thing("table", 0.0, 3.0, (0.8, 2.0, 0.7), 90.0), thing("chair", 1.0, 3.0)).gap_m(0, 1), 0.0)


def test_nearest_prefers_the_smaller_gap_within_reach() -> None:
    found = room(thing("chair", 0.0, 3.0), thing("table", 2.0, 3.0), thing("table", 0.9, 3.0), thing("desk", 0.0, 9.0))
    assert found.nearest(0, frozenset({"table"}), 2.0) == 2
    assert found.nearest(0, frozenset({"desk"}), 2.0) is None


def test_a_vector_without_length_points_to_the_camera_s_side() -> None:
    assert unit(np.zeros(2)).tolist() == [0.0, -1.0]
