"""Differences of colour (CIEDE2000: Sharma, Wu and Dalal 2005), and of the main light's direction."""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.geometry.vectors import dot, unit
from diorama_core.io.srgb import linear_to_srgb, luminance
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.gloss import gloss_share
from diorama_core.render.lighting import Lighting, irradiance_without_shadows
from diorama_core.render.raycast import PinholeView, pixel_centres
from diorama_core.render.world import Places, scene_world
from diorama_core.scene.types import Camera, RoomLight, Scene

HALF_LIGHTNESS = 2.0
"""Parametric factor k_L at which a difference of lightness counts half: photographs are not evenly lit."""
_TWENTY_FIVE_7 = 25.0**7


def delta_e_2000(
    lab_1: Float[np.ndarray, "*n 3"], lab_2: Float[np.ndarray, "*n 3"], k_lightness: float = 1.0
) -> Float[np.ndarray, "*n"]:
    """CIEDE2000 of two arrays of CIELAB colours (L 0 to 100); at k_L of `HALF_LIGHTNESS` lightness counts half."""
    (l1, a1, b1), (l2, a2, b2) = (np.moveaxis(np.asarray(lab, dtype=np.float64), -1, 0) for lab in (lab_1, lab_2))
    mean_chroma_7 = ((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2) ** 7
    stretch = 1 + 0.5 * (1 - np.sqrt(mean_chroma_7 / (mean_chroma_7 + _TWENTY_FIVE_7)))
    c1, c2 = np.hypot(a1 * stretch, b1), np.hypot(a2 * stretch, b2)
    h1, h2 = (np.degrees(np.arctan2(b, a * stretch)) % 360 for a, b in ((a1, b1), (a2, b2)))
    gray = c1 * c2 == 0
    turn = np.where(gray, 0.0, (h2 - h1 + 180) % 360 - 180)
    hue_difference = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn) / 2)
    hue = np.where(gray, h1 + h2, h1 + turn / 2)
    lightness, chroma = (l1 + l2) / 2, (c1 + c2) / 2
    t = 1 + sum(
        factor * np.cos(np.radians(times * hue + offset))
        for factor, times, offset in ((-0.17, 1, -30), (0.24, 2, 0), (0.32, 3, 6), (-0.20, 4, -63))
    )
    s_lightness = 1 + 0.015 * (lightness - 50) ** 2 / np.sqrt(20 + (lightness - 50) ** 2)
    s_chroma, s_hue = 1 + 0.045 * chroma, 1 + 0.015 * chroma * t
    rotation = 2 * np.sqrt(chroma**7 / (chroma**7 + _TWENTY_FIVE_7))
    rotation = -rotation * np.sin(np.radians(60 * np.exp(-((((hue % 360) - 275) / 25) ** 2))))
    of_lightness = (l2 - l1) / (k_lightness * s_lightness)
    of_chroma, of_hue = (c2 - c1) / s_chroma, hue_difference / s_hue
    return np.asarray(np.sqrt(of_lightness**2 + of_chroma**2 + of_hue**2 + rotation * of_chroma * of_hue))


def lab_of(srgb: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    """CIELAB (D65) of sRGB colours from 0 to 1."""
    flat = np.asarray(srgb, dtype=np.float32).reshape(-1, 1, 3)
    return np.asarray(cv2.cvtColor(flat, cv2.COLOR_RGB2Lab).reshape(np.shape(srgb)), dtype=np.float64)


def perceptual_difference(
    srgb_1: Float[np.ndarray, "*n 3"], srgb_2: Float[np.ndarray, "*n 3"]
) -> Float[np.ndarray, "*n"]:
    """CIEDE2000 of sRGB colours from 0 to 1, with lightness at half weight."""
    return delta_e_2000(lab_of(srgb_1), lab_of(srgb_2), HALF_LIGHTNESS)


_TURNS, _LEVELS = 24, 12


def main_light(light: Lighting, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "3"]:
    """What a light is at some places on average, in the terms of `RoomLight`: direction times strength.

    Args:
        light: Any.
        points: In the world.
    """
    height = (np.arange(_LEVELS) + 0.5) / _LEVELS * 2 - 1
    turn = (np.arange(_TURNS) + 0.5) / _TURNS * 2 * np.pi
    h, t = (grid.ravel() for grid in np.meshgrid(height, turn))
    across = np.sqrt(1 - h**2)
    normals = np.stack([across * np.cos(t), across * np.sin(t), h], axis=1).astype(np.float32)
    fallen = [
        luminance(irradiance_without_shadows(np.broadcast_to(p, normals.shape).astype(np.float32), normals, light))
        for p in points
    ]
    design = np.column_stack([np.ones(len(normals)), normals])
    even, *sloped = np.linalg.lstsq(design, np.mean(fallen, axis=0), rcond=None)[0]
    return np.array(sloped) / max(float(even), 1e-9)


def light_error_deg(
    true: Float[np.ndarray, "3"], true_camera: Camera, light: RoomLight | None, camera: Camera
) -> float | None:
    """Angle between both directions as the photo sees them; None where no light was found.

    Args:
        true: Direction to the light, world.
        true_camera: Of the true scene.
        light: The estimate; None without.
        camera: Of the estimate.
    """
    if light is None:
        return None
    seen = camera.T_world_camera[:3, :3].T @ np.array(light.direction)
    wanted = true_camera.T_world_camera[:3, :3].T @ true
    cosine = float(seen @ wanted) / max(float(np.linalg.norm(seen) * np.linalg.norm(wanted)), 1e-9)
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


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
    view = PinholeView(_reduce(scene.camera))
    rays = view.rays(pixel_centres(view.width, view.height)).reshape(-1, 6)
    hits = world.caster.first_hits(rays)
    rays, hits = rays[hits.is_hit], hits.select(hits.is_hit)
    places = world.places(rays, hits)
    _, light = world.rough_appearance(hits)
    shown = _with_gloss(light, places, rays)
    colours = {}
    for index, item in enumerate(scene.objects):
        mine = np.flatnonzero(places.instance == index)
        if len(mine):
            _, material, counts = np.unique(np.round(light[mine], 4), axis=0, return_inverse=True, return_counts=True)
            main = mine[material.ravel() == np.argmax(counts)]
            colours[item.id] = np.asarray(linear_to_srgb(shown[main].mean(axis=0)))
    return colours


def _with_gloss(base: Float[np.ndarray, "n 3"], places: Places, rays: Float[np.ndarray, "n 6"]) -> np.ndarray:
    """Linear colours of places with what they mirror of even light."""
    metallic, smooth = places.metallic[:, None], 1.0 - places.roughness[:, None]
    cosine = np.clip(-dot(places.normals, unit(rays[:, 3:])), 0.0, 1.0)[:, None]
    gloss = gloss_share(base, metallic, smooth, cosine)
    return np.minimum(base * (1 - metallic) + gloss, 1.0).astype(np.float64)


def _reduce(camera: Camera) -> Camera:
    k = camera.intrinsics
    scale = min(1.0, _SIDE_PX / max(k.width, k.height))
    return Camera(k.resize(max(1, round(k.width * scale)), max(1, round(k.height * scale))), camera.T_world_camera)
