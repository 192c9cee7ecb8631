"""Light of a scene on a page: an even one from all sides, and the photo's main light."""

from __future__ import annotations

import numpy as np
import viser

from diorama_core.scene.types import RoomLight

MAIN_LIGHT_AWAY_M = 12.0
MAIN_LIGHT_EVEN, MAIN_LIGHT_STRENGTH = 0.6, 2.2
"""Its intensity where light comes from everywhere, and how much that grows up to light from one side alone."""
SKY, GROUND, AROUND = (255, 252, 246), (176, 170, 162), (255, 250, 244)


def add_even_light(scene: viser.SceneApi, *, sky: float, around: float) -> None:
    """Soft light from above and from all sides, of these intensities."""
    scene.add_light_hemisphere("/lights/sky", sky_color=SKY, ground_color=GROUND, intensity=sky)
    scene.add_light_ambient("/lights/around", color=AROUND, intensity=around)


def add_main_light(scene: viser.SceneApi, light: RoomLight, *, cast_shadow: bool) -> viser.DirectionalLightHandle:
    """The photo's main light, which takes the place of viser's own."""
    red, green, blue = (round(255 * c) for c in light.colour)
    away = MAIN_LIGHT_AWAY_M * np.array(light.direction)
    return scene.add_light_directional(
        "/lights/main",
        color=(red, green, blue),
        intensity=MAIN_LIGHT_EVEN + MAIN_LIGHT_STRENGTH * light.strength,
        cast_shadow=cast_shadow,
        position=(float(away[0]), float(away[1]), float(max(away[2], 1.0))),
    )
