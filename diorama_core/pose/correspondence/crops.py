"""One object cut out of the picture as its templates are drawn: centred, square, gray, seen straight on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int, UInt8

from diorama_core.render.templates import TemplateGrid, Templates
from diorama_core.scene.types import Camera
from diorama_core.scene.values import ArrayValue

PATCHES = 16
"""Patches along each side of a view."""
FILL = 0.72
"""Share of the crop's side that the object's box takes, as the templates' shapes do on average."""
_LARGE_PX = 200
_SURE_COVER = 0.4
"""A patch belongs to the object when at least this share of it does."""


@dataclass(frozen=True, eq=False)
class GrayView(ArrayValue):
    """Square pictures of one shape or object: what patch features are computed from."""

    gray: UInt8[np.ndarray, "v h h"]
    mask: Bool[np.ndarray, "v h h"]
    normals: Float32[np.ndarray, "v g g 3"]
    """Camera frame, toward the viewer; zero where unknown and off the object; as large as the pictures or smaller."""

    @cached_property
    def patch_cover(self) -> Float[np.ndarray, "v p"]:
        """Share of each of the 16 x 16 patches that the object covers."""
        return pool_patches(self.mask.astype(np.float32)[..., None])[..., 0]

    @cached_property
    def foreground(self) -> Bool[np.ndarray, "v p"]:
        """Patches that belong to the object."""
        return self.patch_cover >= _SURE_COVER


@dataclass(frozen=True, eq=False)
class PatchCrop(ArrayValue):
    """The picture of one object, turned so that it is seen straight on, with what was measured in it."""

    view: GrayView
    R_camera_crop: Float[np.ndarray, "3 3"]
    """From the crop's camera, which looks at the object, to the photo's."""
    focal_px: float
    """In pixels of the crop."""
    points_camera: Float32[np.ndarray, "p 3"]
    """Measured point under the middle of every patch, photo camera; NaN where unknown."""


def pool_patches(image: Float32[np.ndarray, "v h h c"]) -> Float32[np.ndarray, "v p c"]:
    """Means over 16 x 16 patches, row by row."""
    v, h, _, c = image.shape
    step = h // PATCHES
    return image.reshape(v, PATCHES, step, PATCHES, step, c).mean(axis=(2, 4)).reshape(v, PATCHES**2, c)


def patch_pixels(size_px: int) -> Int[np.ndarray, "p 2"]:
    """The pixel (x, y) in the middle of every patch, row by row."""
    step = size_px // PATCHES
    centre = np.arange(PATCHES) * step + step // 2
    x, y = np.meshgrid(centre, centre)
    return np.stack([x.ravel(), y.ravel()], axis=1)


def template_view(templates: Templates) -> GrayView:
    """All views of a shape; the normals of large ones at half their size, as patches are means over many pixels."""
    step = 2 if templates.grid.size_px >= _LARGE_PX else 1
    normals = np.stack([templates.normals_camera(k)[::step, ::step] for k in range(len(templates))])
    return GrayView(templates.gray, templates.mask, normals.astype(np.float32))


def crop_object(
    rgb: UInt8[np.ndarray, "h w 3"],
    mask: Bool[np.ndarray, "h w"],
    box: tuple[float, float, float, float],
    depth_m: Float32[np.ndarray, "h w"],
    normals_world: Float32[np.ndarray, "h w 3"],
    camera: Camera,
    grid: TemplateGrid,
) -> PatchCrop:
    """Resample an object into a camera of its own that looks straight at it.

    Args:
        rgb: The photo.
        mask: The object's pixels.
        box: Its box in pixels.
        depth_m: Depth of the photo, 0 where unknown.
        normals_world: Normals of the photo, 0 where unknown.
        camera: The photo's camera.
        grid: How the templates are seen: the crop has their size.
    """
    R = _camera_towards(camera, box)
    size = grid.size_px
    focal = _focal(camera, box, R, size)
    centres = np.arange(size) + 0.5
    x, y = np.meshgrid((centres - size / 2) / focal, (centres - size / 2) / focal)
    rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ R.T
    k = camera.intrinsics
    ahead = np.maximum(rays[..., 2], 1e-6)
    u = (k.fx * rays[..., 0] / ahead + k.cx - 0.5).astype(np.float32)
    v = (k.fy * rays[..., 1] / ahead + k.cy - 0.5).astype(np.float32)
    seen = cv2.remap(mask.astype(np.uint8), u, v, cv2.INTER_NEAREST) > 0
    gray = cv2.remap(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY), u, v, cv2.INTER_LINEAR)
    depth = cv2.remap(np.nan_to_num(depth_m, posinf=0.0), u, v, cv2.INTER_NEAREST)
    world = cv2.remap(np.nan_to_num(normals_world), u, v, cv2.INTER_NEAREST)
    normals = world @ camera.T_camera_world[:3, :3].T @ R
    known = seen & (depth > 0)
    points = rays / ahead[..., None] * depth[..., None]
    at = patch_pixels(size)
    middle = np.where(known[at[:, 1], at[:, 0], None], points[at[:, 1], at[:, 0]], np.nan)
    view = GrayView(
        np.where(seen, np.maximum(gray, 1), 0).astype(np.uint8)[None],
        seen[None],
        np.where(known[..., None], normals, 0.0).astype(np.float32)[None],
    )
    return PatchCrop(view, R, float(focal), middle.astype(np.float32))


def _camera_towards(camera: Camera, box: tuple[float, float, float, float]) -> Float[np.ndarray, "3 3"]:
    """The camera turned toward the middle of a box, without roll against the world: columns are its axes."""
    k = camera.intrinsics
    middle = np.array([(0.5 * (box[0] + box[2]) - k.cx) / k.fx, (0.5 * (box[1] + box[3]) - k.cy) / k.fy, 1.0])
    forward = middle / np.linalg.norm(middle)
    down = camera.T_camera_world[:3, :3] @ np.array([0.0, 0.0, -1.0])
    right = np.cross(down, forward)
    if np.linalg.norm(right) < 1e-3:
        right = np.array([1.0, 0.0, 0.0]) - forward[0] * forward
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(forward, right), forward], axis=1)


def _focal(camera: Camera, box: tuple[float, float, float, float], R: np.ndarray, size: int) -> float:
    k = camera.intrinsics
    x1, y1, x2, y2 = box
    corners = np.array([[x, y] for x in (x1, x2) for y in (y1, y2)])
    rays = np.column_stack([(corners[:, 0] - k.cx) / k.fx, (corners[:, 1] - k.cy) / k.fy, np.ones(4)]) @ R
    flat = rays[:, :2] / np.maximum(rays[:, 2:], 1e-3)
    return FILL * size / max(float(np.ptp(flat, axis=0).max()), 1e-4)
