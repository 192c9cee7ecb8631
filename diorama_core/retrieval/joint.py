"""Likeness in a joint embedding of words, pictures and shapes: OpenCLIP, with DuoduoCLIP's tower where it is here."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Float32, UInt8

from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.models.clip import DuoduoClip, OpenClip
from diorama_core.render.views import StudioView, render_shape
from diorama_core.retrieval.appearance_similarity import NEUTRAL, SIDE_PX, ObjectCrop
from diorama_core.retrieval.feature_cache import cached_features

_VIEWS = tuple(StudioView(float(np.radians(yaw)), float(np.radians(20.0))) for yaw in (32.0, -32.0, 100.0, 200.0))
_SPREAD = 0.08
"""Cosine by which a shape falls short of its pool's best at which it counts a third as much."""
_PROMPT = "a photo of {}"


@runtime_checkable
class JointEmbedding(Protocol):
    """Words, pictures and shapes in one space; all vectors of unit length."""

    @property
    def weights(self) -> str:
        """Changes with the weights."""
        ...

    def text(self, text: str) -> Float32[np.ndarray, " d"]:
        """What a sentence says."""
        ...

    def picture(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, " d"]:
        """What a picture shows."""
        ...

    def shape(self, views: Sequence[UInt8[np.ndarray, "_ _ 3"]]) -> Float32[np.ndarray, " d"]:
        """The common object of several pictures."""
        ...


@dataclass(frozen=True)
class ClipEmbedding:
    """OpenCLIP; with DuoduoCLIP's tower, which was trained on many views of shapes, for pictures and shapes."""

    clip: OpenClip
    tower: DuoduoClip | None = None

    @property
    def weights(self) -> str:
        """Of both networks."""
        return self.clip.weights if self.tower is None else f"{self.clip.weights}+{self.tower.weights}"

    def text(self, text: str) -> Float32[np.ndarray, " d"]:
        """OpenCLIP's; the tower was trained into the same space."""
        return self.clip.texts([text])[0]

    def picture(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, " d"]:
        """The tower takes a single picture too."""
        return self.shape([rgb])

    def shape(self, views: Sequence[UInt8[np.ndarray, "_ _ 3"]]) -> Float32[np.ndarray, " d"]:
        """The tower's, or the mean direction of the pictures."""
        if self.tower is not None:
            return self.tower.shape(views)
        mean = self.clip.images(views).mean(axis=0)
        return np.asarray(mean / max(float(np.linalg.norm(mean)), 1e-12), np.float32)


@dataclass(frozen=True)
class JointSimilarity:
    """By words and picture, counting the same, in a joint embedding.

    A shape is rendered and embedded once; embeddings are cached by its content and the weights.
    """

    library: ShapeLibrary = field(repr=False)
    embedding: JointEmbedding
    folder: Path | None = field(default=None, repr=False)
    """Cache folder of embeddings; `features` in Diorama's cache folder by default."""

    def of(self, item: ObjectCrop, shapes: Sequence[Shape]) -> Float[np.ndarray, " n"]:
        """Near 1 for what is most alike; falls with the cosine."""
        if not shapes:
            return np.zeros(0)
        kind = f"joint-{hashlib.sha256(self.embedding.weights.encode()).hexdigest()[:16]}-{len(_VIEWS)}"
        known = np.stack([cached_features(kind, s, partial(self._made, s), self.folder)[0] for s in shapes])
        cosine = known.astype(np.float32) @ self.embedding.text(_PROMPT.format(item.label))
        if item.mask.any():
            cosine = 0.5 * (cosine + known.astype(np.float32) @ self.embedding.picture(item.crop))
        return np.asarray(np.exp((cosine - cosine.max()) / _SPREAD), np.float64)

    def _made(self, shape: Shape) -> Float32[np.ndarray, "1 d"]:
        return self.embedding.shape(self._views(shape))[None]

    def _views(self, shape: Shape) -> list[UInt8[np.ndarray, "_ _ 3"]]:
        """The shape from four sides on the neutral ground."""
        pictures = []
        for view in _VIEWS:
            rgba = render_shape(self.library, shape.id, (SIDE_PX, SIDE_PX), view)
            opacity = rgba[..., 3:].astype(np.float32) / 255.0
            pictures.append(np.rint(opacity * rgba[..., :3] + (1 - opacity) * NEUTRAL).astype(np.uint8))
        return pictures
