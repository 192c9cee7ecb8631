"""What a camera sees of one posed shape, pixel by pixel: which slot, where on its texture, and how it is turned."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Bool, Float, Float32, Int8, Int32

from diorama_core.geometry.ray_scene import RayScene
from diorama_core.geometry.vectors import dot, face_normals, facing, unit
from diorama_core.library.photo_materials import metric_uv, with_own_corners
from diorama_core.library.slots import Slot, place_vertices
from diorama_core.render.raycast import PinholeView
from diorama_core.scene.types import Camera, Pose


@dataclass(frozen=True, eq=False)
class SurfaceView:
    """A window of the photo, every `step`-th pixel of it."""

    left: int
    top: int
    step: int
    slot: Int8[np.ndarray, "h w"]
    """Index of the slot; -1 where the shape is not met."""
    uv_m: Float32[np.ndarray, "h w 2"]
    """Texture coordinates in metres of the shape at scale 1."""
    normals_world: Float32[np.ndarray, "h w 3"]
    """Unit, toward the camera."""
    cosine: Float32[np.ndarray, "h w"]
    """Cosine of the angle between the normal and the direction to the camera; 0 where the shape is not met."""

    def crop(self, image: np.ndarray) -> np.ndarray:
        """These pixels of a picture or a mask of the photo's size."""
        height, width = self.slot.shape
        rows = slice(self.top, self.top + height * self.step, self.step)
        return np.asarray(image[rows, self.left : self.left + width * self.step : self.step])


def surface_view(
    parts: trimesh.Scene, slots: tuple[Slot, ...], pose: Pose, camera: Camera, mask: Bool[np.ndarray, "h w"]
) -> SurfaceView | None:
    """The shape in its pose, seen within the bounds of its mask; None where the mask is empty.

    Args:
        parts: The shape.
        slots: Its slots (`slots_of`).
        pose: Where it is.
        camera: The photo's.
        mask: The object in the photo.
    """
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return None
    top, bottom, left, right = int(rows[0]), int(rows[-1]) + 1, int(columns[0]), int(columns[-1]) + 1
    most = 90_000  # pixels; of larger objects every second, third ... is looked at
    step = max(1, int(np.ceil(np.sqrt((bottom - top) * (right - left) / most))))
    x, y = np.meshgrid(np.arange(left, right, step) + 0.5, np.arange(top, bottom, step) + 0.5)
    vertices, faces, uv, owner = _concatenate_parts(with_own_corners(parts, slots), slots)
    world = pose.apply(vertices).astype(np.float32)
    rays = PinholeView(camera).rays(np.stack([x, y], axis=-1))
    hits = RayScene(world, faces).first_hits(rays)
    is_hit, triangle = hits.is_hit, hits.triangle[hits.is_hit]
    weights = np.concatenate([1 - hits.barycentric.sum(axis=-1, keepdims=True), hits.barycentric], axis=-1)[is_hit]
    slot = np.full(is_hit.shape, -1, np.int8)
    slot[is_hit] = owner[triangle]
    uv_m = np.zeros((*is_hit.shape, 2), np.float32)
    uv_m[is_hit] = np.einsum("nk,nkc->nc", weights, uv[faces[triangle]])
    normals = np.zeros((*is_hit.shape, 3), np.float32)
    normals[is_hit] = facing(face_normals(world, faces)[triangle], rays[is_hit][:, 3:])
    cosine = np.clip(-dot(normals, unit(rays[..., 3:])), 0.0, 1.0).astype(np.float32)
    return SurfaceView(left, top, step, slot, uv_m, normals, cosine)


def _concatenate_parts(
    parts: trimesh.Scene, slots: tuple[Slot, ...]
) -> tuple[Float[np.ndarray, "n 3"], Int32[np.ndarray, "m 3"], Float32[np.ndarray, "n 2"], Int8[np.ndarray, "m"]]:
    """Vertices, faces, texture coordinates in metres, and the slot of every face."""
    vertices, faces, uv, owner, start = [], [], [], [], 0
    for index, slot in enumerate(slots):
        for name in slot.geometry:
            points = place_vertices(parts, name)
            vertices.append(points)
            faces.append(np.asarray(parts.geometry[name].faces) + start)
            uv.append(metric_uv(parts, slot, name))
            owner.append(np.full(len(faces[-1]), index, np.int8))
            start += len(points)
    return (
        np.concatenate(vertices),
        np.concatenate(faces).astype(np.int32),
        np.concatenate(uv).astype(np.float32),
        np.concatenate(owner),
    )
