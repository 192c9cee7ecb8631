from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.layout.refinement.prior import MEASURED, OUTLIER, REASONED, WEIGHT, PosePrior, Precision
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
    assert cost(turned, precision) == pytest.approx(WEIGHT)
    larger = replace(OBSERVED, scale=np.array(OBSERVED.scale) * np.exp(precision.size_share))
    assert cost(larger, precision) == pytest.approx(WEIGHT)


def test_from_a_photo_alone_what_is_farther_is_larger() -> None:
    away = Pose(OBSERVED.R_world_object, EYE + 1.1 * (OBSERVED.position - EYE), OBSERVED.scale)
    enlarged = replace(away, scale=1.1 * np.array(away.scale))
    assert cost(enlarged, REASONED) < cost(away, REASONED)
    assert cost(enlarged, MEASURED) > cost(away, MEASURED)


def test_what_the_layout_moved_far_costs_no_more_for_moving_on() -> None:
    far, farther = (replace(OBSERVED, position=EYE + d * (OBSERVED.position - EYE)) for d in (1.5, 1.6))
    assert cost(far, MEASURED) == pytest.approx(cost(farther, MEASURED)) == pytest.approx(WEIGHT * OUTLIER**2)
