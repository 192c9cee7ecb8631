"""Patch features of all views of a shape; those that a network makes are kept on disk by the shape's content."""

from __future__ import annotations

import io
import logging
import os
import re
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float32

from diorama_core.library.catalogue import default_cache_dir
from diorama_core.pose.correspondence.crops import View
from diorama_core.pose.correspondence.features import PatchFeatures
from diorama_core.render.templates import Templates

log = logging.getLogger(__name__)

_LIMIT_BYTES = 8 * 2**30
"""Of all kept features together: a large network's take some forty megabytes a shape."""


@dataclass(frozen=True, eq=False)
class EncodedViews:
    """One shape's views with their features."""

    templates: Templates
    foreground: Bool[np.ndarray, "v p"]
    """Patches that belong to the shape."""
    features: Float32[np.ndarray, "v p d"]

    @classmethod
    def of(
        cls, templates: Templates, view: View, features: PatchFeatures, content_hash: str, folder: Path | None = None
    ) -> EncodedViews:
        """Encode all views, or read what an earlier run kept.

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
        inside = _read(path)
        if inside is None or len(inside) != foreground.sum():
            inside = features.encode(view)[foreground].astype(np.float16)
            _write(path, inside)
        filled = np.zeros((*foreground.shape, inside.shape[1]), np.float32)
        filled[foreground] = inside
        return cls(templates, foreground, filled)


def _read(path: Path) -> np.ndarray | None:
    try:
        with np.load(path, allow_pickle=False) as data:
            inside = data["inside"]
        os.utime(path)  # so that what is used is not the first to go
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None  # absent, or damaged: it is made again
    return np.asarray(inside)


def _write(path: Path, inside: np.ndarray) -> None:
    data = io.BytesIO()
    np.savez(data, inside=inside)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _make_room(path.parent, len(data.getvalue()))
        with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as part:
            part.write(data.getvalue())
        os.replace(part.name, path)  # so that no reader ever sees half a file
    except OSError as error:
        log.warning("cannot keep patch features in %s (%s); they are made again each time", path.parent, error)


def _make_room(folder: Path, coming_bytes: int) -> None:
    """Drop the files that were not used for longest until the coming one fits."""
    files = sorted((e.stat().st_mtime, e.stat().st_size, e.path) for e in os.scandir(folder) if e.is_file())
    excess = sum(size for _, size, _ in files) + coming_bytes - _LIMIT_BYTES
    for _, size, old in files:
        if excess <= 0:
            return
        Path(old).unlink(missing_ok=True)
        excess -= size
