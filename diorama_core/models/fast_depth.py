"""FastDepth (Wofk et al., ICRA 2019), which learnt from NYU Depth v2: rough depth of a picture in 20 ms."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8

from diorama_core.models.images import resize
from diorama_core.models.runtime import SHARED_SESSIONS, SessionPool
from diorama_core.models.seen_depth import SeenDepth
from diorama_core.models.store import derive_graph
from diorama_core.scene.types import Intrinsics

SIDE_PX = 224
USUAL_FOCAL = 519 / 640
"""Focal length over width of the camera of NYU Depth v2, whose pictures it learnt from."""
LOG_SIGMA = 0.2
"""Deviation of the logarithm of depth in the right scale: its mean relative error is .17 in four photos that it did not
learn from."""
SCALE_LOG_SIGMA = 0.2
"""Deviation of the logarithm of the scale: the mean relative error in metres is .23 in eight photos."""
LEAST_M = 0.1
"""Eight bits have a depth of 0 too."""


@dataclass(frozen=True)
class FastDepth:
    """Input: an upright RGB picture, eight bits, stretched to a square. Output: metric depth, rough."""

    published: Path = field(repr=False)
    """The TensorFlow Lite file."""
    weights: str = "fast-depth"
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    def predict(self, rgb: UInt8[np.ndarray, "h w 3"], intrinsics: Intrinsics | None) -> SeenDepth:
        """Depth, for the usual camera where intrinsics are unknown; no normals.

        Raises:
            NetworkError: when the network fails.
            UnavailableError: when the file is no network that can be read.
        """
        height, width = rgb.shape[:2]
        k = intrinsics or Intrinsics(width, height, USUAL_FOCAL * width, USUAL_FOCAL * width, width / 2, height / 2)
        graph = derive_graph(f"fast-depth-{self.weights}", self._convert)
        pixels = resize(rgb, (SIDE_PX, SIDE_PX)).astype(np.float32).transpose(2, 0, 1)[None] / np.float32(255)
        shape = (1, 1, SIDE_PX, SIDE_PX)
        seen = self.pool.get(graph).run({"input": np.ascontiguousarray(pixels)}, {"output": shape})["output"]
        small = np.log(np.maximum(seen[0, 0], LEAST_M)) + np.log(k.fx / width / USUAL_FOCAL)
        depth = np.exp(cv2.resize(small.astype(np.float32), (width, height)))
        return SeenDepth(depth, np.zeros_like(rgb, np.float32), k, np.full_like(depth, LOG_SIGMA), SCALE_LOG_SIGMA)

    def _convert(self) -> bytes:
        from diorama_core.models.tflite_graph import onnx_graph  # with two libraries that nothing else needs

        return onnx_graph(self.published.read_bytes())
