"""How much light falls on everything in the photo: the room's main light cast on the scene as it was built.

Objects shade one another, and what is inside or below others is darker than what is not: a material's colour is what is
left when that is divided out of the photo.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float32

from diorama_core.io.srgb import luminance
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.lighting import Effort
from diorama_core.render.picture import scene_lighting
from diorama_core.render.raycast import PinholeView
from diorama_core.render.shading import light_map
from diorama_core.render.world import scene_world
from diorama_core.scene.types import Camera, Scene

EFFORT = Effort(window_rays=2, sky_rays=3)


@dataclass(frozen=True)
class IrradianceSettings:
    """How the light on each surface is estimated."""

    longest_px: int = 320
    darkest: float = 0.45
    brightest: float = 1.6
    """The scene is not exactly the room: deeper shade than this is not believed."""
    unknown: float = 0.9
    max_tinted: float = 1.5
    """A channel of the light is at most so many times stronger or weaker than its luminance."""


SETTINGS = IrradianceSettings()


def irradiance_map(scene: Scene, camera: Camera, library: ShapeLibrary) -> Float32[np.ndarray, "h w 3"]:
    """The light on what each pixel of the photo sees; 1 lights a white surface white.

    It has the colours of what is beside: a tan sofa on orange boards looks more orange than its leather is.
    """
    k = camera.intrinsics
    shrink = min(1.0, SETTINGS.longest_px / max(k.width, k.height))
    small = k.resize(max(8, round(k.width * shrink)), max(8, round(k.height * shrink)))
    view = PinholeView(Camera(small, camera.T_world_camera))
    world = scene_world(scene, library)
    count = len(scene.objects)
    blockers = world.shadow_caster(without=range(count, count + len(scene.architecture.planes)))
    light = light_map(world, blockers, view, scene_lighting(scene, world, view), EFFORT)
    grey = luminance(light)
    level = np.where(grey > 0, np.clip(grey, SETTINGS.darkest, SETTINGS.brightest), np.float32(SETTINGS.unknown))
    tint = np.where(grey[..., None] > 0, light / np.maximum(grey, 1e-6)[..., None], 1.0)
    whole = (level[..., None] * np.clip(tint, 1.0 / SETTINGS.max_tinted, SETTINGS.max_tinted)).astype(np.float32)
    return np.asarray(cv2.resize(whole, (k.width, k.height), interpolation=cv2.INTER_LINEAR))
