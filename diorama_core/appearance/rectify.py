"""A flat rectangle of the scene seen head-on: the photo rectified at its own resolution."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.geometry.projection import NEAR_M
from diorama_core.scene.types import Camera

UNIT_SQUARE = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]])
MAX_SIDE_PX, MIN_SIDE_PX = 2048, 20
MIN_COSINE = 0.08
"""Rectangles seen more edge-on than this are smeared and not read."""


@dataclass(frozen=True, eq=False)
class Rectified:
    """A rectangle's picture, first row on top."""

    colours: Float32[np.ndarray, "h w 3"]
    """0 to 255, sRGB; meaningless where not seen."""
    seen: Bool[np.ndarray, "h w"]


def face_homography(camera: Camera, corners_world: Float[np.ndarray, "4 3"]) -> Float[np.ndarray, "3 3"] | None:
    """Where the photo shows a rectangle: `H @ (u, v, 1)` is a homogeneous pixel whose last coordinate is its depth.

    u goes from 0 to 1 to the right and v downward. Parts with a depth below `NEAR_M` are not before the camera.

    Args:
        camera: The photo's.
        corners_world: Clockwise from the rectangle's top left.

    Returns:
        None where the rectangle is not seen from its front, or lies wholly behind the camera.
    """
    normal = np.cross(corners_world[3] - corners_world[0], corners_world[1] - corners_world[0])
    toward = camera.position - corners_world.mean(axis=0)
    cosine = float(normal @ toward) / max(float(np.linalg.norm(normal) * np.linalg.norm(toward)), 1e-12)
    p = camera.to_camera(corners_world)
    if cosine <= MIN_COSINE or (p[:, 2] < NEAR_M).all():
        return None
    k = camera.intrinsics
    K = np.array([[k.fx, 0.0, k.cx], [0.0, k.fy, k.cy], [0.0, 0.0, 1.0]])
    return np.asarray(K @ np.stack([p[1] - p[0], p[3] - p[0], p[0]], axis=1))


def outline_px(H: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "n 2"]:
    """Corners of what is before the camera of a rectangle, in order; as seen, it may reach out of the photo."""
    corners = UNIT_SQUARE @ H.T
    kept = []
    for here, after in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if here[2] >= NEAR_M:
            kept.append(here)
        if (here[2] >= NEAR_M) != (after[2] >= NEAR_M):
            kept.append(here + (NEAR_M - here[2]) / (after[2] - here[2]) * (after - here))
    vertices = np.array(kept).reshape(-1, 3)
    return np.asarray(vertices[:, :2] / vertices[:, 2:])


def is_cut(H: Float[np.ndarray, "3 3"]) -> bool:
    """Whether a part of the rectangle is not before the camera."""
    return bool((UNIT_SQUARE @ H[2] < NEAR_M).any())


def rectify(
    rgb: UInt8[np.ndarray, "h w 3"], hidden: Bool[np.ndarray, "h w"], H: Float[np.ndarray, "3 3"]
) -> Rectified | None:
    """A rectangle that the photo shows; None where it is too small to show anything.

    Args:
        rgb: The photo.
        hidden: Pixels that show something else.
        H: Where it is in the photo (`face_homography`); it may reach out of it, and behind the camera.
    """
    size = _size_px(H, (rgb.shape[0], rgb.shape[1]))
    if min(size) < MIN_SIDE_PX:
        return None
    width, height = size
    # Texel centres are half a texel from the corner, as pixels' are.
    to_square = np.array([[1.0 / width, 0.0, 0.5 / width], [0.0, 1.0 / height, 0.5 / height], [0.0, 0.0, 1.0]])
    M = np.array([[1, 0, -0.5], [0, 1, -0.5], [0, 0, 1]]) @ H @ to_square
    inverse = cv2.WARP_INVERSE_MAP
    flags = cv2.INTER_CUBIC | inverse
    colours = cv2.warpPerspective(rgb, M, size, flags=flags, borderMode=cv2.BORDER_REPLICATE)
    free = cv2.warpPerspective((~hidden).astype(np.uint8), M, size, flags=cv2.INTER_NEAREST | inverse).astype(bool)
    depth = M[2, 0] * np.arange(width) + (M[2, 1] * np.arange(height) + M[2, 2])[:, None]
    return Rectified(colours.astype(np.float32), free & (depth >= NEAR_M))


def _size_px(H: Float[np.ndarray, "3 3"], shape: tuple[int, int]) -> tuple[int, int]:
    """Width and height of a rectangle at the photo's resolution, as what the photo shows of it goes on; 0 for nothing.

    It is that of the row and of the column that are seen at the highest resolution.
    """
    count = 32  # rows and columns by which the size is told
    middles = (np.arange(count) + 0.5) / count
    u, v = np.meshgrid(middles, middles)
    p = np.stack([u, v, np.ones_like(u)], axis=-1) @ H.T
    depth = np.maximum(p[..., 2], NEAR_M)
    pixels = p[..., :2] / depth[..., None]
    inside = (p[..., 2] >= NEAR_M) & (pixels >= 0).all(axis=-1) & (pixels < shape[::-1]).all(axis=-1)
    sizes = []
    for axis in (0, 1):
        along = np.linalg.norm(H[:2, axis] - pixels * H[2, axis], axis=-1) / depth
        count = inside.sum(axis=1 - axis)
        lines = (along * inside).sum(axis=1 - axis) / np.maximum(count, 1)
        sizes.append(min(round(float(lines.max())), MAX_SIDE_PX))
    return sizes[0], sizes[1]
