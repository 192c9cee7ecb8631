from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.export.lights import UNHINDERED, WINDOW_LUX, even_irradiance, even_light_of, lights_of
from diorama_core.geometry.vectors import unit
from diorama_core.render.appearance import Material
from diorama_core.render.lamps import LAMP_LUMENS
from diorama_core.scene.light_settings import LightSettings
from diorama_core.scene.types import Architecture, Pose, Scene
from tests.app.small_room import furnished_scene, room_planes
from tests.export.surfaces import ball

SCENE = furnished_scene()
LAMP = replace(SCENE.object("lamp_1"), pose=Pose.upright((0.4, 2.3, 0.965), 0.3))


def test_a_lamp_shines_from_what_glows() -> None:
    bulb = ball(Material("bulb", (1, 1, 1), emissive=(1.0, 0.9, 0.7)), 0.04)
    raised = replace(bulb, vertices=bulb.vertices + np.array([0, 0, 0.1], np.float32))
    (light,) = lights_of(SCENE, [LAMP], {"lamp_1": (ball(), raised)})
    np.testing.assert_allclose(light.T_world[:3, 3], [0.4, 2.3, 1.065], atol=1e-6)
    assert light.lumens == LAMP_LUMENS["lamp"]
    assert light.radius_m == pytest.approx(0.02, abs=1e-3)
    assert light.candela == pytest.approx(light.lumens / (4 * np.pi))


def test_where_nothing_is_known_to_glow_its_middle_does() -> None:
    (light,) = lights_of(SCENE, [LAMP], {"lamp_1": (ball(),)})
    np.testing.assert_allclose(light.T_world[:3, 3], LAMP.pose.position, atol=1e-6)
    assert light.owner == "lamp_1"


@pytest.mark.parametrize("yaw", [-np.pi / 2, np.pi / 2])
def test_a_window_lets_daylight_into_the_room_whichever_way_it_was_made(yaw: float) -> None:
    picture = SCENE.object("picture_1")
    window = replace(picture, category="window", pose=Pose.upright(picture.pose.position, yaw))
    (light,) = lights_of(SCENE, [window], {})
    np.testing.assert_allclose(-light.T_world[:3, 2], [0, -1, 0], atol=1e-9)
    np.testing.assert_allclose(light.T_world[:3, 1], [0, 0, 1], atol=1e-9)
    assert np.linalg.det(light.T_world[:3, :3]) == pytest.approx(1.0)
    assert light.size_m == pytest.approx((0.8, 0.6))
    assert light.lumens == pytest.approx(WINDOW_LUX * 0.48)
    assert light.T_world[1, 3] < picture.pose.position[1], "before its face"


def test_other_objects_give_no_light() -> None:
    assert lights_of(SCENE, [SCENE.object("table_1"), SCENE.object("chair_1")], {}) == ()


def test_a_person_says_which_lamps_shine_and_windows_follow_the_time_of_day() -> None:
    def light(settings: LightSettings) -> list[float]:
        window = replace(SCENE.object("picture_1"), category="window")
        scene = replace(SCENE, light_settings=settings)
        return [found.lumens for found in lights_of(scene, [LAMP, window], {"lamp_1": (ball(),)})]

    usual = light(LightSettings())
    assert len(usual) == 2
    assert light(LightSettings(lamps_on=())) == usual[1:]
    at_night = light(LightSettings(hour=0.0, lamps_on=("lamp_1",)))
    assert at_night[0] == usual[0]
    assert at_night[1] < 0.1 * usual[1]


def room(width: float, depth: float) -> Scene:
    return replace(SCENE, architecture=Architecture(room_planes(width, depth, 2.5)))


@pytest.mark.parametrize(("width", "depth"), [(2.4, 3.0), (2.4, 5.0), (6.0, 5.0)])
def test_a_room_gets_as_much_even_light_as_in_pictures(width: float, depth: float) -> None:
    scene = room(width, depth)
    light = even_light_of(scene)
    assert light is not None
    points = len(light.positions)
    closed = 2 * (width * depth + 2.5 * (width + depth))
    expected = UNHINDERED * np.pi * even_irradiance(scene)
    assert 4 * np.pi * light.candela * points / closed == pytest.approx(expected)
    normals = unit(np.random.default_rng(0).normal(size=(100, 3)))
    received = light.lux * np.maximum(normals @ light.T_world[:, :3, 2].T, 0.0).sum(axis=1)
    assert 0.8 * expected < received.min()
    assert received.max() < 1.2 * expected


def test_lamps_give_a_part_of_it_unless_a_person_switched_them_on() -> None:
    scene = room(4.4, 4.0)
    lamps = lights_of(scene, [LAMP], {"lamp_1": (ball(),)})
    assert even_irradiance(scene, lamps) < even_irradiance(scene)
    evening = replace(scene, light_settings=LightSettings(18.0, lamps_on=("lamp_1",)))
    assert even_irradiance(evening, lamps) == even_irradiance(evening)


def test_a_floor_alone_has_a_light() -> None:
    floor = replace(SCENE, architecture=Architecture(room_planes()[:1]))
    light = even_light_of(floor)
    assert light is not None
    assert np.isfinite(light.candela)
