"""A cache of shape features in memory and, under the shapes' content hashes, on disk."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
from jaxtyping import Float, Float16

from diorama_core.io.arrays import array_of
from diorama_core.io.cache import LruCache
from diorama_core.io.derived import read_derived, write_derived
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape

_CACHE: LruCache[str, np.ndarray] = LruCache(4096)


def cached_features(
    kind: str, shape: Shape, make: Callable[[], Float[np.ndarray, "rows width"]], folder: Path | None = None
) -> Float16[np.ndarray, "rows width"]:
    """The features of one kind of one shape: from memory, from its file, or made now and written.

    One file a shape, replaced whole, so that any number of processes may share the folder. A folder that cannot be
    written only costs time; a shape without a content hash is not remembered.

    Args:
        kind: What and by which weights: a word fit for a folder's name.
        shape: Whose.
        make: Makes them.
        folder: Where kinds are kept; `features` in the cache folder by default.
    """
    if not shape.content_hash:
        return make().astype(np.float16)
    path = _path(kind, shape, folder)

    def read_or_make() -> np.ndarray:
        features = _read(path)
        return _write(path, make().astype(np.float16)) if features is None else features

    return _CACHE.get(str(path), read_or_make)


def has_features(kind: str, shape: Shape, folder: Path | None = None) -> bool:
    """Whether the features of one kind of one shape are on disk."""
    return bool(shape.content_hash) and _path(kind, shape, folder).is_file()


def _path(kind: str, shape: Shape, folder: Path | None) -> Path:
    return (folder or default_cache_dir() / "features") / kind / f"{shape.content_hash}.npy"


def _read(path: Path) -> np.ndarray | None:
    content = read_derived(path)
    if content is None:
        return None
    try:
        values = array_of(content)
    except Exception:  # a damaged header raises almost anything; the features are made again
        return None
    return values if values.ndim == 2 and values.dtype == np.float16 else None


def _write(path: Path, values: np.ndarray) -> np.ndarray:
    data = BytesIO()
    np.save(data, values)
    write_derived(path, data.getvalue())
    return values
