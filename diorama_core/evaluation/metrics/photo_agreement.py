"""How well a scene agrees with the picture it was made from: projected boxes against observed ones, and sizes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import DetectedObject, ObjectGeometry
from diorama_core.geometry.projection import box_iou, visible_bounds
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Camera, Scene

PLAUSIBLE_M: dict[str, tuple[str, float, float]] = {
    "chair": ("height", 0.7, 1.2),
    "office chair": ("height", 0.7, 1.2),
    "table": ("height", 0.35, 1.1),
    "coffee table": ("height", 0.35, 1.1),
    "sofa": ("width", 1.2, 3.0),
}
"""Ranges that a person would call normal, by category."""


@dataclass(frozen=True)
class Agreement:
    """One object's agreement with its observed box, as intersection over union."""

    object_id: str
    category: str
    cuboid_iou: float
    """Projected metric cuboid against the given box."""
    shape_iou: float
    """Projected posed shape, before the layout optimiser, against the given box; 0 when it has no shape."""
    final_iou: float
    """Intersection over union after the layout optimiser."""
    size_m: tuple[float, float, float]
    plausible: bool
    """Whether its size lies in the category's range; True for categories without one."""


def agreement(
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    observed: Scene,
    final: Scene,
    library: ShapeLibrary,
) -> tuple[Agreement, ...]:
    """Compare every detected object's cuboid and posed shape with its box; missing ones count as 0.

    Args:
        objects: what was found in the photo, with masks.
        geometry: the objects' cuboids, the camera, and what supports what.
        observed: the scene before its layout.
        final: after it.
        library: where shapes come from.
    """
    cuboids = {c.object_id: c for c in geometry.cuboids}
    rows = []
    for item in objects:
        cuboid = cuboids.get(item.id)
        corners = None if cuboid is None else cuboid.corners_world
        depth, width, height = final.object(item.id).size_m if final.has_object(item.id) else (0.0, 0.0, 0.0)
        size = (float(depth), float(width), float(height))
        rows.append(
            Agreement(
                object_id=item.id,
                category=item.category,
                cuboid_iou=0.0 if corners is None else _cuboid_iou(geometry.camera, corners, item.box),
                shape_iou=shape_iou(observed, item.id, item.box, library),
                final_iou=shape_iou(final, item.id, item.box, library),
                size_m=size,
                plausible=_plausible(item.category, size),
            )
        )
    return tuple(rows)


def shape_iou(scene: Scene, object_id: str, box: tuple[float, float, float, float], library: ShapeLibrary) -> float:
    """Intersection over union of the box with the bounds of the posed shape's visible part; 0 without a shape.

    Args:
        scene: as it is.
        object_id: of the object.
        box: of the photo: x1, y1, x2, y2.
        library: where shapes come from.
    """
    if scene.camera is None or not scene.has_object(object_id):
        return 0.0
    item = scene.object(object_id)
    pose = PoseBatch(item.pose.R_world_object[None], item.pose.position[None], item.pose.scale[None])
    bounds = ShapeCaster(library.mesh(item.shape_id)).bounds_px(scene.camera, pose)[0]
    return 0.0 if np.isnan(bounds).any() else float(box_iou(bounds, np.array(box)))


def _cuboid_iou(camera: Camera, corners_world: Float[np.ndarray, "8 3"], box: object) -> float:
    bounds, visible = visible_bounds(camera.to_camera(corners_world)[None], camera.intrinsics)
    return float(box_iou(bounds[0], np.array(box))) if visible[0] else 0.0


def _plausible(category: str, size_m: tuple[float, float, float]) -> bool:
    if category not in PLAUSIBLE_M:
        return True
    side, low, high = PLAUSIBLE_M[category]
    value = size_m[2] if side == "height" else size_m[1]
    return low <= value <= high
