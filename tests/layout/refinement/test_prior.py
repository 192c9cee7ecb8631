from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.layout.refinement.prior import (
    MEASURED,
    REASONED,
    PosePrior,
    Precision,
)
from diorama_core.layout.settings import REFINEMENT
from diorama_core.scene.types import Pose, yaw_rotation

EYE = np.array([0.0, 0.0, 1.5])
OBSERVED = Pose.upright((0.0, 2.0, 0.5), 0.0, (1.0, 1.2, 0.8))


def cost(pose: Pose, precision: Precision) -> float:
    batch = PoseBatch(pose.R_world_object[None], pose.position[None], np.array(pose.scale)[None])
    return float(PosePrior(EYE, OBSERVED, precision).cost(batch)[0])


@pytest.mark.parametrize("precision", [MEASURED, REASONED])
def test_the_observed_pose_costs_nothing_and_a_standard_deviation_what_it_weighs(precision: Precision) -> None:
    assert cost(OBSERVED, precision) == pytest.approx(0.0, abs=1e-12)
    turned = replace(OBSERVED, R_world_object=yaw_rotation(0.1))
    assert cost(turned, precision) == pytest.approx(REFINEMENT.sigma)
    larger = replace(OBSERVED, scale=np.array(OBSERVED.scale) * np.exp(precision.size_share))
    assert cost(larger, precision) == pytest.approx(REFINEMENT.sigma)


def test_from_a_photo_alone_what_is_farther_is_larger() -> None:
    away = Pose(OBSERVED.R_world_object, EYE + 1.1 * (OBSERVED.position - EYE), OBSERVED.scale)
    enlarged = replace(away, scale=1.1 * np.array(away.scale))
    assert cost(enlarged, REASONED) < cost(away, REASONED)
    assert cost(enlarged, MEASURED) > cost(away, MEASURED)


def test_what_the_layout_changed_much_costs_no_more_for_another_change() -> None:
    much, more = (replace(OBSERVED, R_world_object=yaw_rotation(turn)) for turn in (1.0, 1.4))
    assert (
        cost(much, MEASURED)
        == pytest.approx(cost(more, MEASURED))
        == pytest.approx(REFINEMENT.sigma * REFINEMENT.max_sigmas**2)
    )


@pytest.mark.parametrize("precision", [MEASURED, REASONED])
def test_what_the_layout_moved_far_is_drawn_back_evenly(precision: Precision) -> None:
    usual = max(precision.distance_m / float(np.linalg.norm(OBSERVED.position - EYE)), precision.distance_share)
    away = [np.exp(k * usual) for k in (0.5, 4.0, 8.0, 12.0)]
    near, *far = (cost(_at_distance(d, precision), precision) for d in away)
    assert near == pytest.approx(REFINEMENT.sigma * 0.25)
    assert (
        far[2] - far[1]
        == pytest.approx(far[1] - far[0])
        == pytest.approx(REFINEMENT.sigma * 4.0 * 2.0 * REFINEMENT.linear_sigmas)
    )


def _at_distance(times: float, precision: Precision) -> Pose:
    grown = times if precision.sizes_follow else 1.0
    return Pose(OBSERVED.R_world_object, EYE + times * (OBSERVED.position - EYE), grown * np.array(OBSERVED.scale))


def test_only_what_was_measured_is_known_to_have_been_pushed_away() -> None:
    prior = PosePrior(EYE, OBSERVED, MEASURED)
    assert not prior.was_pushed_away(OBSERVED.moved((0.01, 0.0, 0.0)).position)
    assert prior.was_pushed_away(OBSERVED.moved((0.1, 0.0, 0.0)).position)
    assert not PosePrior(EYE, OBSERVED, REASONED).was_pushed_away(OBSERVED.moved((0.1, 0.0, 0.0)).position)
