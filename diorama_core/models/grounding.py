"""LLMDet: finds whatever words name (Fu et al., LLMDet, 2025), with the graph of MM Grounding DINO."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float32, Int64, UInt8
from scipy.special import expit

from diorama_core.models.boxes import Detections, clip, corners, join
from diorama_core.models.clip import load_tokenizer
from diorama_core.models.images import IMAGENET_MEAN, IMAGENET_STD, normalise, resize
from diorama_core.models.runtime import SHARED_SESSIONS, NetworkError, SessionPool
from diorama_core.progress import Progress

TOKENS = 256
"""Tokens of one prompt; phrases that do not fit are asked in another run, which looks at the picture again."""
SIDE = 960
"""Side of the square whose upper left part holds the picture."""


@dataclass(frozen=True)
class Prompt:
    """Phrases, each followed by a full stop, as tokens."""

    ids: tuple[int, ...]
    phrases: tuple[int, ...]
    """Indices of the phrases."""
    spans: tuple[slice, ...]
    """Where each phrase's tokens are."""


@dataclass(frozen=True)
class GroundingDino:
    """Input: an upright RGB picture, eight bits, any size, and phrases such as "coffee table".

    Output: boxes in the picture's pixels, each with the phrase that fits best and its probability, the mean over the
    phrase's tokens.
    """

    graph: Path = field(repr=False)
    tokenizer: Path = field(repr=False)
    weights: str = "llmdet"
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

        Raises:
            NetworkError: when the graph or the tokenizer is another network's, or fails.
            Cancelled: on request.
        """
        progress = progress or Progress()
        session = self.pool.get(self.graph)
        side = session.side_px("pixel_values", SIDE)
        pixels, shown = self.pixels(rgb, side)
        detections = []
        prompts = self.prompts(phrases)
        for done, prompt in enumerate(prompts):
            progress.report(done / len(prompts), f"Looking for {len(phrases)} kinds of objects")
            ids = np.zeros((1, TOKENS), np.int64)
            ids[0, : len(prompt.ids)] = prompt.ids
            words = (np.arange(TOKENS)[None] < len(prompt.ids)).astype(np.int64)
            feeds = {"pixel_values": pixels, "pixel_mask": shown, "input_ids": ids, "attention_mask": words}
            # Tokens beyond the prompt have the logit of minus infinity.
            out = session.run(feeds, {"logits": (1, None, TOKENS)}, gaps=True, progress=progress)
            session.check("pred_boxes", out.get("pred_boxes"), (1, out["logits"].shape[1], 4))
            detections.append(
                _likely_detections(out["logits"][0], out["pred_boxes"][0], prompt, threshold, rgb.shape[:2])
            )
        every = join(detections)
        return every.rows(np.argsort(-every.scores, kind="stable"))

    def pixels(
        self, rgb: UInt8[np.ndarray, "h w 3"], side: int = SIDE
    ) -> tuple[Float32[np.ndarray, "1 3 s s"], Int64[np.ndarray, "1 s s"]]:
        """The picture fitted into the upper left of a square, ImageNet statistics, and where it is."""
        height, width = rgb.shape[:2]
        scale = side / max(height, width)
        size = (max(1, round(height * scale)), max(1, round(width * scale)))
        square, shown = np.zeros((1, 3, side, side), np.float32), np.zeros((1, side, side), np.int64)
        square[..., : size[0], : size[1]] = normalise(resize(rgb, size), IMAGENET_MEAN, IMAGENET_STD)
        shown[:, : size[0], : size[1]] = 1
        return square, shown

    def prompts(self, phrases: Sequence[str]) -> tuple[Prompt, ...]:
        """As few prompts as hold all phrases.

        Raises:
            NetworkError: when the tokenizer lacks the marks that part phrases.
        """
        marks = [self._tokenizer.token_to_id(mark) for mark in ("[CLS]", ".", "[SEP]")]
        if None in marks:
            raise NetworkError(self.tokenizer, "this is no tokenizer of this network; convert it again")
        begin, stop, end = marks
        rows = [tuple(self._tokenizer.encode(p.lower(), add_special_tokens=False).ids)[: TOKENS - 3] for p in phrases]
        made: list[Prompt] = []
        ids, prompts, spans = [begin], list[int](), list[slice]()
        for index, row in enumerate(rows):
            if len(ids) + len(row) + 2 > TOKENS:
                made.append(Prompt((*ids, end), tuple(prompts), tuple(spans)))
                ids, prompts, spans = [begin], [], []
            spans.append(slice(len(ids), len(ids) + len(row)))
            prompts.append(index)
            ids = [*ids, *row, stop]
        return (*made, Prompt((*ids, end), tuple(prompts), tuple(spans))) if prompts else tuple(made)


def _likely_detections(
    logits: Float32[np.ndarray, "q t"],
    boxes: Float32[np.ndarray, "q 4"],
    prompt: Prompt,
    threshold: float,
    size: tuple[int, int],
) -> Detections:
    """Boxes (centre and size, as shares of the picture) whose best phrase is likely enough, in pixels."""
    height, width = size
    likely = expit(logits.astype(np.float64))
    shares = np.stack(
        [likely[:, span].mean(axis=1) if span.stop > span.start else 0.0 * likely[:, 0] for span in prompt.spans],
        axis=1,
    )
    best = shares.argmax(axis=1)
    scores = shares[np.arange(len(shares)), best]
    keep = np.flatnonzero(scores > threshold)
    in_pixels = corners(boxes[keep].astype(np.float64)) * np.array([width, height] * 2)
    return Detections(clip(in_pixels, width, height), scores[keep], np.array(prompt.phrases, dtype=int)[best[keep]])
