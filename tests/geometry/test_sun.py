from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from shapely.geometry import Polygon

from diorama_core.editing.plan_edits import empty_room
from diorama_core.geometry.sun import LIFT_M, daylight, sun_direction, sun_patches
from diorama_core.scene.types import Architecture, Pose, Scene, SceneObject, Support

NORTH = np.pi / 2


def test_the_sun_rises_in_the_east_stands_in_the_south_and_sets_in_the_west() -> None:
    np.testing.assert_allclose(sun_direction(6.0, NORTH), [1.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(sun_direction(12.0, NORTH), [0.0, -np.sqrt(0.5), np.sqrt(0.5)], atol=1e-12)
    np.testing.assert_allclose(sun_direction(18.0, NORTH), [-1.0, 0.0, 0.0], atol=1e-12)
    assert sun_direction(0.0, NORTH)[2] < -0.5


@pytest.mark.parametrize("hour", [0.0, 7.3, 12.0, 20.0])
def test_turning_north_turns_the_sun(hour: float) -> None:
    x, y, z = sun_direction(hour, NORTH)
    turned = sun_direction(hour, NORTH + np.pi / 2)
    np.testing.assert_allclose(turned, [-y, x, z], atol=1e-12)
    assert np.linalg.norm(turned) == pytest.approx(1.0)


def test_light_grows_whiter_and_stronger_toward_noon_and_is_nearly_gone_at_night() -> None:
    morning, noon, night = (daylight(h, NORTH) for h in (6.6, 12.0, 1.0))
    assert (noon.sun > morning.sun).all()
    assert morning.sun[2] / morning.sun[0] < 0.6 * noon.sun[2] / noon.sun[0], "low sun is red"
    assert not night.sun.any()
    assert noon.sky.max() == pytest.approx(1.0, abs=0.01)
    assert 0.0 < night.sky.max() < 0.1


TOWARD_SUN = np.array([0.0, 1.0, 1.0]) / np.sqrt(2.0)
"""Through the far wall (+y), half high."""


def room(width_m: float = 1.0) -> Scene:
    pose = Pose.upright((0.0, 2.0, 1.5), -np.pi / 2)
    window = SceneObject("window_1", "window", "window", "shape", (0.06, width_m, 1.0), pose)
    return replace(
        empty_room(4.0, 4.0, 2.6), objects=(window,), supports=(Support("window_1", "wall_1", "mounted on"),)
    )


def test_a_window_is_drawn_on_the_floor_where_the_sun_falls_through_it() -> None:
    (patch,) = sun_patches(room(), TOWARD_SUN)
    assert patch[:, 2] == pytest.approx(LIFT_M)
    low, high = patch.min(axis=0), patch.max(axis=0)
    assert (low[1], high[1]) == pytest.approx((0.06, 0.94), abs=1e-6), "1.06 to 1.94 m below the sill and the top"
    assert (low[0], high[0]) == pytest.approx((-0.44, 0.44), abs=1e-6)
    a, b, c = patch[:3]
    assert np.cross(b - a, c - b)[2] > 0, "seen from above"


def test_no_patch_where_the_sun_is_on_the_other_side_or_down_or_the_window_is_hidden() -> None:
    assert sun_patches(room(), np.array([0.0, -0.8, 0.6])) == []
    assert sun_patches(room(), np.array([0.0, 0.8, -0.6])) == []
    scene = room()
    hidden = replace(scene, objects=(replace(scene.objects[0], hidden=True),))
    assert sun_patches(hidden, TOWARD_SUN) == []


def test_a_slanted_sun_falls_on_floor_and_wall() -> None:
    toward = np.array([-0.8, 0.5, 0.45])
    patches = sun_patches(room(), toward / np.linalg.norm(toward))
    walls = [p for p in patches if np.ptp(p[:, 2]) > 0.05]
    assert walls
    assert all(p[:, 0] == pytest.approx(2.0 - LIFT_M) for p in walls)


def _area(patches: list[np.ndarray]) -> float:
    return sum(float(Polygon(p[:, :2]).area) for p in patches)


def _with(scene: Scene, at: tuple[float, float, float], size: tuple[float, float, float], category: str) -> Scene:
    thing = SceneObject("thing_1", category, category, "shape", size, Pose.upright(at, 0.0))
    return replace(scene, objects=(*scene.objects, thing))


def test_furniture_shades_the_floor_and_a_rug_does_not() -> None:
    bare = _area(sun_patches(room(), TOWARD_SUN))
    half = sun_patches(_with(room(), (0.25, 0.5, 1.0), (0.5, 2.0, 2.0), "wardrobe"), TOWARD_SUN)
    assert _area(half) == pytest.approx(bare / 2, rel=0.05)
    assert all(p[:, 0].max() <= 1e-6 for p in half)
    assert _area(sun_patches(_with(room(), (0.0, 0.5, 0.01), (2.0, 2.0, 0.02), "rug"), TOWARD_SUN)) == pytest.approx(
        bare
    )


def test_a_shadow_within_a_patch_leaves_outlines_without_holes() -> None:
    bare = _area(sun_patches(room(), TOWARD_SUN))
    around = sun_patches(_with(room(), (0.0, 0.5, 0.05), (0.2, 0.2, 0.1), "plant"), TOWARD_SUN)
    assert len(around) >= 2
    assert all(Polygon(p[:, :2]).is_valid for p in around)
    assert _area(around) == pytest.approx(bare - 0.2 * 0.3, abs=1e-3), "its foot, and its height along the slope"


def test_the_sun_comes_through_the_usual_window_of_a_wall_that_nobody_saw() -> None:
    whole = empty_room(4.0, 4.0, 2.6)
    planes = tuple(p for p in whole.architecture.planes if p.normal[1] > -0.9)
    assert len(planes) == len(whole.architecture.planes) - 1
    assert sun_patches(whole, TOWARD_SUN) == []
    assert len(sun_patches(replace(whole, architecture=Architecture(planes)), TOWARD_SUN)) == 1
