"""Cameras of pictures as they are stored, turned with the pictures that are shown upright."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import ExifTags, Image

from diorama_core.scene.types import Camera, Intrinsics

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
