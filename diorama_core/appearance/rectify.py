"""A flat rectangle of the scene seen head-on: the photo rectified at its own resolution."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.scene.types import Camera

MAX_SIDE_PX, MIN_SIDE_PX = 2048, 20
MIN_COSINE = 0.08
"""Rectangles seen more edge-on than this are smeared and not read."""
NEAR_M = 0.05


@dataclass(frozen=True, eq=False)
class Rectified:
    """A rectangle's picture, first row on top."""

    colours: Float32[np.ndarray, "h w 3"]
    """0 to 255, sRGB; meaningless where not seen."""
    seen: Bool[np.ndarray, "h w"]


def corners_in_photo(camera: Camera, corners_world: Float[np.ndarray, "4 3"]) -> Float[np.ndarray, "4 2"] | None:
    """Pixels of a rectangle's corners, clockwise from its top left; None where it is not seen from its front."""
    p = camera.to_camera(corners_world)
    if (p[:, 2] < NEAR_M).any():
        return None
    normal = np.cross(corners_world[3] - corners_world[0], corners_world[1] - corners_world[0])
    toward = camera.position - corners_world.mean(axis=0)
    cosine = float(normal @ toward) / max(float(np.linalg.norm(normal) * np.linalg.norm(toward)), 1e-12)
    return camera.project(corners_world) if cosine > MIN_COSINE else None


def rectified(
    rgb: UInt8[np.ndarray, "h w 3"], hidden: Bool[np.ndarray, "h w"], corners_px: Float[np.ndarray, "4 2"]
) -> Rectified | None:
    """The quadrilateral of the photo as a rectangle; None where it is too small to show anything.

    Args:
        rgb: The photo.
        hidden: Pixels that show something else.
        corners_px: The quadrilateral, clockwise from the rectangle's top left; may reach out of the photo.
    """
    sides = np.linalg.norm(np.roll(corners_px, -1, axis=0) - corners_px, axis=1)
    width, height = (round(min(max(sides[k], sides[k + 2]), MAX_SIDE_PX)) for k in (0, 1))
    if min(width, height) < MIN_SIDE_PX:
        return None
    target = np.array([[0, 0], [width, 0], [width, height], [0, height]], np.float32)
    M = cv2.getPerspectiveTransform(corners_px.astype(np.float32), target)
    # Texel centres are half a texel from the corner, as pixels' are.
    half = np.array([[1, 0, -0.5], [0, 1, -0.5], [0, 0, 1]])
    M = half @ M @ np.linalg.inv(half)
    colours = cv2.warpPerspective(rgb, M, (width, height), flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
    free = cv2.warpPerspective((~hidden).astype(np.uint8), M, (width, height), flags=cv2.INTER_NEAREST)
    return Rectified(colours.astype(np.float32), free.astype(bool))
