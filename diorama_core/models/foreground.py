"""What stands out from the room: BiRefNet and MVANet (Zheng et al. 2024; Yu et al. 2024)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float32, UInt8

from diorama_core.models.images import IMAGENET_MEAN, IMAGENET_STD, enlarge, normalise, resize
from diorama_core.models.runtime import GraphNetwork

SIDE = 1024
WHITE = 255


@runtime_checkable
class ForegroundNetwork(Protocol):
    """Input: an upright RGB picture, eight bits. Output: where the foreground is in its pixels."""

    def mask(self, rgb: UInt8[np.ndarray, "h w 3"], threshold: float = 0.5) -> Bool[np.ndarray, "h w"]:
        """Where the probability of foreground is above the threshold."""
        ...


@dataclass(frozen=True)
class Foreground(GraphNetwork):
    """Input: an upright RGB picture, eight bits. Output: probability of foreground in its pixels.

    BiRefNet and MVANet share the signature: one picture of 1024 x 1024 in, one map of logits out.
    """

    weights: str = "birefnet"

    def probability(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, "h w"]:
        """0 to 1."""
        session = self.session
        last = session.outputs[-1]
        out = session.run({session.picture_input: self.pixels(rgb)}, {last: (..., SIDE, SIDE)}, gaps=True)
        logits = out[last].reshape(SIDE, SIDE).astype(np.float32)
        probability = 1.0 / (1.0 + np.exp(-np.clip(logits, -30, 30)))
        return enlarge(probability.astype(np.float32), rgb.shape[:2])

    def pixels(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, "1 3 1024 1024"]:
        """Stretched, ImageNet statistics."""
        return normalise(resize(rgb, (SIDE, SIDE)), IMAGENET_MEAN, IMAGENET_STD)

    def mask(self, rgb: UInt8[np.ndarray, "h w 3"], threshold: float = 0.5) -> Bool[np.ndarray, "h w"]:
        """Two passes: what the first one found is painted white, so that the second finds what it had overlooked
        (paper, supplement A).
        """
        first = self.probability(rgb) > threshold
        if not first.any():
            return first
        painted = rgb.copy()
        painted[first] = WHITE
        return first | (self.probability(painted) > threshold)
