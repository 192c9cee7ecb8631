"""Texts, pictures and shapes in one space: OpenCLIP (B-32, bigG-14) and DuoduoCLIP's shape tower (Lee et al. 2025); and
words as their byte-pair tokens.
"""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float32, Int64, UInt8
from PIL import Image

from diorama_core.models.images import CLIP_MEAN, CLIP_STD, normalise, resize
from diorama_core.models.runtime import SHARED_SESSIONS, GraphNetwork, NetworkError, Session, SessionPool

TOKENS = 77
SIDE = 224


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

    @cached_property
    def _tokenizer(self) -> Any:
        return load_tokenizer(self.tokenizer)

    def texts(self, texts: Sequence[str]) -> Float32[np.ndarray, "n d"]:
        """One vector per text."""
        session = self.pool.get(self.text_graph)
        ids, _ = clip_tokens(self._tokenizer, texts, TOKENS)
        return self._vectors(session, session.first_input, [one[None] for one in ids])

    def images(self, pictures: Sequence[UInt8[np.ndarray, "_ _ 3"]]) -> Float32[np.ndarray, "n d"]:
        """One vector per picture."""
        session = self.pool.get(self.image_graph)
        return self._vectors(session, session.picture_input, map(clip_pixels, pictures))

    def _vectors(self, session: Session, name: str, given: Iterable[np.ndarray]) -> Float32[np.ndarray, "n d"]:
        rows = [session.answer({name: one}, (1, self.width)) for one in given]
        return unit(np.concatenate(rows)) if rows else np.zeros((0, self.width), np.float32)


@dataclass(frozen=True)
class DuoduoClip(GraphNetwork):
    """Input: several views of one shape. Output: one unit vector in OpenCLIP's space; texts come from `OpenClip`."""

    weights: str = "duoduoclip"

    def shape(self, views: Sequence[UInt8[np.ndarray, "_ _ 3"]]) -> Float32[np.ndarray, "512"]:
        """The shape that the views show; the order of the views does not matter, one is enough (a photo's crop)."""
        session, name = self.session, self.session.picture_input
        count = session.inputs[name].shape[1]
        # A graph for a fixed number of views sees given ones again: attention over copies is that over the originals.
        shown = [views[k % len(views)] for k in range(count)] if isinstance(count, int) else views
        pixels = np.concatenate([clip_pixels(v) for v in shown])[None]
        return unit(session.answer({name: pixels}, (1, 512)))[0]


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


def load_tokenizer(path: Path) -> Any:
    """The tokenizer of a `tokenizer.json`.

    Raises:
        NetworkError: when the file is absent or damaged.
    """
    from tokenizers import Tokenizer

    try:
        tokenizer = Tokenizer.from_file(str(path))
    except Exception as error:  # the tokenizer raises plain `Exception` on damaged files
        reason = " ".join(str(error).split())[:120]
        raise NetworkError(path, f"cannot be read ({reason}); run: diorama models verify") from error
    tokenizer.no_padding()
    tokenizer.no_truncation()
    return tokenizer


def clip_tokens(
    tokenizer: Any, texts: Sequence[str], length: int
) -> tuple[Int64[np.ndarray, "n length"], Int64[np.ndarray, "n length"]]:
    """Ids padded with 0 to a fixed length, and 1 where a word is; longer texts are cut but keep their end mark."""
    ids = np.zeros((len(texts), length), np.int64)
    mask = np.zeros((len(texts), length), np.int64)
    for row, text in enumerate(texts):
        tokens = tokenizer.encode(tidy(text)).ids
        if len(tokens) > length:
            tokens = [*tokens[: length - 1], tokens[-1]]
        ids[row, : len(tokens)] = tokens
        mask[row, : len(tokens)] = 1
    return ids, mask


def tidy(text: str) -> str:
    """Lower case, single spaces, entities resolved, as CLIP's texts were prepared."""
    return " ".join(html.unescape(html.unescape(text)).lower().split())
