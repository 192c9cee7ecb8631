"""OWLv2: finds whatever words name (Minderer et al., Scaling open-vocabulary object detection, 2023)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float32, Int64, UInt8

from diorama_core.models.boxes import Detections, clip, corners, join
from diorama_core.models.clip import clip_tokens, load_tokenizer
from diorama_core.models.images import CLIP_MEAN, CLIP_STD, antialias, normalise, pad_square
from diorama_core.models.runtime import SHARED_SESSIONS, SessionPool
from diorama_core.progress import Progress

TOKENS = 16
SIDE = 960
MAX_PHRASES = 256
"""Phrases in one run; more are asked in turns, and each turn looks at the picture again."""


@runtime_checkable
class BoxDetector(Protocol):
    """Input: an upright RGB picture, eight bits, and phrases. Output: boxes, each with the phrase that fits best."""

    def detect(
        self,
        rgb: UInt8[np.ndarray, "h w 3"],
        phrases: Sequence[str],
        threshold: float,
        progress: Progress | None = None,
    ) -> Detections:
        """Boxes above the threshold, best first; stops when the progress is cancelled.

        Args:
            rgb: the picture, 0 to 255.
            phrases: what is looked for.
            threshold: least score, 0 to 1.
            progress: reports and cancellation.
        """
        ...


@dataclass(frozen=True)
class Owlv2:
    """Input: an upright RGB picture, eight bits, any size, and phrases such as "a photo of chair".

    Output: boxes in the picture's pixels, each with the phrase that fits best and its probability.
    """

    graph: Path = field(repr=False)
    tokenizer: Path = field(repr=False)
    weights: str = "owlv2"
    side: int = SIDE
    """Side of the square that the graph takes, where the graph itself does not say: a multiple of its patch."""
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    @cached_property
    def _tokenizer(self) -> Any:
        return load_tokenizer(self.tokenizer)

    def detect(
        self,
        rgb: UInt8[np.ndarray, "h w 3"],
        phrases: Sequence[str],
        threshold: float,
        progress: Progress | None = None,
    ) -> Detections:
        """Boxes above the threshold, best first; empty without phrases.

        Args:
            rgb: the picture, 0 to 255.
            phrases: what is looked for.
            threshold: least score, 0 to 1.
            progress: reports and cancellation.
        """
        height, width = rgb.shape[:2]
        progress = progress or Progress()
        pixels = self.pixels(rgb)
        logits, boxes = [], np.zeros((0, 4))
        for start in range(0, len(phrases), MAX_PHRASES):
            some = phrases[start : start + MAX_PHRASES]
            progress.report(start / len(phrases), f"Looking for {len(phrases)} kinds of objects")
            ids, mask = self.tokens(some)
            feeds = {"input_ids": ids, "attention_mask": mask, "pixel_values": pixels}
            session = self.pool.get(self.graph)
            out = session.run(feeds, {"logits": (1, None, len(some))}, progress=progress)
            session.check("pred_boxes", out.get("pred_boxes"), (1, out["logits"].shape[1], 4))
            logits.append(out["logits"][0])
            boxes = out["pred_boxes"][0].astype(np.float64)
        if not logits:
            return join([])
        joined = np.concatenate(logits, axis=1)
        labels = joined.argmax(axis=1)
        scores = 1.0 / (1.0 + np.exp(np.minimum(-joined[np.arange(len(joined)), labels].astype(np.float64), 700.0)))
        keep = np.flatnonzero(scores > threshold)
        keep = keep[np.argsort(-scores[keep], kind="stable")]
        in_pixels = corners(boxes)[keep] * max(height, width)  # boxes are relative to the padded square
        return Detections(clip(in_pixels, width, height), scores[keep], labels[keep])

    def pixels(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, "1 3 side side"]:
        """Padded to a square at the right and bottom, reduced with anti-aliasing, CLIP statistics."""
        side = self.pool.get(self.graph).side_px("pixel_values", self.side)
        return normalise(antialias(pad_square(rgb), side), CLIP_MEAN, CLIP_STD)

    def tokens(self, phrases: Sequence[str]) -> tuple[Int64[np.ndarray, "q 16"], Int64[np.ndarray, "q 16"]]:
        """Token ids, padded with zeros, and which of them are words."""
        return clip_tokens(self._tokenizer, phrases, TOKENS)
