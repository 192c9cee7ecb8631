from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.perception.metrology.problem import concatenate_problems, corners_camera, cuboids
from diorama_core.perception.metrology.silhouette import DIAGONALS, corner_costs, mask_reach
from tests.perception.metrology.test_metrology import K, detected
from tests.perception.metrology.test_problem import VIEW, problem, unknowns

BOX = np.array([100.0, 100.0, 300.0, 200.0])


def item(mask: np.ndarray, confidence: float = 1.0):
    return replace(detected("o", "cabinet", tuple(BOX)), mask=mask, mask_confidence=confidence)


@given(seed=st.integers(0, 1000))
def test_reach_is_the_farthest_point_of_the_mask_along_each_diagonal(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mask = np.zeros((480, 640), dtype=bool)
    rows, columns = rng.integers(100, 200, 20), rng.integers(100, 300, 20)
    mask[rows, columns] = True
    corners = np.array([[c + dx, r + dy] for r, c in zip(rows, columns) for dx in (0, 1) for dy in (0, 1)])
    expected = (((corners - [200.0, 150.0]) / [100.0, 50.0]) @ DIAGONALS.T).max(axis=0)
    np.testing.assert_allclose(mask_reach(item(mask), BOX), expected)


def test_a_full_box_reaches_every_corner_and_no_mask_tells_nothing() -> None:
    mask = np.zeros((480, 640), dtype=bool)
    mask[100:200, 100:300] = True
    assert mask_reach(item(mask), BOX) == pytest.approx([2.0] * 4)
    few = np.zeros_like(mask)
    few[150, 200:202] = True
    assert np.isnan(mask_reach(item(few), BOX)).all()


def costs(reach, name: str = "cabinet", yaw: float = -np.pi / 2, weight: float = 1.0, exact: bool = True) -> float:
    rows = problem(yaw=yaw)
    boxes = cuboids(unknowns(), rows, VIEW)
    return float(
        corner_costs(rows, boxes, VIEW, np.array([reach]), np.full((1, 4), weight), np.array([exact]), (name,))[0]
    )


def own_reach(yaw: float = -np.pi / 2) -> np.ndarray:
    """How far the true cuboid's projection reaches."""
    rows = problem(yaw=yaw)
    camera = corners_camera(cuboids(unknowns(), rows, VIEW), rows.camera_height_m, VIEW)[0]
    pixels = camera[:, :2] / camera[:, 2:] * [K.fx, K.fy] + [K.cx, K.cy]
    box = rows.box_px[0]
    return ((pixels - (box[:2] + box[2:]) / 2) / ((box[2:] - box[:2]) / 2) @ DIAGONALS.T).max(axis=0)


def test_the_true_heading_costs_nothing_and_another_something() -> None:
    assert costs(own_reach()) == pytest.approx(0.0, abs=1e-9)
    assert costs(own_reach(-np.pi / 2 + 0.6)) > 1.0


def test_reaching_beyond_costs_more_than_leaving_empty_and_less_for_guesses() -> None:
    true = own_reach()
    one = np.array([0.1, 0.0, 0.0, 0.0])
    shorter, longer = true - one, true + one
    assert costs(longer) == pytest.approx((0.1 / 0.05) ** 2)
    assert costs(longer, exact=False) == pytest.approx((0.1 / 0.12) ** 2)
    assert costs(shorter) == pytest.approx((0.1 / 0.13) ** 2)
    assert costs(shorter, name="chair") == pytest.approx((0.1 / 0.35) ** 2)
    assert costs(longer, weight=0.5) == pytest.approx(2.0)


def test_costs_are_bounded_and_unknown_masks_say_nothing() -> None:
    assert costs(own_reach() + 5.0) == 10.0
    assert costs(np.full(4, np.nan)) == 0.0


def test_cuboids_that_reach_behind_the_camera_pay_for_every_corner() -> None:
    rows = concatenate_problems([problem()])
    boxes = cuboids(unknowns(np.array([0.0, 0.05, 0.4])), rows, VIEW)
    found = corner_costs(
        rows, boxes, VIEW, np.full((1, 4), 1.0), np.array([[1.0, 0.5, 0, 0]]), np.array([True]), ("bed",)
    )
    assert found.tolist() == [1.5]
