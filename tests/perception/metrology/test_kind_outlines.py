"""Outlines within cuboids, and that a picture does not tell its scale."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.artefacts import DetectedObject
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.priors import size_modes
from diorama_core.perception.metrology.problem import EDGES, Problems, View, values
from diorama_core.perception.metrology.rows import row
from diorama_core.perception.metrology.solver import solve
from diorama_core.scene.types import Intrinsics, box_corners

K = Intrinsics(640, 480, 540.0, 540.0, 320.0, 240.0)
VIEW = View(K, np.array([[1.0, 0, 0], [0, -0.17, 0.985], [0, -0.985, -0.17]]))
WHOLE = np.tile(box_corners((1.0, 1.0, 1.0)), (5, 1))
"""An outline that fills its cuboid."""


def problem(category: str = "table", height_m: float = 1.5) -> Problems:
    item = DetectedObject("a", category, category, (200.0, 220.0, 420.0, 380.0), np.zeros((480, 640), bool), 1, 0.1)
    return row(gather((item,), 640, 480), 0, size_modes(category)[0], camera_height_m=height_m, yaw_rad=0.3)


def unknowns(distance_m: float, scale: float = 1.0) -> np.ndarray:
    return np.array([[0.05, np.log(distance_m * scale), *np.log(np.array([0.8, 1.3, 0.75]) * scale), 0.0]])


def inset_px(distance_m: float, problems: Problems) -> np.ndarray:
    return values(unknowns(distance_m), problems, VIEW).inset_px


@settings(max_examples=25)
@given(st.floats(2.0, 6.0), st.sampled_from(["table", "chair", "plant", "sofa", "object"]))
def test_outlines_stay_within_their_cuboids(distance_m: float, category: str) -> None:
    inset = inset_px(distance_m, problem(category))
    assert (inset >= 0).all()
    assert inset.max() > 0.5
    filled = problem(category).with_columns(outline=WHOLE)
    assert np.allclose(inset_px(distance_m, filled), 0, atol=1e-6)


@settings(max_examples=25)
@given(st.floats(0.6, 1.6), st.floats(2.0, 4.0))
def test_a_larger_world_projects_alike(scale: float, distance_m: float) -> None:
    """Only the priors tell scale: that is what carrying solutions from height to height rests on."""
    here, there = problem(height_m=1.5), problem(height_m=1.5 * scale)
    a = values(unknowns(distance_m), here, VIEW).residuals[0, EDGES]
    b = values(unknowns(distance_m, scale), there, VIEW).residuals[0, EDGES]
    assert np.allclose(a, b, atol=1e-6)


def test_what_is_behind_the_camera_has_no_known_outline() -> None:
    assert np.allclose(inset_px(0.3, problem()), 0)


@settings(max_examples=10)
@given(st.floats(1.0, 2.0))
def test_solutions_keep_their_bounds_and_never_grow_worse(height_m: float) -> None:
    batch = problem(height_m=height_m)
    start = unknowns(3.0)
    before = (values(start, batch, VIEW).residuals ** 2).sum()
    found = solve(batch, start, VIEW)
    assert found.cost[0] <= before + batch.extra[0] + 1e-9
    reach = 2.0 * batch.log_size_sigma[0] + 1e-9
    assert (np.abs(found.unknowns[0, 2:5] - batch.log_size[0]) <= reach).all()


def test_extents_that_grow_together_cost_less_than_those_that_do_not() -> None:
    batch = problem()
    together = replace(
        batch, whitening=np.linalg.inv(np.linalg.cholesky([[[0.04, 0.03, 0], [0.03, 0.04, 0], [0, 0, 0.04]]]))
    )
    prior = slice(6, 9)
    base = np.array([[0.0, 1.0, *batch.log_size[0], 0.0]])
    alike, against = base.copy(), base.copy()
    alike[0, 2:4] += 0.1
    against[0, 2:4] += [0.1, -0.1]
    costs = [(values(u, together, VIEW).residuals[0, prior] ** 2).sum() for u in (alike, against)]
    assert costs[0] == pytest.approx(0.02 / 0.07)
    assert costs[1] == pytest.approx(0.02 / 0.01)
