"""Cameras of further photos that change with something else: with the scene's own camera, or with pictures that are
shown upright.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from PIL import ExifTags, Image

from diorama_core.artefacts import FurtherPhoto
from diorama_core.scene.types import Camera, Intrinsics

ROUNDING = 1e-6


def following(photos: Sequence[FurtherPhoto], before: Camera | None, after: Camera | None) -> tuple[FurtherPhoto, ...]:
    """The photos after an edit of the scene.

    A scene that was scaled about the world's origin takes them along. One that has another camera was built anew: their
    cameras and objects are those of another scene, and they have to join again.
    """
    if before == after or not photos:
        return tuple(photos)
    scale = None if before is None or after is None else _scale(before, after)
    if scale is None:
        return tuple(replace(p, camera=None, seen=(), T_world_sphere=None) for p in photos)
    return tuple(_scale_photo(p, scale) for p in photos)


def _scale_photo(photo: FurtherPhoto, scale: float) -> FurtherPhoto:
    camera, T = photo.camera, photo.T_world_sphere
    if camera is not None:
        camera = Camera(camera.intrinsics, _scale_translation(camera.T_world_camera, scale))
    return replace(photo, camera=camera, T_world_sphere=None if T is None else _scale_translation(T, scale))


def _scale(before: Camera, after: Camera) -> float | None:
    """By how much the world was scaled between two cameras; None where it was something else."""
    size = float(np.linalg.norm(before.position))
    same_turn = np.abs(before.T_world_camera[:3, :3] - after.T_world_camera[:3, :3]).max() < ROUNDING
    if size < ROUNDING or not same_turn or before.intrinsics != after.intrinsics:
        return None
    scale = float(np.linalg.norm(after.position)) / size
    return scale if np.abs(after.position - scale * before.position).max() < ROUNDING * max(size, 1.0) else None


def _scale_translation(T: Float[np.ndarray, "4 4"], scale: float) -> Float[np.ndarray, "4 4"]:
    T = T.copy()
    T[:3, 3] *= scale
    return T


QUARTERS = {3: 2, 6: 1, 8: 3}
"""Clockwise quarter turns that make a stored picture upright, by the tag's value; mirrored ones have no camera."""


def quarters_of(path: Path) -> int:
    """Clockwise quarter turns that a picture's header asks for; 0 where it has no header."""
    try:
        with Image.open(path, formats=("JPEG", "PNG", "WEBP", "TIFF", "MPO", "HEIF")) as picture:
            return QUARTERS.get(int(picture.getexif().get(ExifTags.Base.Orientation, 1)), 0)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return 0


def upright_camera(camera: Camera, quarters: int) -> Camera:
    """The camera of a picture after clockwise quarter turns: the view is the same, its axes and size are turned."""
    for _ in range(quarters % 4):
        k = camera.intrinsics
        turned = Intrinsics(k.height, k.width, k.fy, k.fx, k.height - k.cy, k.cx)
        T = camera.T_world_camera.copy()
        T[:3, :3] = T[:3, :3] @ np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        camera = Camera(turned, T)
    return camera
