from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.perception.metrology import solver
from diorama_core.perception.metrology.problem import concatenate_problems, cuboids, values
from diorama_core.perception.metrology.solver import solve
from tests.perception.metrology.test_problem import CENTRE, SIZE, VIEW, problem, unknowns


@settings(max_examples=20)
@given(dx=st.floats(-0.8, 0.8), ahead=st.floats(0.6, 1.6), grown=st.floats(-0.3, 0.3))
def test_the_true_cuboid_is_found_from_afar(dx, ahead, grown) -> None:
    start = unknowns(CENTRE * [1, ahead, 1] + [dx, 0, 0], SIZE * np.exp(grown))
    found = solve(problem(), start, VIEW, 40)
    assert found.cost[0] == pytest.approx(0.0, abs=2e-2)
    np.testing.assert_allclose(cuboids(found.unknowns, found.problems, VIEW).centre[0], CENTRE, atol=0.08)


def test_cost_never_rises_and_counts_the_rows_own_assumptions() -> None:
    start = unknowns(CENTRE * [1, 1.5, 1])
    costs = [float(solve(problem(), start, VIEW, n).cost[0]) for n in range(6)]
    assert costs[0] == pytest.approx(float((values(start, problem(), VIEW).residuals ** 2).sum()))
    assert all(b <= a for a, b in pairwise(costs))
    assert solve(problem(extra=3.0), start, VIEW, 5).cost[0] == pytest.approx(costs[5] + 3.0)


def test_rows_do_not_disturb_each_other() -> None:
    one, other = problem(), problem(yaw=0.0)
    starts = np.concatenate([unknowns(CENTRE * [1, 1.4, 1]), unknowns(CENTRE * [1, 0.7, 1])])
    both = solve(concatenate_problems([one, other]), starts, VIEW)
    for k, alone in enumerate((one, other)):
        expected = solve(alone, starts[k : k + 1], VIEW)
        np.testing.assert_allclose(both.unknowns[k], expected.unknowns[0], atol=1e-9)
        np.testing.assert_allclose(both.rows(np.array([k])).cost, expected.cost)


def test_slopes_are_taken_anew_only_of_rows_that_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[int] = []

    def counted(problems, unknowns, here, view, settings):
        taken.append(len(problems))
        return original(problems, unknowns, here, view, settings)

    original = solver._slopes
    monkeypatch.setattr(solver, "_slopes", counted)
    settled = solve(problem(), unknowns(CENTRE * [1, 1.5, 1]), VIEW, 60).unknowns
    taken.clear()
    again = solve(problem(), settled, VIEW, 60)  # no step makes it better, whatever its damping
    np.testing.assert_allclose(again.unknowns, settled, atol=1e-4)
    assert sum(taken) <= 2


def test_sizes_stay_within_two_sigmas_whatever_the_box_says() -> None:
    whole = problem().with_columns(box_px=[5.0, 5.0, 630.0, 470.0], edge_sigma_px=[0.5] * 4)
    found = solve(whole, unknowns(), VIEW, 30)
    off = (found.unknowns[0, 2:5] - np.log(SIZE)) / 0.2
    assert np.abs(off).max() <= 2.0 + 1e-9
    assert np.abs(off).max() > 1.0


def test_no_rows() -> None:
    nothing = problem().rows(np.zeros(0, dtype=int))
    assert len(solve(nothing, np.zeros((0, 6)), VIEW).cost) == 0
