from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.evaluation.metrics.pose import (
    Alignment,
    Placed,
    object_alignment,
    pool,
    rotation_angle,
    scene_alignment,
)
from diorama_core.scene.types import yaw_rotation


def placed(x: float, y: float, yaw_deg: float = 0.0, size=(0.5, 0.6, 0.9), symmetry: int = 1) -> Placed:
    return Placed(yaw_rotation(np.deg2rad(yaw_deg)), np.array([x, y, 0.4]), np.array(size), symmetry)


ROOM = [placed(0, 0), placed(2, 0, 90), placed(0, 3, 180, symmetry=2), placed(2, 3, 45, (0.8, 0.8, 0.7), 36)]


def test_the_truth_is_right_in_every_reading() -> None:
    found = (*scene_alignment(ROOM, ROOM), object_alignment(ROOM, ROOM))
    assert [f.shares for f in found] == [(1.0, 1.0, 1.0, 1.0)] * 3
    assert [f.reading for f in found] == ["mean over pairs", "against every other object", "object-focus"]


def test_one_turned_object_spoils_its_pairs() -> None:
    wrong = [replace(ROOM[0], R=yaw_rotation(np.deg2rad(30))), *ROOM[1:]]
    pairs, strict = scene_alignment(ROOM, wrong)
    # Three of six pairs hold it, but nothing tells how a round table is turned against it; every object but that table
    # has a wrong pair.
    assert pairs.r_acc == pytest.approx(4 / 6)
    assert strict.r_acc == pytest.approx(1 / 4)
    assert pairs.t_acc == strict.t_acc == 1.0
    assert object_alignment(ROOM, wrong).r_acc == pytest.approx(3 / 4)


def test_a_moved_object_is_wrong_by_direction_not_distance() -> None:
    farther = [placed(0, 0), placed(4, 0)]
    aside = [placed(0, 0), placed(2, 1.0)]
    truth = [placed(0, 0), placed(2, 0)]
    assert scene_alignment(truth, farther)[0].t_acc == 1.0
    assert scene_alignment(truth, aside)[0].t_acc == 0.0
    assert object_alignment(truth, farther).t_acc == 0.5


def test_scale_is_relative_between_objects() -> None:
    larger = [replace(p, size_m=1.5 * p.size_m, centre=1.5 * p.centre) for p in ROOM]
    assert scene_alignment(ROOM, larger)[1].shares == (1.0, 1.0, 1.0, 1.0)
    assert object_alignment(ROOM, larger).s_acc == 0.0
    one = [replace(ROOM[0], size_m=1.3 * ROOM[0].size_m), *ROOM[1:]]
    assert scene_alignment(ROOM, one)[0].s_acc == pytest.approx(3 / 6)


def test_what_is_missing_is_wrong() -> None:
    gone = [None, *ROOM[1:]]
    pairs, strict = scene_alignment(ROOM, gone)
    assert pairs.shares == pytest.approx((0.5, 0.5, 0.5, 0.5))
    assert strict.shares == (0.0, 0.0, 0.0, 0.0)
    assert object_alignment(ROOM, gone).acc == 0.75


def test_symmetric_shapes_may_be_turned_by_their_symmetry() -> None:
    turned = [*ROOM[:2], replace(ROOM[2], R=ROOM[2].R @ yaw_rotation(np.pi)), ROOM[3]]
    assert scene_alignment(ROOM, turned)[1].shares == (1.0, 1.0, 1.0, 1.0)
    square = placed(1, 1, 0, (0.6, 0.9, 0.7), symmetry=4)
    swapped = replace(square, R=yaw_rotation(np.pi / 2), size_m=square.size_m[[1, 0, 2]])
    assert object_alignment([square], [swapped]).acc == 1.0


def test_small_scenes() -> None:
    assert scene_alignment([], [])[0].count == 0
    assert scene_alignment(ROOM[:1], ROOM[:1])[0].shares == (1.0, 1.0, 1.0, 1.0)
    assert scene_alignment(ROOM[:1], [None])[1].shares == (0.0, 0.0, 0.0, 0.0)


def test_scenes_are_pooled_by_their_objects() -> None:
    mean = pool([Alignment("x", 3, 1.0, 1.0, 1.0, 1.0), Alignment("x", 1, 0.0, 0.0, 0.0, 0.0)])
    assert (mean.count, mean.acc) == (4, 0.75)
    assert pool([]).count == 0


@settings(max_examples=20)
@given(st.floats(-3, 3), st.floats(-5, 5), st.floats(0.3, 3.0))
def test_scene_alignment_ignores_one_common_turn_shift_and_scale(yaw: float, shift: float, scale: float) -> None:
    moved = [Placed(p.R, scale * p.centre + shift, scale * p.size_m, p.symmetry) for p in ROOM]
    assert scene_alignment(ROOM, moved)[1].shares == (1.0, 1.0, 1.0, 1.0)
    together = [replace(p, R=yaw_rotation(yaw) @ p.R) for p in ROOM]
    assert scene_alignment(ROOM, together)[1].r_acc == 1.0


@given(st.floats(0.0, 3.1))
def test_the_angle_between_rotations(angle: float) -> None:
    assert rotation_angle(np.eye(3), yaw_rotation(angle)) == pytest.approx(angle, abs=1e-6)


def test_every_threshold_of_the_object_focus_by_itself() -> None:
    true = [placed(0, 0)]

    def shares_of(found: Placed) -> tuple[float, float, float, float]:
        return object_alignment(true, [found]).shares

    assert shares_of(placed(0.199, 0)) == (1, 1, 1, 1)
    assert shares_of(placed(0.201, 0)) == (1, 0, 1, 0)
    assert shares_of(placed(0, 0, 19.9)) == (1, 1, 1, 1)
    assert shares_of(placed(0, 0, 20.1)) == (0, 1, 1, 0)
    # 20 % is the mean over the three extents: one axis may be half as long again, not more than 60 %.
    assert shares_of(placed(0, 0, size=(0.79, 0.6, 0.9))) == (1, 1, 1, 1)
    assert shares_of(placed(0, 0, size=(0.81, 0.6, 0.9))) == (1, 1, 0, 0)
    assert object_alignment(true, [None]).shares == (0, 0, 0, 0)


@pytest.mark.parametrize(("fold", "turn_deg", "right"), [(1, 180, 0), (2, 180, 1), (2, 90, 0), (4, 90, 1), (36, 37, 1)])
def test_a_turn_counts_only_beyond_the_true_shapes_symmetry(fold: int, turn_deg: float, right: int) -> None:
    true, found = [placed(0, 0, symmetry=fold)], [placed(0, 0, turn_deg)]
    size = found[0].size_m
    square = [replace(true[0], size_m=size * [1, 0, 1] + [0, size[0], 0])] if fold == 4 else true
    same = [replace(found[0], size_m=square[0].size_m)]
    assert object_alignment(square, same).r_acc == right
