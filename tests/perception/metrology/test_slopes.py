"""Derivatives of residuals against differences of residuals."""

from __future__ import annotations

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from diorama_core.perception.metrology.problem import UNKNOWNS, values
from diorama_core.perception.metrology.slopes import jacobian
from tests.perception.metrology.test_problem import CENTRE, SIZE, VIEW, problem, unknowns

STEP = 1e-6


@given(
    aside=st.floats(-3, 3), ahead=st.floats(0.15, 2), grown=st.tuples(*[st.floats(-0.4, 0.6)] * 3),
    raised=st.floats(-1, 1), yaw=st.floats(-3.1, 3.1), base_sigma=st.sampled_from([0.0, 0.2]),
)  # fmt: skip
@example(aside=0.0, ahead=1.1, grown=(0.1, 0.2, 0.1), raised=0.3, yaw=0.4, base_sigma=0.2)
@example(aside=1.9, ahead=1.0, grown=(0.1, 0.2, 0.1), raised=0.3, yaw=0.4, base_sigma=0.2)  # cut by the right side
@example(aside=0.0, ahead=0.15, grown=(0.5, 0.5, 0.5), raised=0.0, yaw=0.4, base_sigma=0.0)  # round the camera
@example(aside=0.3, ahead=2.0, grown=(0.6, -0.4, 0.0), raised=0.0, yaw=-1.2, base_sigma=0.0)  # far, off its supporter
def test_slopes_are_those_of_the_residuals(aside, ahead, grown, raised, yaw, base_sigma) -> None:
    row = problem(yaw=yaw).changed(
        base_sigma_m=base_sigma, top_m=0.9, top_sigma_m=0.1, footprint=[0.2, 3.1, 0.3, 0.5, 0.4], footprint_sigma_m=0.1,
        wall_m=2.0, wall_sigma=0.3, cut_sigma=0.2, hidden_px=[30.0, 0.0, 40.0, 5.0], hidden_odds=[0.5, 0.0, 0.2, 1.0],
        log_depth=1.0, depth_sigma=0.15,
    )  # fmt: skip
    # Aside of the middle: with two corners exactly behind one another, both kinks meet in one slope.
    at = unknowns(CENTRE * [1, ahead, 1] + [aside + 0.013, 0, 0], SIZE * np.exp(grown))
    at[0, 5] = raised
    here = values(at, row, VIEW)
    found = jacobian(row.without_outlines(), at, here, VIEW)[0]
    for unknown in range(UNKNOWNS):
        probe = STEP * np.eye(UNKNOWNS)[unknown]
        sides = [
            (values(at + s * probe, row, VIEW, here.inset_px).residuals[0] - here.residuals[0]) / (s * STEP)
            for s in (1.0, -1.0)
        ]
        slack = 0.02 * (1.0 + np.abs(sides).max(axis=0))
        assert (found[:, unknown] >= np.min(sides, axis=0) - slack).all(), "between both sides: residuals have kinks"
        assert (found[:, unknown] <= np.max(sides, axis=0) + slack).all()


def test_rows_have_their_own_slopes() -> None:
    row = problem().rows(np.array([0, 0]))
    at = np.concatenate([unknowns(CENTRE * [1, 1.2, 1]), unknowns(CENTRE * [1, 0.1, 1], SIZE * 1.5)])
    both = jacobian(row, at, values(at, row, VIEW), VIEW)
    for k in range(2):
        alone = row.rows(np.array([k]))
        one = jacobian(alone, at[k : k + 1], values(at[k : k + 1], alone, VIEW), VIEW)
        np.testing.assert_allclose(both[k], one[0], atol=1e-9)
