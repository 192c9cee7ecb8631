from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.projection import cuboid_corners, visible_bounds
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.priors import SizeMode
from diorama_core.perception.metrology.problem import (
    BASE,
    CUT,
    EDGES,
    FAR,
    FOOTPRINT,
    SIZES,
    TOP,
    WALL,
    Problems,
    View,
    concatenate_problems,
    corners_camera,
    cuboids,
    values,
)
from diorama_core.perception.metrology.rows import row
from diorama_core.perception.metrology.settings import SETTINGS
from tests.perception.metrology.test_kind_outlines import WHOLE
from tests.perception.metrology.test_metrology import K, detected, rotation

VIEW = View(K, rotation(12.0))
SIZE = np.array([0.6, 0.9, 0.8])
CENTRE = np.array([0.3, 3.0, 0.4])
ASIDE = CENTRE + np.array([1.9, 0.0, 0.0])
HEIGHT = 1.5


def unknowns(centre=CENTRE, size=SIZE, view: View = VIEW) -> np.ndarray:
    """The row of unknowns that stands for a cuboid on the floor."""
    ahead, right = view.heading, np.array([view.heading[1], -view.heading[0]])
    forward = centre[:2] @ ahead
    return np.array([[centre[:2] @ right / forward, np.log(forward), *np.log(size), 0.0]])


def problem(yaw: float = -np.pi / 2, box: np.ndarray | None = None, **more) -> Problems:
    """One row whose outline fills its cuboid and whose box is the cuboid's projection, unless another is given."""
    if box is None:
        corners = cuboid_corners(CENTRE[None], np.array([yaw]), SIZE[None]) - [0, 0, HEIGHT]
        box = visible_bounds(corners @ VIEW.R_world_camera, K)[0][0]
    observations = gather((detected("o", "cabinet", tuple(box)),), K.width, K.height)
    mode = SizeMode(np.log(SIZE), np.full(3, 0.2), 0.0, WHOLE, np.eye(3) / 0.2)
    return row(observations, 0, mode, camera_height_m=HEIGHT, yaw_rad=yaw, **more)


@given(x=st.floats(-2, 2), y=st.floats(1, 6), yaw=st.floats(-3.1, 3.1), turn=st.floats(-40, 40))
def test_unknowns_stand_for_their_cuboid_whatever_the_heading(x, y, yaw, turn) -> None:
    view = View(K, rotation(12.0, turn))
    centre = np.array([*(y * view.heading + x * np.array([view.heading[1], -view.heading[0]])), 0.4])
    boxes = cuboids(unknowns(centre, view=view), problem(yaw=yaw), view)
    np.testing.assert_allclose(boxes.centre[0], centre, atol=1e-9)
    np.testing.assert_allclose(boxes.size_m[0], SIZE)
    assert boxes.base_m[0] == pytest.approx(0.0, abs=1e-12)
    assert boxes.top_m[0] == pytest.approx(0.8)
    assert boxes.yaw_rad[0] == yaw


def test_the_heading_looks_along_the_floor_even_straight_down() -> None:
    np.testing.assert_allclose(View(K, rotation(80.0, 30.0)).heading, [-0.5, np.sqrt(0.75)], atol=1e-9)
    down = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
    assert View(K, down).heading.tolist() == [0.0, 1.0]


def test_corners_in_the_camera_frame_are_those_of_the_posed_cuboid() -> None:
    boxes = cuboids(unknowns(), problem(), VIEW)
    found = corners_camera(boxes, np.array([HEIGHT]), VIEW)[0]
    world = found @ VIEW.R_world_camera.T + [0, 0, HEIGHT]
    np.testing.assert_allclose(world.min(axis=0), [0.3 - 0.45, 3.0 - 0.3, 0.0], atol=1e-9)
    np.testing.assert_allclose(world.max(axis=0), [0.3 + 0.45, 3.0 + 0.3, 0.8], atol=1e-9)


def test_nothing_speaks_against_the_true_cuboid() -> None:
    np.testing.assert_allclose(values(unknowns(), problem(), VIEW).residuals, 0.0, atol=1e-5)


def test_sizes_and_heights_are_measured_in_their_sigmas() -> None:
    found = values(unknowns(size=SIZE * np.exp([0.2, -0.4, 0.0])), problem(), VIEW).residuals[0]
    assert found[SIZES] == pytest.approx([1.0, -2.0, 0.0])
    lifted = unknowns()
    lifted[0, 5] = 1.5
    raised = values(lifted, problem(base_sigma_m=0.1, top_m=0.8, top_sigma_m=0.05), VIEW).residuals[0]
    assert raised[BASE] == 1.5
    assert raised[TOP] == pytest.approx(3.0)


def left_edge(shift: float, odds: float = 0.0, hidden_px: float = 0.0) -> float:
    """The residual of a box whose left edge lies `shift` pixels within the true cuboid's."""
    true = problem().box_px[0]
    moved = problem(box=true).with_columns(box_px=true + np.array([shift, 0.0, 0.0, 0.0]))
    rows = moved.with_columns(hidden_px=[hidden_px] * 4, hidden_odds=[odds] * 4)
    return float(values(unknowns(), rows, VIEW).residuals[0, 0])


def test_edges_are_robust() -> None:
    sigma = problem().edge_sigma_px[0, 0]
    assert left_edge(sigma) == pytest.approx(1.0)
    assert left_edge(-sigma) == pytest.approx(-1.0)
    assert left_edge(10 * sigma) == pytest.approx(
        np.sqrt(20.0 * SETTINGS.fit.robust_beyond - SETTINGS.fit.robust_beyond**2)
    )


def test_what_may_be_hidden_beyond_an_edge_costs_the_less_the_likelier_that_is() -> None:
    sigma = problem().edge_sigma_px[0, 0]
    seen, maybe, likely = (left_edge(6 * sigma, odds) for odds in (0.0, 0.1, 2.0))
    assert seen > maybe > likely > 0.0
    even = 0.1 * SETTINGS.fit.hidden_density
    assert maybe == pytest.approx(np.sqrt(2.0 * np.log((1.0 + even) / even)), rel=1e-3)
    assert left_edge(0.5 * sigma, 0.1) == pytest.approx(0.5, abs=0.05)
    assert left_edge(-6 * sigma, 2.0) == left_edge(-6 * sigma)


def test_nothing_goes_on_farther_than_something_may_hide_it() -> None:
    box = problem().box_px[0]
    near = left_edge(0.5 * SETTINGS.fit.hidden_reach * float(box[2] - box[0]), 2.0, hidden_px=1.0)
    far = 0.9 * float(box[2] - box[0])
    assert left_edge(far, 2.0) > near
    assert left_edge(far, 2.0, hidden_px=2 * far) == pytest.approx(near, abs=1e-6)


def test_a_cuboid_that_the_camera_cannot_see_is_refused_dearly() -> None:
    upward = View(K, rotation(-75.0))
    unseen, seen = (
        values(unknowns(), problem(), upward).residuals[0, EDGES],
        values(unknowns(), problem(), VIEW).residuals[0, EDGES],
    )
    assert np.abs(seen).max() < 1e-6
    assert (unseen**2).sum() > 2.0 * SETTINGS.fit.invisible_penalty**2


def test_reaching_beyond_the_picture_costs_against_the_box() -> None:
    inside = problem(cut_sigma=1.0)
    out = values(unknowns(ASIDE), inside, VIEW).residuals[0]
    corners = cuboid_corners(ASIDE[None], np.array([-np.pi / 2]), SIZE[None])[0] - [0, 0, HEIGHT]
    camera = corners @ VIEW.R_world_camera
    beyond = (camera[:, 0] / camera[:, 2] * K.fx + K.cx).max() - K.width
    width = inside.box_px[0, 2] - inside.box_px[0, 0]
    assert out[CUT] == pytest.approx([np.log1p(beyond / width), 0.0])


@given(yaw=st.floats(-3.1, 3.1), off=st.floats(-1.5, 1.5))
def test_a_base_beyond_its_supporter_costs_by_how_far(yaw, off) -> None:
    c, s = np.cos(yaw), np.sin(yaw)
    middle = CENTRE[:2] - off * np.array([c, s])
    rested = problem(yaw=yaw, footprint=np.array([*middle, yaw, 1.0, 2.0]), footprint_sigma_m=0.1)
    found = values(unknowns(), rested, VIEW).residuals[0, FOOTPRINT]
    assert found == pytest.approx([max(abs(off) - 0.7, 0.0) / 0.1, 0.0], abs=1e-6)


def test_a_back_off_its_wall_costs_more_when_nearer() -> None:
    # Facing the camera from ahead, its back is 3.3 m away.
    def off(wall_m: float) -> float:
        return float(values(unknowns(), problem(wall_m=wall_m, wall_sigma=0.3), VIEW).residuals[0, WALL])

    assert off(3.3) == pytest.approx(0.0, abs=1e-9)
    assert off(3.3 / np.exp(0.3)) == pytest.approx(1.0)
    assert off(3.3 * np.exp(0.3)) == pytest.approx(-5.0)


def test_far_places_are_doubted() -> None:
    assert values(unknowns(CENTRE * [1, 1.9, 1]), problem(), VIEW).residuals[0, FAR] == 0.0
    away = np.array([0.0, 6.0 * np.exp(0.15), 0.4])
    assert values(unknowns(away), problem(), VIEW).residuals[0, FAR] == pytest.approx(1.0)


def test_rows_are_stacked_chosen_and_changed() -> None:
    both = concatenate_problems([problem(), problem(yaw=0.5)])
    assert len(both) == 2
    assert both.rows(np.array([1])).yaw_rad.tolist() == [0.5]
    assert both.rows(both.yaw_rad > 0).yaw_rad.tolist() == [0.5]
    changed = both.with_columns(extra=2.0, box_px=[1.0, 2.0, 3.0, 4.0])
    assert changed.extra.tolist() == [2.0, 2.0]
    assert changed.box_px.tolist() == [[1.0, 2.0, 3.0, 4.0]] * 2
    assert both.extra.tolist() == [0.0, 0.0]
