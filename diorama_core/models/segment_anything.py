"""Masks from boxes: SAM 2.1, SAM 3's tracker, SlimSAM and, with finer edges, HQ-SAM (Ravi et al. 2024; Carion et al.
2025; Chen et al. 2023; Ke et al. 2023).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.models.images import IMAGENET_MEAN, IMAGENET_STD, enlarge, normalise, resize
from diorama_core.models.runtime import SHARED_SESSIONS, Dims, Session, SessionPool

SIDE, MASK_SIDE = 1024, 256
_MAP: Dims = (None, None, None, None)
CORNERS = (2.0, 3.0)
"""Labels of the two points that are a box's upper left and lower right corner, as HQ-SAM takes them."""


@dataclass(frozen=True, eq=False)
class PromptedMask:
    """The best of the three masks that a box gave."""

    mask: Bool[np.ndarray, "h w"]
    quality: float
    """The network's own estimate of the mask's intersection over union, 0 to 1."""


@runtime_checkable
class BoxSegmenter(Protocol):
    """Input: an upright RGB picture and boxes (x1, y1, x2, y2) in its pixels. Output: one mask per box."""

    def masks(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Float[np.ndarray, "n 4"]) -> Iterator[PromptedMask]:
        """Masks in the order of the boxes."""
        ...


@dataclass(frozen=True)
class Sam2:
    """SAM 2.1, and what has its graphs: the picture is stretched to a square."""

    encoder: Path = field(repr=False)
    decoder: Path = field(repr=False)
    weights: str = "sam2.1"
    side: int = SIDE
    """Side of the square."""
    mask_side: int = MASK_SIDE
    """Side of the masks that the decoder answers."""
    mean: tuple[float, float, float] = IMAGENET_MEAN
    std: tuple[float, float, float] = IMAGENET_STD
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    def masks(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Float[np.ndarray, "n 4"]) -> Iterator[PromptedMask]:
        """Masks in the order of the boxes; the picture is encoded once."""
        height, width = rgb.shape[:2]
        encoder, decoder = self.pool.get(self.encoder), self.pool.get(self.decoder)
        scale = (self.side / width, self.side / height)
        for out in _answers(encoder, decoder, self.pixels(rgb), boxes, scale, self.mask_side):
            yield _best(out, lambda logits: enlarge(logits, (height, width)))

    def pixels(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, "1 3 side side"]:
        """Stretched, with the network's statistics."""
        return normalise(resize(rgb, (self.side, self.side)), self.mean, self.std)


def sam3_tracker(encoder: Path, decoder: Path, weights: str = "sam3", pool: SessionPool = SHARED_SESSIONS) -> Sam2:
    """SAM 3's tracker: SAM 2.1's graphs for patches of 14 pixels and pictures from -1 to 1.

    Args:
        encoder: graph.
        decoder: graph.
        weights: identity of both.
        pool: of sessions.
    """
    half = (0.5, 0.5, 0.5)
    return Sam2(encoder, decoder, weights, side=1008, mask_side=288, mean=half, std=half, pool=pool)


@dataclass(frozen=True)
class SlimSam:
    """SlimSAM, the points-and-boxes export: the longer side becomes 1024, the rest is padded with zeros."""

    encoder: Path = field(repr=False)
    decoder: Path = field(repr=False)
    weights: str = "slimsam"
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    def masks(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Float[np.ndarray, "n 4"]) -> Iterator[PromptedMask]:
        """Masks in the order of the boxes; the picture is encoded once."""
        height, width = rgb.shape[:2]
        inner = fit_size(height, width)
        encoder, decoder = self.pool.get(self.encoder), self.pool.get(self.decoder)
        scale = (inner[1] / width, inner[0] / height)
        for out in _answers(encoder, decoder, self.pixels(rgb), boxes, scale, MASK_SIDE):
            yield _best(out, lambda logits: unpad(logits, inner, (height, width)))

    def pixels(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, "1 3 1024 1024"]:
        """Fitted, ImageNet statistics, then padded with zeros at the right and bottom."""
        height, width = fit_size(*rgb.shape[:2])
        square = np.zeros((1, 3, SIDE, SIDE), np.float32)
        square[..., :height, :width] = normalise(resize(rgb, (height, width)), IMAGENET_MEAN, IMAGENET_STD)
        return square


@dataclass(frozen=True)
class HqSam:
    """HQ-SAM, as its own exporter writes the graphs, which normalise and pad: the longer side becomes 1024."""

    encoder: Path = field(repr=False)
    decoder: Path = field(repr=False)
    weights: str = "hq-sam"
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    def masks(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Float[np.ndarray, "n 4"]) -> Iterator[PromptedMask]:
        """Masks in the order of the boxes; the picture is encoded once.

        Raises:
            NetworkError: when a graph is another network's, or fails.
        """
        height, width = rgb.shape[:2]
        inner = fit_size(height, width)
        encoder, decoder = self.pool.get(self.encoder), self.pool.get(self.decoder)
        shapes = dict.fromkeys(encoder.outputs, (1, None, None, None))
        features = encoder.run({encoder.first_input: self.pixels(rgb)}, shapes)
        first, *inside = (features[name] for name in encoder.outputs)
        scale = np.array([inner[1] / width, inner[0] / height] * 2)
        for box in np.asarray(boxes, float).reshape(-1, 4) * scale:
            out = decoder.run(
                {
                    "image_embeddings": first,
                    "interm_embeddings": np.stack(inside) if inside else np.zeros((0, 1, 1, 1, 1), np.float32),
                    "point_coords": box.reshape(1, 2, 2).astype(np.float32),
                    "point_labels": np.array([CORNERS], np.float32),
                    "mask_input": np.zeros((1, 1, MASK_SIDE, MASK_SIDE), np.float32),
                    "has_mask_input": np.zeros(1, np.float32),
                    "orig_im_size": np.array([height, width], np.float32),
                },
                {"iou_predictions": (1, None)},
            )
            count = out["iou_predictions"].size
            decoder.check("low_res_masks", out.get("low_res_masks"), (1, count, MASK_SIDE, MASK_SIDE), gaps=True)
            best = int(out["iou_predictions"][0].argmax())
            logits = unpad(out["low_res_masks"][0, best], inner, (height, width))
            yield PromptedMask(logits > 0.0, float(np.clip(out["iou_predictions"][0, best], 0.0, 1.0)))

    def pixels(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, "h2 w2 3"]:
        """Fitted to 1024 pixels, 0 to 255."""
        return resize(rgb, fit_size(*rgb.shape[:2])).astype(np.float32)


def fit_size(height: int, width: int) -> tuple[int, int]:
    """Height and width when the longer side is 1024."""
    scale = SIDE / max(height, width)
    return int(height * scale + 0.5), int(width * scale + 0.5)


def unpad(
    logits: Float32[np.ndarray, "256 256"], inner: tuple[int, int], size: tuple[int, int]
) -> Float32[np.ndarray, "h w"]:
    """Logits for the padded square, brought to the photo's size."""
    square = enlarge(logits, (SIDE, SIDE))
    return enlarge(square[: inner[0], : inner[1]], size)


def _answers(
    encoder: Session,
    decoder: Session,
    pixels: Float32[np.ndarray, "1 3 side side"],
    boxes: Float[np.ndarray, "n 4"],
    scale_xy: tuple[float, float],
    mask_side: int,
) -> Iterator[dict[str, np.ndarray]]:
    """The decoder's outputs for every box, scaled from the picture to the network's input; the picture goes in once."""
    features = encoder.run({"pixel_values": pixels}, dict.fromkeys(encoder.outputs, _MAP))
    for box in np.asarray(boxes, np.float32).reshape(-1, 4) * np.array(scale_xy * 2, np.float32):
        prompt: dict[str, np.ndarray] = {
            "input_points": np.zeros((1, 1, 0, 2), np.float32),
            "input_labels": np.zeros((1, 1, 0), np.int64),
            "input_boxes": box[None, None],
        }
        feeds = {name: value for name, value in {**features, **prompt}.items() if name in decoder.inputs}
        out = decoder.run(feeds, {"iou_scores": (..., None)})
        decoder.check(
            "pred_masks", out.get("pred_masks"), (..., out["iou_scores"].size, mask_side, mask_side), gaps=True
        )
        yield out


def _best(out: dict[str, np.ndarray], to_picture: Callable[[np.ndarray], np.ndarray]) -> PromptedMask:
    scores = out["iou_scores"].reshape(-1)
    best = int(scores.argmax())
    logits = out["pred_masks"].reshape(len(scores), *out["pred_masks"].shape[-2:])[best]
    return PromptedMask(to_picture(logits) > 0.0, float(np.clip(scores[best], 0.0, 1.0)))
