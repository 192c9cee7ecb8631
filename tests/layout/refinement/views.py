"""Masks of small scenes as their camera sees them."""

from __future__ import annotations

import numpy as np

from diorama_core.artefacts import DetectedObject
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Camera, Intrinsics, Scene


def looking_down(width: int = 320, height: int = 240) -> Camera:
    """A camera at the south wall, 2 m up, that looks north and 30 degrees down."""
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    T = np.eye(4)
    T[:3, :3] = np.array([[1.0, 0.0, 0.0], [0.0, -s, c], [0.0, -c, -s]])
    T[:3, 3] = [0.0, -2.4, 2.0]
    return Camera(Intrinsics(width, height, 0.7 * width, 0.7 * width, width / 2, height / 2), T)


def seen_objects(scene: Scene, library: ShapeLibrary) -> tuple[DetectedObject, ...]:
    """Every object with the mask of what the camera sees of it."""
    assert scene.camera is not None
    view = MeshCaster([(library.mesh(o.shape_id), o.pose.matrix) for o in scene.objects]).buffers(scene.camera)
    return tuple(
        DetectedObject(o.id, o.category, o.label, (0.0, 0.0, 1.0, 1.0), view.instance == k, k, 1.0)
        for k, o in enumerate(scene.objects)
    )


def agreement(scene: Scene, objects: tuple[DetectedObject, ...], library: ShapeLibrary) -> float:
    """Mean intersection over union of the masks and what the camera sees."""
    now = {o.id: o.mask for o in seen_objects(scene, library)}
    pairs = [(o.mask, now[o.id]) for o in objects if o.mask.sum() >= 8]
    return float(np.mean([(a & b).sum() / (a | b).sum() for a, b in pairs]))
