from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.architecture.from_depth import view_headings
from diorama_core.architecture.walls.wall_candidates import find_walls
from diorama_core.architecture.walls.wall_path import distance_along, heading, lies_on, wall_runs
from tests.architecture.known_rooms import L_SHAPE
from tests.architecture.walls.measured_room import TOP_M, plain_shot, surface_of
from tests.synthetic_rooms import look, shoot


def runs_of(shot):
    surface = surface_of(shot)
    return wall_runs(surface, find_walls(surface, TOP_M), view_headings(shot.camera), TOP_M)


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_headings_turn_from_ahead_to_the_right(x, y) -> None:
    if np.hypot(x, y) > 1e-3:
        a = float(heading(np.array([x + 1.0, y + 2.0]), np.array([1.0, 2.0])))
        np.testing.assert_allclose(np.hypot(x, y) * np.array([np.sin(a), np.cos(a)]), [x, y], atol=1e-9)


def test_the_walls_of_a_box_lead_from_left_to_right() -> None:
    runs = runs_of(plain_shot())
    normals = [r.wall.normal.round(2).tolist() for r in runs]
    assert normals == [[1.0, 0.0], [0.0, -1.0], [-1.0, 0.0]]
    corners = [runs[0].last, runs[1].last]
    assert corners == pytest.approx([np.arctan2(-2, 4), np.arctan2(2, 4)], abs=np.deg2rad(1.5))
    low, high = view_headings(plain_shot().camera)
    assert runs[0].first == pytest.approx(low)
    assert runs[-1].last == pytest.approx(high)


def test_a_narrow_return_between_two_walls_is_found() -> None:
    runs = runs_of(shoot(look(0, 4, 1.5, 85, (320, 240)), L_SHAPE))
    facing_us = [r.wall.offset for r in runs if r.wall.normal[1] < -0.99]
    assert facing_us == pytest.approx([-4.8, -3.0], abs=0.05)
    order = [r.first for r in runs]
    assert order == sorted(order)


def test_without_candidates_nothing_leads() -> None:
    surface = surface_of(plain_shot())
    assert wall_runs(surface, [], (-0.5, 0.5), TOP_M) == []


def test_a_wall_explains_its_own_points_only() -> None:
    surface = surface_of(plain_shot())
    far = next(w for w in find_walls(surface, TOP_M) if w.normal[1] < -0.99)
    on = lies_on(surface, far)
    assert np.abs(surface.points[on, 1] - 4.0).max() < 0.12
    assert not surface.is_object[on].any()
    assert surface.points[on, 2].min() > 0.03
    own = (np.abs(surface.points[:, 1] - 4) < 0.01) & ~surface.is_object & (surface.points[:, 2] > 0.05)
    assert on[own].mean() > 0.9


def test_distances_are_those_of_the_line_and_infinite_behind() -> None:
    far = next(w for w in find_walls(surface_of(plain_shot()), TOP_M) if w.normal[1] < -0.99)
    exact = replace(far, normal=np.array([0.0, -1.0]), offset=-4.0)
    angles = np.array([0.0, 0.5, -1.0, np.pi / 2, np.pi])
    found = distance_along(exact, angles, np.zeros(2))
    assert found[:3] == pytest.approx(4.0 / np.cos(angles[:3]))
    assert np.isinf(found[3:]).all()
