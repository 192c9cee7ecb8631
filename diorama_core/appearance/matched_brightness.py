"""Materials as bright as the photo: what was read of them is shown in the scene's own light and set against the photo.

An albedo is known only up to the light on its surface, and the estimated light is not the room's: what it gets wrong of
an object as a whole is found by rendering the scene once and comparing each object's visible pixels with the photo's.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from dataclasses import replace

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.appearance.room_cues import SETTINGS
from diorama_core.appearance.surface_materials import MAX_LINEAR
from diorama_core.io.srgb import linear_to_srgb, luminance, srgb_to_linear
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.lighting import Effort
from diorama_core.render.picture import picture
from diorama_core.scene.types import Camera, PhotoMaterial, Scene

EFFORT = Effort(window_rays=2, sky_rays=3)
DARKEST = 1e-3

Materials = Mapping[str, tuple[PhotoMaterial, ...]]
Pictures = Mapping[str, UInt8[np.ndarray, "_ _ 3"]]


def brightness_gains(
    rgb: UInt8[np.ndarray, "h w 3"],
    visible: Mapping[str, Bool[np.ndarray, "h w"]],
    scene: Scene,
    pictures: Pictures,
    library: ShapeLibrary,
) -> dict[str, float]:
    """By how much every object's materials must become brighter for it to look in the scene as in the photo.

    Args:
        rgb: The photo, as white light would have it.
        visible: Where it shows each object's materials, without what stands before it, by object id. Highlights, and
            where the pose shows another material than the photo, are the exception: the typical ratio counts.
        scene: In its own light, white, with the materials; its camera is the photo's.
        pictures: Of the materials, by name.
        library: Where its shapes are.
    """
    if scene.camera is None:
        return {}
    size = _small(scene.camera)
    shown = _linear(picture(scene, library, size=size, textures=pictures, effort=EFFORT))
    photo = _linear(cv2.resize(rgb, size, interpolation=cv2.INTER_AREA))
    gains = {}
    for object_id, mask in visible.items():
        seen = cv2.resize(mask.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0.9
        if np.count_nonzero(seen) >= SETTINGS.min_pixels:
            ratios = np.maximum(photo[seen], DARKEST) / np.maximum(shown[seen], DARKEST)
            gains[object_id] = float(np.clip(np.median(ratios), 1.0 / SETTINGS.max_gain, SETTINGS.max_gain))
    return gains


def brighten(
    materials: Materials, pictures: Pictures, gains: Mapping[str, float], sets: Sequence[Sequence[str]]
) -> tuple[dict[str, tuple[PhotoMaterial, ...]], dict[str, UInt8[np.ndarray, "_ _ 3"]]]:
    """Materials and pictures made brighter; things of a set keep the materials that they share.

    Args:
        materials: By object id.
        pictures: By name.
        gains: By object id; an object without one stays.
        sets: Ids of things that share materials.
    """
    shared = _equalise_gains(materials, gains, sets)
    made: dict[str, tuple[PhotoMaterial, ...]] = {}
    textures: dict[str, UInt8[np.ndarray, "_ _ 3"]] = {}
    for object_id, object_materials in materials.items():
        gain = shared[object_id]
        names: dict[str | None, str] = {}
        for name in sorted({m.texture for m in object_materials if m.texture is not None and m.texture in pictures}):
            texture = pictures[name]
            lit = texture if gain == 1.0 else np.rint(255.0 * _apply_gain(texture / 255.0, gain)).astype(np.uint8)
            names[name] = f"{name.rpartition('-')[0]}-{zlib.crc32(lit.tobytes()):08x}"  # ends in its own checksum
            textures[names[name]] = lit
        made[object_id] = tuple(
            replace(m, colour=_brighter(m.colour, gain), texture=names.get(m.texture, m.texture))
            for m in object_materials
        )
    return made, textures


def _equalise_gains(
    materials: Materials, gains: Mapping[str, float], sets: Sequence[Sequence[str]]
) -> dict[str, float]:
    """One gain for every object that no material of it makes brighter than surfaces are, the same for a set."""
    room = {i: min((_headroom(m) for m in object_materials), default=1.0) for i, object_materials in materials.items()}
    shared = {i: min(gains.get(i, 1.0), room[i]) for i in materials}
    for members in sets:
        logs = [np.log(gains[i]) for i in members if i in gains]
        most = min((room[i] for i in members if i in room), default=1.0)
        if logs:
            mean = float(np.exp(np.mean(logs)))
            shared |= {i: min(mean, most) for i in members if i in materials}
    return shared


def _headroom(material: PhotoMaterial) -> float:
    brightest = float(srgb_to_linear(np.asarray(material.colour, dtype=np.float64)).max())
    return max(1.0, MAX_LINEAR / max(brightest, DARKEST))


def _brighter(colour: tuple[float, float, float], gain: float) -> tuple[float, float, float]:
    if gain == 1.0:
        return colour
    red, green, blue = (float(c) for c in _apply_gain(np.asarray(colour, dtype=np.float64), gain))
    return red, green, blue


def _apply_gain(display: np.ndarray, gain: float) -> np.ndarray:
    return np.asarray(linear_to_srgb(np.clip(gain * srgb_to_linear(display), 0.0, 1.0)))


def _small(camera: Camera) -> tuple[int, int]:
    k = camera.intrinsics
    shrink = min(1.0, SETTINGS.longest_px / max(k.width, k.height))
    return max(8, round(k.width * shrink)), max(8, round(k.height * shrink))


def _linear(rgb: UInt8[np.ndarray, "h w 3"]) -> np.ndarray:
    return np.asarray(luminance(srgb_to_linear(rgb / 255.0)))
