"""Masks from boxes with finer edges: HQ-SAM (Ke et al. 2023), as its own exporter writes the graphs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from jaxtyping import Float, Float32, UInt8

from diorama_core.models.images import resize
from diorama_core.models.runtime import SHARED_SESSIONS, SessionPool
from diorama_core.models.segment_anything import MASK_SIDE, PromptedMask, fit_size, unpad

CORNERS = (2.0, 3.0)
"""Labels of the two points that are a box's upper left and lower right corner."""


@dataclass(frozen=True)
class HqSam:
    """The longer side becomes 1024; normalising and padding are inside the encoder's graph."""

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
