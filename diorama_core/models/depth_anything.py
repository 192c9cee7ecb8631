"""Depth Anything 3, the metric network (Lin et al. 2025): depth of one picture, for a camera of known focal length."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from jaxtyping import Float32, UInt8

from diorama_core.geometry.depth_grid import smooth_normals_camera
from diorama_core.models.depth import SeenDepth, at_size
from diorama_core.models.images import IMAGENET_MEAN, IMAGENET_STD, normalised, resized
from diorama_core.models.runtime import SHARED_SESSIONS, NetworkError, SessionPool
from diorama_core.scene.types import Intrinsics

SIDE = 504
"""Side of the square that the graph was traced with."""
CANONICAL_FOCAL_PX = 300.0
"""Focal length of the camera for which the network answers in metres."""
SKY = 0.5
"""Score from which a pixel shows the sky, which has no depth."""


@dataclass(frozen=True)
class DepthAnything3:
    """Canonical depth and sky of a picture that is stretched to a square; normals follow from the depth."""

    graph: Path = field(repr=False)
    weights: str = "da3-metric"
    usual_fov_rad: float = 1.05
    """Horizontal, of pictures whose camera is unknown."""
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    def predict(self, rgb: UInt8[np.ndarray, "h w 3"], intrinsics: Intrinsics | None) -> SeenDepth:
        """Depth and normals; without intrinsics a usual field of view is assumed.

        Raises:
            NetworkError: when the network fails, or tells nothing about the picture.
        """
        height, width = rgb.shape[:2]
        k = intrinsics or Intrinsics.from_fov(width, height, self.usual_fov_rad)
        session = self.pool.get(self.graph)
        side = session.side_px("image", SIDE)
        out = session.run({"image": self.pixels(rgb, side)}, {"depth": (1, 1, side, side), "sky": (1, 1, side, side)})
        square = k.scaled(side, side)
        # Metres for the focal length of the picture as the network saw it; stretched, its two sides have two.
        metres = out["depth"][0, 0] * np.float32((square.fx + square.fy) / 2 / CANONICAL_FOCAL_PX)
        depth = np.where((out["sky"][0, 0] < SKY) & (metres > 0), metres, 0.0).astype(np.float32)
        if not (depth > 0).any():
            raise NetworkError(self.graph, "the depth network sees no geometry in this picture; use --profile embedded")
        normals = smooth_normals_camera(depth, square).astype(np.float32)
        return at_size(SeenDepth(depth, normals, square), height, width, k)

    def pixels(self, rgb: UInt8[np.ndarray, "h w 3"], side: int = SIDE) -> Float32[np.ndarray, "1 3 side side"]:
        """Stretched to the square, ImageNet statistics."""
        return normalised(resized(rgb, (side, side)), IMAGENET_MEAN, IMAGENET_STD)
