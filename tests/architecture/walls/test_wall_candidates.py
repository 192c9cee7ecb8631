from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.architecture.walls.wall_candidates import crossings, find_walls, fit_line, same_wall, tolerance_m
from tests.architecture.walls.measured_room import TOP_M, plain_shot, surface_of
from tests.synthetic_rooms import box_room, cuboid, look, shoot


def facing(walls, normal) -> list:
    return [w for w in walls if w.normal @ np.array(normal, dtype=float) > 0.99]


@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_the_walls_of_a_box_are_found_and_the_wardrobe_is_none(noise: float) -> None:
    surface = surface_of(plain_shot(noise))
    walls = find_walls(surface, TOP_M)
    for normal, offset in (((0, -1), -4.0), ((1, 0), -2.0), ((-1, 0), -2.0)):
        (wall,) = facing(walls, normal)
        assert wall.offset == pytest.approx(offset, abs=0.03)
        assert not surface.is_object[wall.inliers].any()
        assert wall.seen_through < 0.1
    assert [w.area_m2 for w in walls] == sorted((w.area_m2 for w in walls), reverse=True)


def test_a_screen_that_objects_are_seen_over_is_no_wall() -> None:
    screen = cuboid("screen", (0.0, 2.5, 0), (0.05, 2.0, 1.4), -90)
    shot = shoot(plain_shot().camera, box_room(-2.0, 2.0, 4.0, TOP_M), (screen,))
    nobody_pointed_at_it = surface_of(replace(shot, objects=()))
    found = facing(find_walls(nobody_pointed_at_it, TOP_M), (0, -1))
    assert [w.offset for w in found] == pytest.approx([-4.0], abs=0.03)


def test_nothing_upright_gives_no_walls() -> None:
    downward = shoot(look(0, 80, 1.5, 40, (160, 120)), box_room(-2.0, 2.0, 4.0, TOP_M))
    assert find_walls(surface_of(downward), TOP_M) == []


@given(angle=st.floats(-3.1, 3.1), offset=st.floats(-3, 3), noise=st.floats(0, 0.01))
def test_a_line_is_fitted_despite_outliers(angle, offset, noise) -> None:
    rng = np.random.default_rng(0)
    normal = np.array([np.cos(angle), np.sin(angle)])
    along = np.array([-normal[1], normal[0]])
    t = np.linspace(-1.5, 1.5, 300)
    points = offset * normal + t[:, None] * along + rng.normal(0, noise, 300)[:, None] * normal
    points[:20] += 0.6 * normal
    found, at = fit_line(points, np.ones(300), normal, 0.0)
    turned = np.arccos(np.clip(found @ normal, -1, 1))
    quarter = np.abs((angle + np.pi / 4) % (np.pi / 2) - np.pi / 4)
    # Lines almost along an axis of the room may be taken to lie along it.
    assert turned < max(np.deg2rad(1.0), 1.01 * quarter if quarter < np.deg2rad(10) else 0.0)
    assert at == pytest.approx(float(points[20:].mean(axis=0) @ found), abs=0.03)


def test_lines_almost_along_an_axis_are_taken_to_lie_along_it() -> None:
    rng = np.random.default_rng(1)
    t = np.linspace(-1.5, 1.5, 400)
    slightly = np.deg2rad(0.3)
    points = np.column_stack([t, 3.0 + np.tan(slightly) * t + rng.normal(0, 0.004, 400)])
    found, at = fit_line(points, np.ones(400), np.array([0.0, -1.0]), 0.005)
    assert found.tolist() == [0.0, -1.0]
    assert at == pytest.approx(-3.0, abs=0.01)
    clearly = np.column_stack([t, 3.0 + np.tan(np.deg2rad(12)) * t])
    found, _ = fit_line(clearly, np.ones(400), np.array([0.0, -1.0]), 0.005)
    assert np.rad2deg(np.arccos(-found[1])) == pytest.approx(12.0, abs=0.5)


def test_rays_cross_a_wall_from_its_front_where_geometry_says() -> None:
    surface = surface_of(plain_shot())
    crossing, share = crossings(surface, np.array([0.0, -1.0]), -2.0)
    hit = share > 0
    np.testing.assert_allclose(crossing[hit, 1], 2.0, atol=1e-6)
    beyond = surface.points[:, 1] > 2.01
    assert (share[beyond] < 1).all()
    assert (share[(surface.points[:, 1] < 1.99) & hit] > 1).all()
    _, from_behind = crossings(surface, np.array([0.0, 1.0]), 2.0)
    assert (from_behind == -1).all()


def test_two_slices_of_one_wall_are_the_same() -> None:
    surface = surface_of(plain_shot())
    (far,) = facing(find_walls(surface, TOP_M), (0, -1))
    (left,) = facing(find_walls(surface, TOP_M), (1, 0))
    assert same_wall(surface, replace(far, offset=far.offset + 0.02), far)
    assert not same_wall(surface, left, far)
    assert tolerance_m(np.array([1.0, 3.0])).tolist() == pytest.approx([0.055, 0.085])
