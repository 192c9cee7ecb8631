"""Whether one object can sensibly carry another: a sofa does not stand on a mug."""

from __future__ import annotations

import numpy as np

from diorama_core.scene.types import Scene, SceneObject

MAX_FOOTPRINT_RATIO = 2.5
"""A child may stick out: a table lamp's shade over its table, a board over a trestle."""
MAX_VOLUME_RATIO = 6.0
"""Volumes of boxes stand for weights."""
THIN_M = 0.06
"""What is so flat weighs little: rugs, boards, cloths."""


def why_not_on(scene: Scene, child_id: str, parent_id: str) -> str:
    """Why an object should not stand on another one, in a sentence; empty where it may. Planes carry everything."""
    if not (scene.has_object(child_id) and scene.has_object(parent_id)):
        return ""
    child, parent = scene.object(child_id), scene.object(parent_id)
    if _footprint_m2(child) > MAX_FOOTPRINT_RATIO * _footprint_m2(parent):
        return f"{child.label} is much larger than {parent.label}"
    flat = float(np.min(child.size_m)) < THIN_M
    if not flat and float(np.prod(child.size_m)) > MAX_VOLUME_RATIO * float(np.prod(parent.size_m)):
        return f"{child.label} is much too heavy for {parent.label}"
    return ""


def _footprint_m2(item: SceneObject) -> float:
    corners = item.corners_world[:, :2]
    return float(np.prod(np.ptp(corners, axis=0)))
