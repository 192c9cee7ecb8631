from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.library.taxonomy import category
from diorama_core.perception.measured.boxes import TurnedExtent, complete_extent, fit_extent, to_cuboid, usual_plan
from diorama_core.scene.types import yaw_rotation

NOWHERE = np.zeros((0, 3))
UNCUT = np.zeros(3, dtype=bool)
EYE = np.array([0.0, 0.0, 1.5])


def cloud(size, centre, yaw_deg: float = 0.0, n: int = 12) -> np.ndarray:
    """Points all over a box's surface."""
    steps = np.linspace(-0.5, 0.5, n)
    grid = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    surface = grid[(np.abs(grid) == 0.5).any(axis=1)]
    return (surface * size) @ yaw_rotation(np.deg2rad(yaw_deg)).T + np.array(centre)


@settings(max_examples=20)
@given(yaw=st.floats(-44, 44), depth=st.floats(0.3, 0.5), x=st.floats(-2, 2))
def test_turned_boxes_are_found_where_they_are(yaw, depth, x) -> None:
    found = fit_extent(cloud((depth, 1.5, 0.8), (x, 3.0, 0.4), yaw), category("chair"))
    np.testing.assert_allclose(found.centre_world, [x, 3.0, 0.4], atol=0.05)
    if abs(yaw) > 15:
        assert np.rad2deg(found.yaw_rad) == pytest.approx(yaw, abs=2.0)
        np.testing.assert_allclose(np.sort(found.size), np.sort([depth, 0.8, 1.5]), atol=0.05)
    if abs(yaw) < 0.5:
        assert found.yaw_rad == 0.0


def test_the_rooms_axes_are_preferred_unless_a_turn_is_clearly_tighter() -> None:
    slightly = cloud((0.5, 0.55, 0.8), (0, 3, 0.4), 3.0)
    assert fit_extent(slightly, category("wardrobe")).yaw_rad == 0.0
    long = cloud((0.3, 2.0, 0.8), (0, 3, 0.4), 25.0)
    assert np.rad2deg(fit_extent(long, category("wardrobe")).yaw_rad) == pytest.approx(25.0, abs=1.0)


def front_only(depth: float = 0.1) -> TurnedExtent:
    """A wardrobe of which only the front, 2.5 m ahead, was seen."""
    return TurnedExtent(0.0, np.array([-0.6, 2.5, 0.0]), np.array([0.6, 2.5 + depth, 2.0]))


def test_an_unseen_back_is_completed_away_from_the_camera() -> None:
    usual = category("wardrobe").priors[0].depth_m
    found = complete_extent(front_only(), category("wardrobe"), EYE, UNCUT, NOWHERE, NOWHERE)
    assert found.low[1] == 2.5
    assert found.high[1] == pytest.approx(2.5 + usual)
    np.testing.assert_allclose(found.size[[0, 2]], front_only().size[[0, 2]])


def test_it_stops_before_what_is_seen_behind() -> None:
    wall = np.column_stack([np.linspace(-2, 2, 50), np.full(50, 2.8), np.full(50, 1.0)])
    found = complete_extent(front_only(), category("wardrobe"), EYE, UNCUT, wall, NOWHERE)
    assert found.high[1] == pytest.approx(2.8)


def test_a_seen_top_tells_the_depth() -> None:
    top = cloud((1.2, 0.06, 0.0), (0.0, 2.53, 2.0))
    found = complete_extent(front_only(), category("wardrobe"), EYE, UNCUT, NOWHERE, top)
    assert found.high[1] > 2.6, "a rim of six centimetres is no top"
    deep = front_only(0.3)
    seen = cloud((1.2, 0.3, 0.0), (0.0, 2.65, 2.0))
    assert complete_extent(deep, category("bed"), EYE, UNCUT, NOWHERE, seen).high[1] == 2.8


@pytest.mark.parametrize(("side", "grows"), [(0, "low"), (1, "high")])
def test_what_the_picture_cuts_off_goes_on_out_of_the_picture(side: int, grows: str) -> None:
    cut = UNCUT.copy()
    cut[side] = True
    narrow = TurnedExtent(0.0, np.array([-0.3, 2.5, 0.0]), np.array([0.3, 3.4, 0.8]))
    found = complete_extent(narrow, category("sofa"), EYE, cut, NOWHERE, NOWHERE)
    assert getattr(found, grows)[0] != getattr(narrow, grows)[0]
    other = "high" if grows == "low" else "low"
    assert getattr(found, other)[0] == getattr(narrow, other)[0]
    above = np.array([False, False, True])
    low = TurnedExtent(0.0, np.array([-0.6, 2.5, 0.0]), np.array([0.6, 3.1, 0.5]))
    tall = complete_extent(low, category("wardrobe"), EYE, above, NOWHERE, NOWHERE)
    assert tall.high[2] == category("wardrobe").priors[0].height_m


def test_the_usual_plan_is_turned_as_it_fits() -> None:
    prior = category("sofa").priors[0]
    assert usual_plan(np.array([0.5, 1.8, 0.8]), category("sofa")).tolist() == [prior.depth_m, prior.width_m]
    assert usual_plan(np.array([1.8, 0.5, 0.8]), category("sofa")).tolist() == [prior.width_m, prior.depth_m]


@given(yaw=st.floats(-0.7, 0.7), x=st.floats(-2, 2), y=st.floats(1.5, 4))
def test_a_cuboid_is_the_same_box_with_its_front_to_the_camera(yaw, x, y) -> None:
    centre = yaw_rotation(yaw).T @ np.array([x, y, 0.4])
    half = np.array([0.45, 1.0, 0.4])
    extent = TurnedExtent(yaw, centre - half, centre + half)
    made = to_cuboid("sofa", extent, category("sofa"), EYE, 0.7)
    np.testing.assert_allclose(made.centre, [x, y, 0.4], atol=1e-9)
    np.testing.assert_allclose(made.size_m, [0.9, 2.0, 0.8])
    assert made.R_world_object[:2, 0] @ (EYE[:2] - [x, y]) >= -1e-9
    volume = np.abs(np.linalg.det(made.R_world_object)) * made.size_m.prod()
    assert volume == pytest.approx(extent.size.prod())
