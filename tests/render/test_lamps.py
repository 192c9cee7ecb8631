from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.render.appearance import Material, Surface
from diorama_core.render.lamps import as_lit, shade_of
from diorama_core.scene.light_settings import LightSettings
from diorama_core.scene.types import Pose, Scene, SceneObject
from tests.export.surfaces import ball

LAMP = SceneObject("lamp_1", "lamp", "lamp", "shape", (0.3, 0.3, 0.5), Pose.upright((0.0, 0.0, 0.25)))
BULB = ball(Material("bulb", emissive=(1.0, 0.9, 0.7)), 0.04)
SHADE = ball(Material("shade"), 0.2)
FOOT = replace(ball(Material("foot"), 0.1), vertices=ball(Material("foot"), 0.1).vertices - np.float32(0.5))


def lit(surfaces: tuple[Surface, ...], lamps_on: tuple[str, ...] | None) -> dict[str, bool]:
    scene = replace(Scene(objects=(LAMP,)), light_settings=LightSettings(lamps_on=lamps_on))
    return {s.material.name: any(s.material.emissive) for s in as_lit(LAMP, surfaces, scene)}


def test_the_shade_is_what_lies_around_the_bulb_unless_it_is_of_metal() -> None:
    assert shade_of((FOOT, SHADE, BULB)) is SHADE
    metal = replace(SHADE, material=replace(SHADE.material, metallic=1.0))
    assert shade_of((FOOT, metal, BULB)) is None
    assert shade_of((FOOT,)) is None


def test_a_lamp_glows_with_its_shade_when_on_and_not_at_all_when_off() -> None:
    surfaces = (FOOT, SHADE, BULB)
    assert lit(surfaces, None) == {"foot": False, "shade": False, "bulb": True}, "as the shape says"
    assert lit(surfaces, ("lamp_1",)) == {"foot": False, "shade": True, "bulb": True}
    assert lit(surfaces, ()) == {"foot": False, "shade": False, "bulb": False}
