"""Patch features of all views of a shape; network features are cached on disk by the shape's content."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float32

from diorama_core.io.derived import read_arrays, write_arrays
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.pose.correspondence.crops import GrayView
from diorama_core.pose.correspondence.features import PatchFeatures
from diorama_core.render.templates import Templates

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
