"""The colour of what is mostly seen of every object in the photo's view: of bedding rather than of the bed's frame."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.io.srgb import linear_to_srgb
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.raycast import PinholeView, pixel_centres
from diorama_core.render.world import scene_world
from diorama_core.scene.types import Camera, Scene

_SIDE_PX = 400


def visible_colours(
    scene: Scene, library: ShapeLibrary, textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]] | None = None
) -> dict[str, Float[np.ndarray, "3"]]:
    """Mean albedo (sRGB 0 to 1) of the material that most of an object's visible pixels show, by object id.

    Objects that are out of the photo's view or wholly hidden are left out.
    """
    if scene.camera is None or not scene.objects:
        return {}
    world = scene_world(scene, library, textures=textures)
    view = PinholeView(_reduced(scene.camera))
    rays = view.rays(pixel_centres(view.width, view.height)).reshape(-1, 6)
    hits = world.caster.first_hits(rays)
    rays, hits = rays[hits.found], hits.chosen(hits.found)
    instance = world.places(rays, hits).instance
    _, light = world.rough_appearance(hits)
    found = {}
    for index, item in enumerate(scene.objects):
        mine = light[instance == index]
        if len(mine):
            colours, counts = np.unique(np.round(mine, 4), axis=0, return_counts=True)
            found[item.id] = np.asarray(linear_to_srgb(colours[np.argmax(counts)].astype(np.float64)))
    return found


def _reduced(camera: Camera) -> Camera:
    k = camera.intrinsics
    scale = min(1.0, _SIDE_PX / max(k.width, k.height))
    return Camera(k.scaled(max(1, round(k.width * scale)), max(1, round(k.height * scale))), camera.T_world_camera)
