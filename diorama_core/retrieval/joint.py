"""Likeness in a joint embedding of words, pictures and shapes: OpenCLIP's, with a tower for shapes where one is here.

DuoduoCLIP's tower sees views of a shape, OpenShape's its points.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Float32, UInt8

from diorama_core.geometry.shape_appearance import appearance_of
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.models.clip import DuoduoClip, OpenClip
from diorama_core.models.openshape import POINTS, OpenShape
from diorama_core.render.views import StudioView, render_shape
from diorama_core.retrieval.appearance_similarity import NEUTRAL, SIDE_PX, ObjectCrop
from diorama_core.retrieval.feature_cache import cached_features

_VIEWS = tuple(StudioView(float(np.radians(yaw)), float(np.radians(20.0))) for yaw in (32.0, -32.0, 100.0, 200.0))
PROMPT = "a photo of {}"
"""As the publication asks for a class."""


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

    def shape(self, library: ShapeLibrary, shape: Shape) -> Float32[np.ndarray, " d"]:
        """A shape of a library."""
        ...


@dataclass(frozen=True)
class ClipEmbedding:
    """OpenCLIP; with DuoduoCLIP's tower, which was trained on many views of shapes, for pictures and shapes."""

    clip: OpenClip
    tower: DuoduoClip | None = None

    @property
    def weights(self) -> str:
        """Weights of both networks."""
        return self.clip.weights if self.tower is None else f"{self.clip.weights}+{self.tower.weights}"

    def text(self, text: str) -> Float32[np.ndarray, " d"]:
        """OpenCLIP's; the tower was trained into the same space."""
        return self.clip.texts([text])[0]

    def picture(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, " d"]:
        """The tower takes a single picture too."""
        return self._object([rgb])

    def shape(self, library: ShapeLibrary, shape: Shape) -> Float32[np.ndarray, " d"]:
        """By its views."""
        return self._object(studio_views(library, shape))

    def _object(self, views: Sequence[UInt8[np.ndarray, "_ _ 3"]]) -> Float32[np.ndarray, " d"]:
        """The common object of several pictures: the tower's vector, or the mean direction of the pictures'."""
        if self.tower is not None:
            return self.tower.shape(views)
        mean = self.clip.images(views).mean(axis=0)
        return np.asarray(mean / max(float(np.linalg.norm(mean)), 1e-12), np.float32)


@dataclass(frozen=True)
class PointEmbedding:
    """OpenCLIP bigG-14 for words and pictures, OpenShape for shapes."""

    clip: OpenClip
    tower: OpenShape

    @property
    def weights(self) -> str:
        """Weights of both networks."""
        return f"{self.clip.weights}+{self.tower.weights}"

    def text(self, text: str) -> Float32[np.ndarray, " d"]:
        """OpenCLIP's; the tower was trained into the same space."""
        return self.clip.texts([text])[0]

    def picture(self, rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, " d"]:
        """OpenCLIP's."""
        return self.clip.images([rgb])[0]

    def shape(self, library: ShapeLibrary, shape: Shape) -> Float32[np.ndarray, " d"]:
        """By points of its surface in their colours."""
        return self.tower.shape(*appearance_of(library.parts(shape.id)).spread_coloured_points(POINTS))


@dataclass(frozen=True)
class JointSimilarity:
    """By words and picture, counting the same, in a joint embedding.

    A shape is rendered and embedded once; embeddings are cached by its content and the weights.
    """

    library: ShapeLibrary = field(repr=False)
    embedding: JointEmbedding
    folder: Path | None = field(default=None, repr=False)
    """Cache folder of embeddings; `features` in Diorama's cache folder by default."""
    spread: float = 0.08
    """Cosine by which a shape falls short of its pool's best at which it counts a third as much."""

    def similarities(self, item: ObjectCrop, shapes: Sequence[Shape]) -> Float[np.ndarray, " n"]:
        """Similarities, near 1 for what is most alike; they fall with the cosine."""
        if not shapes:
            return np.zeros(0)
        known = shape_vectors(self.library, self.embedding, shapes, self.folder)
        cosine = known @ self.embedding.text(PROMPT.format(item.label))
        if item.mask.any():
            cosine = 0.5 * (cosine + known @ self.embedding.picture(item.crop))
        return np.asarray(np.exp((cosine - cosine.max()) / self.spread), np.float64)


def shape_vectors(
    library: ShapeLibrary, embedding: JointEmbedding, shapes: Sequence[Shape], folder: Path | None = None
) -> Float32[np.ndarray, "n d"]:
    """Vectors of shapes, each made once and kept by its content and the weights.

    Args:
        library: Where they are.
        embedding: Makes them.
        shapes: At least one.
        folder: Of the cache; `features` in Diorama's cache folder by default.
    """
    kind = f"joint-{hashlib.sha256(embedding.weights.encode()).hexdigest()[:16]}-{len(_VIEWS)}"

    def embed(shape: Shape) -> Float32[np.ndarray, "1 d"]:
        return embedding.shape(library, shape)[None]

    return np.stack([cached_features(kind, s, partial(embed, s), folder)[0] for s in shapes]).astype(np.float32)


def studio_views(library: ShapeLibrary, shape: Shape) -> list[UInt8[np.ndarray, "_ _ 3"]]:
    """A shape from four sides on the neutral ground."""
    pictures = []
    for view in _VIEWS:
        rgba = render_shape(library, shape.id, (SIDE_PX, SIDE_PX), view)
        opacity = rgba[..., 3:].astype(np.float32) / 255.0
        pictures.append(np.rint(opacity * rgba[..., :3] + (1 - opacity) * NEUTRAL).astype(np.uint8))
    return pictures
