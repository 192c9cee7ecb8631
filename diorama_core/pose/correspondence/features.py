"""Patch features of views, for matching patches of one object; those of networks are cached on disk by the shape's
content.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float32

from diorama_core.io.derived import read_arrays, write_arrays
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.models.features import PATCH, Dinov2
from diorama_core.pose.correspondence.crops import PATCHES, GrayView, pool_patches
from diorama_core.render.templates import Templates

_VIEWS_AT_ONCE = 12


@runtime_checkable
class PatchFeatures(Protocol):
    """Features of the 16 x 16 patches of every view, of unit length."""

    @property
    def weights(self) -> str | None:
        """Which weights make them; None for those that are cheaper to make than to keep."""
        ...

    def encode(self, view: GrayView) -> Float32[np.ndarray, "v p d"]:
        """Unit vectors, row by row of patches; zero where there is nothing of the object."""
        ...


@dataclass(frozen=True)
class GeometricFeatures:
    """Features without a network: the normals in and around a patch, and where on the outline it lies.

    A patch is told by the mean normals of itself and of its neighbours, by how much of each the object covers, and by
    its place between the object's edges, left to right and top to bottom.
    """

    place_weight: float = 1.2

    @property
    def weights(self) -> str | None:
        """They need none."""
        return None

    def encode(self, view: GrayView) -> Float32[np.ndarray, "v p d"]:
        """Unit vectors; zero for patches that the object does not reach."""
        normals = pool_patches(view.normals)
        cover = view.patch_cover[..., None].astype(np.float32)
        near = _with_neighbours(np.concatenate([normals, cover], axis=-1))
        place = self.place_weight * _place(view)
        features = np.concatenate([normals * 1.5, 0.5 * near, place], axis=-1) * (cover > 0)
        length = np.linalg.norm(features, axis=-1, keepdims=True)
        return np.asarray(features / np.maximum(length, 1e-6), dtype=np.float32)


@dataclass(frozen=True)
class NetworkFeatures:
    """DINOv2's, of the gray pictures (paper: the large network's block 17)."""

    network: Dinov2

    @property
    def weights(self) -> str | None:
        """The network's, and which block of it."""
        return f"{self.network.weights}-{'last' if self.network.block is None else self.network.block}"

    def encode(self, view: GrayView) -> Float32[np.ndarray, "v p d"]:
        """Unit vectors; zero for patches that the object does not reach."""
        pictures = [np.repeat(gray[..., None], 3, axis=-1) for gray in view.gray]
        side = PATCHES * PATCH
        made = [
            self.network.batch(pictures[k : k + _VIEWS_AT_ONCE], side) for k in range(0, len(pictures), _VIEWS_AT_ONCE)
        ]
        features = np.concatenate(made).reshape(len(pictures), PATCHES**2, -1) * (view.patch_cover[..., None] > 0)
        length = np.linalg.norm(features, axis=-1, keepdims=True)
        return np.asarray(features / np.maximum(length, 1e-6), dtype=np.float32)


def _with_neighbours(values: Float32[np.ndarray, "v p c"]) -> Float32[np.ndarray, "v p m"]:
    """The values of the four neighbours two patches away."""
    v, _, c = values.shape
    grid = np.pad(values.reshape(v, PATCHES, PATCHES, c), ((0, 0), (2, 2), (2, 2), (0, 0)))
    around = [
        grid[:, 2 + dy : 2 + dy + PATCHES, 2 + dx : 2 + dx + PATCHES] for dx, dy in ((-2, 0), (2, 0), (0, -2), (0, 2))
    ]
    return np.concatenate(around, axis=-1).reshape(v, PATCHES**2, 4 * c)


def _place(view: GrayView) -> Float32[np.ndarray, "v p 4"]:
    """Sine and cosine of the place between the object's edges: a quarter turn from one edge to the other."""
    inside: Bool[np.ndarray, "v n n"] = view.foreground.reshape(-1, PATCHES, PATCHES)
    steps = np.arange(PATCHES)
    parts = []
    for axis in (1, 2):
        filled = inside.sum(axis=axis) > 0
        some = filled.sum(axis=1) > 0
        first = np.where(some, filled.argmax(axis=1), 0)
        last = np.where(some, PATCHES - 1 - filled[:, ::-1].argmax(axis=1), PATCHES - 1)
        share = (steps - first[:, None]) / np.maximum(last - first, 1)[:, None]
        angle = np.clip(share, 0.0, 1.0) * (np.pi / 2)
        wave = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        wide = np.broadcast_to(wave[:, None] if axis == 1 else wave[:, :, None], (len(inside), PATCHES, PATCHES, 2))
        parts.append(wide.reshape(len(inside), PATCHES**2, 2))
    return np.concatenate(parts, axis=-1).astype(np.float32)


_LIMIT_BYTES = 8 * 2**30
"""Limit of all cached features; those of a large network take about 40 MB a shape."""


@dataclass(frozen=True, eq=False)
class EncodedViews:
    """One shape's views with their features."""

    templates: Templates
    foreground: Bool[np.ndarray, "v p"]
    """Patches that belong to the shape."""
    features: Float32[np.ndarray, "v p d"]

    @classmethod
    def of(
        cls,
        templates: Templates,
        view: GrayView,
        features: PatchFeatures,
        content_hash: str,
        folder: Path | None = None,
    ) -> EncodedViews:
        """Encode all views, or read them from the cache.

        Args:
            templates: The views.
            view: The same as pictures for the features.
            features: How to encode; only those with a `weights` name are kept.
            content_hash: Of the shape; nothing is kept without one.
            folder: Where features are kept; `patches` in the cache folder by default.
        """
        foreground = view.foreground
        if features.weights is None or not content_hash:
            return cls(templates, foreground, features.encode(view))
        name = re.sub(r"[^\w.-]+", "-", f"{content_hash}-{templates.grid.key}-{features.weights}") + ".npz"
        path = (folder or default_cache_dir() / "patches") / name
        stored = read_arrays(path, "inside", mark_use=True)
        if stored is not None and len(stored[0]) == foreground.sum():
            inside = stored[0]
        else:
            inside = features.encode(view)[foreground].astype(np.float16)
            write_arrays(path, {"inside": inside}, limit_bytes=_LIMIT_BYTES)
        filled = np.zeros((*foreground.shape, inside.shape[1]), np.float32)
        filled[foreground] = inside
        return cls(templates, foreground, filled)
