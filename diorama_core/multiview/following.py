"""What happens to the cameras of further photos when the scene's own camera changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diorama_core.artefacts import FurtherPhoto
from diorama_core.scene.types import Camera

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
        return tuple(replace(p, camera=None, seen=()) for p in photos)
    return tuple(replace(p, camera=None if p.camera is None else _scaled(p.camera, scale)) for p in photos)


def _scale(before: Camera, after: Camera) -> float | None:
    """By how much the world was scaled between two cameras; None where it was something else."""
    size = float(np.linalg.norm(before.position))
    same_turn = np.abs(before.T_world_camera[:3, :3] - after.T_world_camera[:3, :3]).max() < ROUNDING
    if size < ROUNDING or not same_turn or before.intrinsics != after.intrinsics:
        return None
    scale = float(np.linalg.norm(after.position)) / size
    return scale if np.abs(after.position - scale * before.position).max() < ROUNDING * max(size, 1.0) else None


def _scaled(camera: Camera, scale: float) -> Camera:
    T = camera.T_world_camera.copy()
    T[:3, 3] *= scale
    return Camera(camera.intrinsics, T)
