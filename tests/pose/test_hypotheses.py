"""Poses worth trying: turns of the shape in its cuboid, and of the cuboid itself."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import Cuboid
from diorama_core.pose.hypotheses import Hypotheses, anchor_of, hypotheses_for, unlike_best
from diorama_core.pose.limits import SizeLimits
from diorama_core.scene.types import yaw_rotation

PILLOW = np.array([0.24, 0.48, 0.44])


def hypotheses(
    size_m: tuple[float, float, float], *, front_known: bool = False, sides_known: bool = False
) -> Hypotheses:
    """Hypotheses of a pillow in a cuboid that is turned by ten degrees."""
    cuboid = Cuboid("pillow_1", yaw_rotation(np.deg2rad(10.0)), np.array([1.0, 2.0, 0.6]), np.array(size_m), 1.0)
    cuboid = replace(cuboid, front_known=front_known)
    limits = SizeLimits.of(tuple(PILLOW), "pillow", cuboid.size_m)
    anchor = anchor_of(cuboid, False, np.array([0.0, -1.0]))
    return hypotheses_for(cuboid, "pillow", 1, limits, anchor, sides_known=sides_known)


def footprints(found: Hypotheses) -> Counter[tuple[int, float, float]]:
    """How often there is each heading in whole degrees with sides, rounded."""
    yaw = np.rad2deg(np.arctan2(found.poses.R[:, 1, 0], found.poses.R[:, 0, 0])) % 360
    sizes = found.poses.scale * PILLOW
    return Counter((round(a), round(float(x), 1), round(float(y), 1)) for a, (x, y, _) in zip(yaw, sizes, strict=True))


def test_the_cuboid_itself_may_be_turned_where_its_sides_differ() -> None:
    found, turned = hypotheses((0.24, 0.48, 0.44)), ((100, 0.2, 0.5), (280, 0.2, 0.5))
    front_known = hypotheses((0.24, 0.48, 0.44), front_known=True)
    assert all(footprints(found)[one] == footprints(front_known)[one] + 1 for one in turned)
    assert (100, 0.2, 0.5) not in footprints(hypotheses((0.24, 0.48, 0.44), sides_known=True))
    whole = hypotheses((0.4, 0.4, 0.44), sides_known=True)
    assert len(found.poses) == len(front_known.poses) + len(whole.poses) // 2


def test_turning_the_cuboid_costs_something() -> None:
    found = hypotheses((0.24, 0.48, 0.44))
    yaw = np.rad2deg(np.arctan2(found.poses.R[:, 1, 0], found.poses.R[:, 0, 0])) % 360
    filling = np.abs(found.poses.scale - 1.0).max(axis=1) < 0.01
    as_measured, turned = (found.misfit[filling & (np.abs(yaw - angle) < 1.0)].min() for angle in (10.0, 100.0))
    assert turned > as_measured + 0.1


def test_from_a_picture_alone_a_shape_is_tried_in_its_own_proportions_too() -> None:
    found, measured = hypotheses((0.9, 0.48, 0.44)), hypotheses((0.9, 0.48, 0.44), sides_known=True)
    as_made = np.isclose(found.poses.scale, 1.0, atol=0.01).all(axis=1)
    assert as_made.any()
    assert (found.misfit[as_made] > found.misfit.min() + 0.1).all()
    assert not np.isclose(measured.poses.scale, 1.0, atol=0.01).all(axis=1).any()


@pytest.mark.parametrize("count", [1, 3])
def test_the_best_that_are_unlike_each_other_are_kept(count: int) -> None:
    found = hypotheses((0.4, 0.4, 0.44))
    scores = -np.arange(len(found.poses), dtype=float)
    chosen = unlike_best(found.poses, scores, 1, PILLOW, count)
    assert len(chosen) == count
    assert chosen[0] == 0


def test_a_round_shape_in_a_long_cuboid_is_tried_as_wide_as_either_side() -> None:
    cuboid = Cuboid("a", np.eye(3), np.array([0.0, 2.0, 0.37]), np.array([0.9, 1.8, 0.74]), 0.5)
    limits = SizeLimits.of((0.9, 0.9, 0.74), "table", cuboid.size_m, sides_log=0.0)
    anchor = anchor_of(cuboid, False, np.array([0.0, -1.0]))
    found = hypotheses_for(cuboid, "table", 36, limits, anchor, sides_known=False)
    sides = found.poses.scale[:, 0] * 0.9
    assert np.allclose(found.poses.scale[:, 0], found.poses.scale[:, 1])
    assert sides.min() == pytest.approx(0.9, rel=0.01)
    assert sides.max() > 1.3
