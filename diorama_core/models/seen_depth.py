"""What a geometry network says of a picture; apart from the networks, since the editor loads without them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float32, UInt8

from diorama_core.scene.types import Intrinsics


@dataclass(frozen=True, eq=False)
class SeenDepth:
    """What a geometry network says of a picture, in its pixels."""

    depth_m: Float32[np.ndarray, "h w"]
    normals_camera: Float32[np.ndarray, "h w 3"]
    intrinsics: Intrinsics
    log_sigma: Float32[np.ndarray, "h w"] | None = None
    """Deviation of the depth's logarithm where it is rough, and evidence beside other evidence; None where it may stand
    for measured depth."""
    scale_log_sigma: float = 0.0
    """Deviation of the logarithm of a rough depth's scale."""


@runtime_checkable
class GeometryNetwork(Protocol):
    """Input: an upright RGB picture, eight bits, and its intrinsics where they are known."""

    def predict(self, rgb: UInt8[np.ndarray, "h w 3"], intrinsics: Intrinsics | None) -> SeenDepth:
        """Depth, normals and intrinsics in the picture's pixels."""
        ...
