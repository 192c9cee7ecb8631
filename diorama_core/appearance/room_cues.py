"""Cues of a room's own light: brightness of walls of one paint, where daylight enters; their settings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

from diorama_core.appearance.light import Shade
from diorama_core.artefacts import DetectedObject
from diorama_core.geometry.casting import cast_planes
from diorama_core.io.srgb import luminance, srgb_to_linear
from diorama_core.scene.types import Scene


@dataclass(frozen=True)
class AppearanceSettings:
    """What is read of the photo for the materials and the light of a whole scene."""

    step_px: int = 4
    """Every fourth pixel of the walls each way is looked at."""
    rim: float = 0.01
    """Share of the photo's longer side that is left out around every object, where its shadow lies."""
    min_cells: int = 60
    """Pixels looked at from which a wall has a colour."""
    same_paint: float = 0.03
    """Chromaticities of walls that differ by less are of one paint."""
    by_day: float = 0.4
    """Brightness of a window over that of what is seen in the middle, below which it is night."""
    mask_margin: float = 0.004
    """Widening of what stands before an object, as a share of the photo's longer side."""
    edges_px: tuple[int, ...] = (5, 3)
    """Sides of the squares by which masks are narrowed: their edges show something of what is beside."""
    min_inner: float = 0.3
    """Share of a mask that must be left of it."""
    brightness_rounds: int = 2
    """Times that the scene is shown and set against the photo."""
    longest_px: int = 200
    """Size of the picture of the scene for that."""
    min_pixels: int = 12
    """Pixels of it below which nothing is said of an object."""
    max_gain: float = 1.5
    """What is more than so much brighter or darker is another surface than the one that is seen."""


SETTINGS = AppearanceSettings()


def wall_shade(rgb: UInt8[np.ndarray, "h w 3"], objects: Sequence[DetectedObject], scene: Scene) -> Shade | None:
    """The walls of the paint that is seen most, as one material at several normals; None where only one is seen."""
    walls = [p for p in scene.architecture.by_role("wall") if p.is_seen]
    if scene.camera is None or len(walls) < 2:
        return None
    height, width = rgb.shape[:2]
    x, y = np.meshgrid(np.arange(0, width, SETTINGS.step_px), np.arange(0, height, SETTINGS.step_px))
    rays = scene.camera.rays(np.stack([x, y], axis=-1) + 0.5)
    which = cast_planes(scene.camera.position, rays, scene.architecture.planes, slack_m=0.0)[1]
    free = ~_object_mask(objects, (height, width))[y, x]
    linear = srgb_to_linear(rgb[y, x] / 255.0)
    number = {p.id: k for k, p in enumerate(scene.architecture.planes)}
    seen = {w.id: linear[free & (which == number[w.id])] for w in walls}
    medians = {w.id: np.median(seen[w.id], axis=0) for w in walls if len(seen[w.id]) >= SETTINGS.min_cells}
    if not medians:
        return None
    most = max(medians, key=lambda i: (len(seen[i]), i))
    alike = [w for w in walls if w.id in medians and _far(medians[w.id], medians[most]) < SETTINGS.same_paint]
    if len(alike) < 2:
        return None
    cells = np.array([len(seen[w.id]) for w in alike], dtype=float)
    light = np.array([max(float(luminance(medians[w.id])), 1e-4) for w in alike])
    return Shade(np.array([w.normal for w in alike]), light, cells / cells.sum())


def window_direction(
    rgb: UInt8[np.ndarray, "h w 3"], objects: Sequence[DetectedObject], scene: Scene
) -> Float[np.ndarray, "3"] | None:
    """Unit vector from what stands in the room to its largest window; None where none is seen by day."""
    mask_of = {o.id: o.mask for o in objects}
    grey = luminance(srgb_to_linear(rgb[:: SETTINGS.step_px, :: SETTINGS.step_px] / 255.0))
    windows = [o for o in scene.objects if o.category == "window" and o.id in mask_of]
    least = SETTINGS.by_day * float(np.median(grey))
    bright = [o for o in windows if _median(grey, mask_of[o.id][:: SETTINGS.step_px, :: SETTINGS.step_px]) >= least]
    others = [o.pose.position for o in scene.objects if o.category != "window"]
    if not bright or not others:
        return None
    largest = max(bright, key=lambda o: (float(np.prod(o.size_m[1:])), o.id))
    away = largest.pose.position - np.mean(others, axis=0)
    length = float(np.linalg.norm(away))
    return away / length if length > 1e-6 else None


def _median(grey: Float[np.ndarray, "h w"], mask: Bool[np.ndarray, "h w"]) -> float:
    return float(np.median(grey[mask])) if mask.any() else 0.0


def _far(a: Float[np.ndarray, "3"], b: Float[np.ndarray, "3"]) -> float:
    """Difference of two chromaticities."""
    return float(np.abs(a / max(float(a.sum()), 1e-6) - b / max(float(b.sum()), 1e-6)).max())


def _object_mask(objects: Sequence[DetectedObject], size: tuple[int, int]) -> Bool[np.ndarray, "h w"]:
    covered = np.zeros(size, np.uint8)
    for item in objects:
        covered |= item.mask.astype(np.uint8)
    radius = max(1, round(SETTINGS.rim * max(size)))
    return cv2.dilate(covered, np.ones((2 * radius + 1,) * 2, np.uint8)).astype(bool)
