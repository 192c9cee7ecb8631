"""Filling holes of pictures: LaMa and MI-GAN (Suvorov et al. 2022; Sargsyan et al. 2023)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.models.images import resize
from diorama_core.models.runtime import GraphNetwork

LAMA_SIDE = 512
_FEATHER_PX = 3


@runtime_checkable
class Filler(Protocol):
    """Input: an upright RGB picture, eight bits, and a mask that is true in the holes.

    Output: a picture of the same size; pixels outside the holes are as they were.
    """

    def fill(self, rgb: UInt8[np.ndarray, "h w 3"], hole: Bool[np.ndarray, "h w"]) -> UInt8[np.ndarray, "h w 3"]:
        """The picture with its holes filled."""
        ...


@dataclass(frozen=True)
class Lama(GraphNetwork):
    """LaMa at its 512 x 512: the picture is stretched there and only the holes are taken back."""

    weights: str = "lama"

    def fill(self, rgb: UInt8[np.ndarray, "h w 3"], hole: Bool[np.ndarray, "h w"]) -> UInt8[np.ndarray, "h w 3"]:
        """The picture with its holes filled."""
        if not hole.any():
            return rgb
        size = (LAMA_SIDE, LAMA_SIDE)
        image = resize(rgb, size).astype(np.float32).transpose(2, 0, 1)[None] / np.float32(255.0)
        small = cv2.resize(hole.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0
        feeds = {"image": image, "mask": small[None, None].astype(np.float32)}
        out = self.session.answer(feeds, (1, 3, *size))[0].transpose(1, 2, 0)
        filled = np.clip(out, 0, 255).round().astype(np.uint8)
        return merge(rgb, resize(filled, rgb.shape[:2]), hole)


@dataclass(frozen=True)
class Migan(GraphNetwork):
    """MI-GAN's whole pipeline: crops, fills and blends by itself, at any size."""

    weights: str = "mi-gan"

    def fill(self, rgb: UInt8[np.ndarray, "h w 3"], hole: Bool[np.ndarray, "h w"]) -> UInt8[np.ndarray, "h w 3"]:
        """The picture with its holes filled."""
        if not hole.any():
            return rgb
        keep = np.where(hole, 0, 255).astype(np.uint8)
        feeds = {"image": np.ascontiguousarray(rgb.transpose(2, 0, 1)[None]), "mask": keep[None, None]}
        out = self.session.answer(feeds, (1, 3, *hole.shape))
        return merge(rgb, out[0].transpose(1, 2, 0).astype(np.uint8), hole)


def merge(
    rgb: UInt8[np.ndarray, "h w 3"], filled: UInt8[np.ndarray, "h w 3"], hole: Bool[np.ndarray, "h w"]
) -> UInt8[np.ndarray, "h w 3"]:
    """The filling inside the holes, fading in over a few pixels there; the rest untouched."""
    inside = cv2.blur(hole.astype(np.float32), (2 * _FEATHER_PX + 1,) * 2)[..., None]
    share = np.where(hole[..., None], np.clip(2.0 * inside - 0.6, 0.0, 1.0), 0.0)
    mixed = share * filled.astype(np.float32) + (1.0 - share) * rgb.astype(np.float32)
    return np.where(hole[..., None], mixed.round(), rgb).astype(np.uint8)
