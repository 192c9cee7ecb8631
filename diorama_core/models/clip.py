"""Texts, pictures and shapes in one space: OpenCLIP (B-32, bigG-14) and DuoduoCLIP's shape tower (Lee et al. 2025)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float32, UInt8
from PIL import Image

from diorama_core.models.images import CLIP_MEAN, CLIP_STD, normalise, resize
from diorama_core.models.runtime import SHARED_SESSIONS, Dims, SessionPool
from diorama_core.models.tokens import clip_tokens, load_tokenizer

TOKENS = 77
SIDE = 224
_VECTOR: Dims = (1, 512)


@dataclass(frozen=True)
class OpenClip:
    """Input: texts, or RGB pictures of 8 bits and any size. Output: unit vectors (B-32: 512 numbers, bigG: 1280)."""

    text_graph: Path = field(repr=False)
    image_graph: Path = field(repr=False)
    tokenizer: Path = field(repr=False)
    weights: str = "openclip-b32"
    width: int = 512
    """Numbers of a vector."""
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    @property
    def _vector(self) -> Dims:
        return (1, self.width)

    @cached_property
    def _tokenizer(self) -> Any:
        return load_tokenizer(self.tokenizer)

    def texts(self, texts: Sequence[str]) -> Float32[np.ndarray, "n d"]:
        """One vector per text."""
        session = self.pool.get(self.text_graph)
        name, first = session.first_input, session.outputs[0]
        ids, _ = clip_tokens(self._tokenizer, texts, TOKENS)
        rows = [session.run({name: one[None]}, {first: self._vector})[first] for one in ids]
        return unit(np.concatenate(rows)) if rows else np.zeros((0, self.width), np.float32)

    def images(self, pictures: Sequence[UInt8[np.ndarray, "_ _ 3"]]) -> Float32[np.ndarray, "n d"]:
        """One vector per picture."""
        session = self.pool.get(self.image_graph)
        name, first = session.picture_input, session.outputs[0]
        rows = [session.run({name: clip_pixels(p)}, {first: self._vector})[first] for p in pictures]
        return unit(np.concatenate(rows)) if rows else np.zeros((0, self.width), np.float32)


@dataclass(frozen=True)
class DuoduoClip:
    """Input: several views of one shape. Output: one unit vector in OpenCLIP's space; texts come from `OpenClip`."""

    graph: Path = field(repr=False)
    weights: str = "duoduoclip"
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    def shape(self, views: Sequence[UInt8[np.ndarray, "_ _ 3"]]) -> Float32[np.ndarray, "512"]:
        """The shape that the views show; the order of the views does not matter, one is enough (a photo's crop)."""
        session = self.pool.get(self.graph)
        name, first = session.picture_input, session.outputs[0]
        count = session.inputs[name].shape[1]
        # A graph for a fixed number of views sees given ones again: attention over copies is that over the originals.
        shown = [views[k % len(views)] for k in range(count)] if isinstance(count, int) else views
        pixels = np.concatenate([clip_pixels(v) for v in shown])[None]
        return unit(session.run({name: pixels}, {first: _VECTOR})[first])[0]


def clip_pixels(rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, "1 3 224 224"]:
    """The shorter side becomes 224, the middle is cut out, CLIP statistics."""
    height, width = rgb.shape[:2]
    scale = SIDE / min(height, width)
    size = (SIDE, int(width * scale)) if height <= width else (int(height * scale), SIDE)
    small = resize(rgb, size, Image.Resampling.BICUBIC)
    top, left = (size[0] - SIDE) // 2, (size[1] - SIDE) // 2
    return normalise(small[top : top + SIDE, left : left + SIDE], CLIP_MEAN, CLIP_STD)


def unit(vectors: np.ndarray) -> Float32[np.ndarray, "n d"]:
    """Rows of length one."""
    flat = vectors.reshape(len(vectors), -1).astype(np.float32)
    return flat / np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-12)
