"""360 degree photos of a furnished room, and what each pixel shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float, Int32, UInt8

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import SceneError
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.geometry.sphere import directions
from diorama_core.scene.types import Camera, Intrinsics, Scene, SceneObject, yaw_rotation
from diorama_core.synthesis.truth import Studio

SIDES = np.concatenate([np.eye(3), -np.eye(3)])
"""Directions in which the faces of a cube are seen from its middle."""
OVERLAP = 1.05
"""Half width of a face at unit depth: a little more than the cube's, so that no seam is read beyond a border."""
SMALLEST = 1e-4
"""Share of the picture: smaller things are not marked."""
HEIGHTS_M, TILT_RAD, CLEARANCE_M = (1.25, 1.6), 0.026, 0.3
"""Of a tripod: lowest and highest, deviation of its tilt, and from walls and furniture."""
FINER = 1.2
"""Pixels of a face over those that the map has in its middle."""


@dataclass(frozen=True, eq=False)
class SphereTruth:
    """A 360 degree photo of a room and its truth."""

    rgb: UInt8[np.ndarray, "h w 3"]
    object_ids: Int32[np.ndarray, "h w"]
    """Index into the room's objects; -1 on the room itself."""
    T_world_sphere: Float[np.ndarray, "4 4"]

    def boxes(self, objects: Sequence[SceneObject]) -> dict[int, LabelledBox]:
        """Boxes of the objects that a person would mark, by index; across the seam they reach beyond the right side.

        Args:
            objects: of the room.
        """
        height, width = self.object_ids.shape
        boxes = {}
        for index, item in enumerate(objects):
            mask = self.object_ids == index
            if mask.sum() < SMALLEST * width * height:
                continue
            rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
            gap = int(np.diff(columns, append=columns[0] + width).argmax())
            left, right = int(columns[(gap + 1) % len(columns)]), int(columns[gap]) + 1
            right += width if right <= left else 0
            box = (float(left), float(rows[0]), float(right), float(rows[-1] + 1))
            boxes[index] = LabelledBox(box, item.category, item.label)
        return boxes


def sphere_place(scene: Scene, seed: int) -> Float[np.ndarray, "4 4"]:
    """Place of a tripod for a 360 degree photo: in the free place nearest the middle, not quite level.

    Args:
        scene: the room.
        seed: of the camera's height, turn and tilt.

    Raises:
        SceneError: there is no free place.
    """
    rng = np.random.default_rng((seed, 360))
    floor = scene.architecture.floor
    if floor is None:
        raise SceneError("a room without a floor cannot be photographed")
    outline, height_m = floor.polygon[:, :2], float(rng.uniform(*HEIGHTS_M))
    low, high = outline.min(axis=0), outline.max(axis=0)
    grid = np.stack(np.meshgrid(*(np.arange(a, b, 0.1) for a, b in zip(low, high, strict=True))), axis=-1).reshape(
        -1, 2
    )
    eyes = np.column_stack([grid, np.full(len(grid), height_m)])
    free = is_in_polygon(grid, outline)
    for plane in scene.architecture.planes:
        free &= eyes @ plane.normal - plane.offset > CLEARANCE_M * (plane.role != "floor")
    for item in scene.objects:
        if item.category != "rug" and item.corners_world[:, 2].min() < height_m:
            local = np.abs((eyes - item.pose.position) @ item.pose.R_world_object)
            free &= ~(local[:, :2] < item.size_m[:2] / 2 + CLEARANCE_M).all(axis=1)
    if not free.any():
        raise SceneError("no place for a tripod was found in the room; it is too full")
    T = np.eye(4)
    T[:3, 3] = eyes[int(np.where(free, np.linalg.norm(grid - (low + high) / 2, axis=1), np.inf).argmin())]
    tilt = rotation_from_vector(np.array([*rng.normal(0.0, TILT_RAD, 2), 0.0]))
    T[:3, :3] = yaw_rotation(rng.uniform(0.0, 2 * np.pi)) @ tilt
    return T


def sphere_photo(studio: Studio, T_world_sphere: Float[np.ndarray, "4 4"], width: int = 2048) -> SphereTruth:
    """A 360 degree photo of a room (axes as in `geometry.sphere`).

    Args:
        studio: the room.
        T_world_sphere: where it is taken, and how it is turned.
        width: pixels; the picture is half as high.
    """
    away = directions(width)
    side = round(FINER * width / np.pi)
    focal = 0.5 * side / OVERLAP
    rgb, ids = np.zeros((*away.shape[:2], 3), np.uint8), np.full(away.shape[:2], -1, np.int32)
    face_of = np.argmax(away @ SIDES.T, axis=-1)
    for number, ahead in enumerate(SIDES):
        down = np.array([0.0, 1.0, 0.0]) if ahead[2] else np.array([0.0, 0.0, -1.0])
        R = np.column_stack([np.cross(down, ahead), down, ahead])
        T = T_world_sphere.copy()
        T[:3, :3] = T[:3, :3] @ R
        camera = Camera(Intrinsics(side, side, focal, focal, side / 2, side / 2), T)
        picture, shown = studio.photograph(camera, (side, side))
        p = away @ R
        here = face_of == number
        at = (focal * p[..., :2] / np.where(here, p[..., 2], 1.0)[..., None] + side / 2).astype(np.float32)
        seen = cv2.remap(picture, at - 0.5, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        x, y = np.clip(at.astype(int), 0, side - 1).transpose(2, 0, 1)
        rgb[here], ids[here] = seen[here], shown[y, x][here]
    return SphereTruth(rgb, ids, T_world_sphere)
