"""The colour of what is mostly seen of every object in the photo's view: of bedding rather than of the bed's frame."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.geometry.vectors import dot, unit
from diorama_core.io.srgb import linear_to_srgb
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.gloss import gloss_share
from diorama_core.render.raycast import PinholeView, pixel_centres
from diorama_core.render.world import Places, scene_world
from diorama_core.scene.types import Camera, Scene

_SIDE_PX = 400


def visible_colours(
    scene: Scene, library: ShapeLibrary, textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]] | None = None
) -> dict[str, Float[np.ndarray, "3"]]:
    """What the material that most of an object's visible pixels show looks like in even light, by object id.

    Mean colour (sRGB 0 to 1) of its surface and of its gloss: dark wood that mirrors much looks grey.
    Objects that are out of the photo's view or wholly hidden are left out.
    """
    if scene.camera is None or not scene.objects:
        return {}
    world = scene_world(scene, library, textures=textures)
    view = PinholeView(_reduced(scene.camera))
    rays = view.rays(pixel_centres(view.width, view.height)).reshape(-1, 6)
    hits = world.caster.first_hits(rays)
    rays, hits = rays[hits.found], hits.chosen(hits.found)
    places = world.places(rays, hits)
    _, light = world.rough_appearance(hits)
    shown = _with_gloss(light, places, rays)
    found = {}
    for index, item in enumerate(scene.objects):
        mine = np.flatnonzero(places.instance == index)
        if len(mine):
            _, material, counts = np.unique(np.round(light[mine], 4), axis=0, return_inverse=True, return_counts=True)
            main = mine[material.ravel() == np.argmax(counts)]
            found[item.id] = np.asarray(linear_to_srgb(shown[main].mean(axis=0)))
    return found


def _with_gloss(base: Float[np.ndarray, "n 3"], places: Places, rays: Float[np.ndarray, "n 6"]) -> np.ndarray:
    """Linear colours of places with what they mirror of even light."""
    metallic, smooth = places.metallic[:, None], 1.0 - places.roughness[:, None]
    cosine = np.clip(-dot(places.normals, unit(rays[:, 3:])), 0.0, 1.0)[:, None]
    gloss = gloss_share(base, metallic, smooth, cosine)
    return np.minimum(base * (1 - metallic) + gloss, 1.0).astype(np.float64)


def _reduced(camera: Camera) -> Camera:
    k = camera.intrinsics
    scale = min(1.0, _SIDE_PX / max(k.width, k.height))
    return Camera(k.scaled(max(1, round(k.width * scale)), max(1, round(k.height * scale))), camera.T_world_camera)
