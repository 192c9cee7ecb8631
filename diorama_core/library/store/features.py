"""Features of shapes: a matrix of half-precision numbers, mapped into memory, that grows at its end.

A shape has one row (a text or picture embedding) or a fixed number of rows (one a view), kept under a key: its content
hash, so that a changed shape gets new features and a renamed one keeps its own.
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import simsimd
from jaxtyping import Bool, Float, Float16, Int

from diorama_core.errors import LibraryError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_bytes, read_json

_RESCORED = 4
"""How many times the wanted rows are scored again in full precision."""
SEARCH_THREADS = 2
MAX_KEYS_BYTES = 400_000_000
INDEX_FOLDER = "index"
"""Where an index of the features is kept, beside them (`store.vectors`)."""


@dataclass(frozen=True)
class NearShape:
    """One shape found by its features."""

    key: str
    score: float
    """Dot product with the query; the best of the shape's rows."""
    row: int
    """Which of the shape's rows was best."""


class FeatureMatrix:
    """The features of one kind, of one library, in one folder. One writer at a time; readers open it when they like.

    Rows are written before their keys, so what an interrupted writer leaves has no whole key; the next overwrites it.

    Args:
        folder: For this kind of feature, made when absent.
        width: Numbers in a row.
        rows: Rows of each key.

    Raises:
        LibraryError: when the folder holds features of another width, or cannot be used.
    """

    def __init__(self, folder: Path, width: int, rows: int = 1) -> None:
        self.folder, self.width, self.rows = folder, width, rows
        self._check_or_make()
        self._load()

    def __len__(self) -> int:
        return len(self.keys)

    @property
    def values(self) -> Float16[np.ndarray, "keys rows width"]:
        """All features, read from disk as they are touched."""
        return self._matrix.reshape(len(self.keys), self.rows, self.width)

    def position(self, key: str) -> int | None:
        """Where a key's features are in `values`; None when they are missing."""
        return self._positions.get(key)

    def missing(self, keys: Iterable[str]) -> list[str]:
        """The keys without features, each once, in order."""
        return [key for key in dict.fromkeys(keys) if key not in self._positions]

    def missing_from(self, keys: Container[str]) -> list[str]:
        """The keys with features that are not among these, in order."""
        return [key for key in self.keys if key not in keys]

    def append(self, keys: Sequence[str], values: Float[np.ndarray, "n *feature"]) -> None:
        """Add the features of new keys, `rows` times `width` numbers for each.

        Raises:
            LibraryError: when a key is there already, the sizes do not fit, a number is too large for half precision or
                not finite, or the files cannot be written.
        """
        half = np.asarray(values, dtype="<f2").reshape(-1, self.rows, self.width)
        if len(half) != len(keys) or len(set(keys)) != len(keys):
            raise LibraryError(f"{len(keys)} keys do not name {len(half)} features")
        known = [key for key in keys if key in self._positions]
        if known or any("\n" in key or not key for key in keys):
            raise LibraryError(f"features under {known[:3] or 'such names'} cannot be added: there already, or no name")
        if not np.isfinite(half).all():
            raise LibraryError("features must be finite numbers below 65504")
        try:
            _write_at(self._values_path, len(self.keys) * self._key_bytes, half.tobytes())
            known_bytes = sum(len(key.encode()) + 1 for key in self.keys)
            _write_at(self._keys_path, known_bytes, "".join(f"{key}\n" for key in keys).encode())
        except OSError as error:
            raise LibraryError(f"features cannot be written in {self.folder} ({error.strerror})") from error
        self._load()

    def clear(self) -> None:
        """Drop all features, and the index of them."""
        try:
            for path in (self._keys_path, self._values_path):
                path.unlink()  # not cut short: others may still have it mapped
                path.touch()
            shutil.rmtree(self.folder / INDEX_FOLDER, ignore_errors=True)
        except OSError as error:
            raise LibraryError(f"features cannot be written in {self.folder} ({error.strerror})") from error
        self._load()

    def top(
        self, query: Float[np.ndarray, "width"], k: int, among: Bool[np.ndarray, "keys"] | None = None
    ) -> tuple[NearShape, ...]:
        """The `k` shapes whose features have the greatest dot product with a query, best first; ties by key order.

        Args:
            query: One feature; of unit length, as the rows usually are, the score is a cosine.
            k: How many.
            among: Which keys may be found, by position; all by default.
        """
        if not len(self.keys) or k < 1:
            return ()
        scores = self.scores(query)
        if among is not None:
            scores = np.where(among, scores, -np.inf)
        wanted = min(k, int(np.isfinite(scores).sum()))
        likely = _greatest(scores, min(_RESCORED * k, wanted + 64))
        return self.best_of(likely[np.isfinite(scores[likely])], query, wanted)

    def best_of(
        self, positions: Int[np.ndarray, "m"], query: Float[np.ndarray, "width"], k: int
    ) -> tuple[NearShape, ...]:
        """The best of some keys, scored in single precision.

        Args:
            positions: of the keys.
            query: features at unit length.
            k: most results.
        """
        exact = self.values[positions].astype(np.float32) @ np.asarray(query, np.float32)
        best = exact.max(axis=1)
        order = np.lexsort((positions, -best))[:k]
        return tuple(NearShape(self.keys[positions[i]], float(best[i]), int(exact[i].argmax())) for i in order)

    def scores(self, query: Float[np.ndarray, "width"]) -> Float[np.ndarray, "keys"]:
        """Dot products with a query in half precision; the best of each key's rows."""
        half = np.ascontiguousarray(query, dtype=np.float16).reshape(1, self.width)
        dots = np.asarray(simsimd.cdist(half, self._matrix, metric="dot", threads=SEARCH_THREADS))
        return dots.reshape(len(self.keys), self.rows).max(axis=1)

    @property
    def _key_bytes(self) -> int:
        return 2 * self.rows * self.width

    @property
    def _values_path(self) -> Path:
        return self.folder / "values.f16"

    @property
    def _keys_path(self) -> Path:
        return self.folder / "keys.txt"

    def _check_or_make(self) -> None:
        about = self.folder / "about.json"
        wanted = {"width": self.width, "rows": self.rows, "numbers": "float16, little-endian"}
        try:
            if not about.exists():
                self.folder.mkdir(parents=True, exist_ok=True)
                self._values_path.touch()
                self._keys_path.touch()
                write_atomically(about, json.dumps(wanted).encode())
            description = read_json(about, LibraryError, most=10_000, advice="delete that folder")
        except (OSError, ValueError) as error:
            raise LibraryError(f"features in {self.folder} cannot be used ({error}); delete that folder") from error
        if description != wanted:
            raise LibraryError(f"{self.folder} holds other features ({description}, not {wanted}); delete that folder")

    def _load(self) -> None:
        """Map the values, and take the keys whose rows are complete."""
        try:
            listed = read_bytes(self._keys_path, MAX_KEYS_BYTES, LibraryError, "delete that folder").decode()
            keys = listed.split("\n")[:-1]  # what follows the last line's end is half a key
            count = min(len(keys), self._values_path.stat().st_size // self._key_bytes)
            shape = (count * self.rows, self.width)
            mapped = (
                np.memmap(self._values_path, dtype="<f2", mode="r", shape=shape) if count else np.zeros(shape, "<f2")
            )
        except (OSError, ValueError) as error:
            raise LibraryError(f"features in {self.folder} cannot be read ({error}); delete that folder") from error
        self.keys = tuple(keys[:count])
        self._positions = {key: i for i, key in enumerate(self.keys)}
        self._matrix: Float16[np.ndarray, "n width"] = np.asarray(mapped)


def _write_at(path: Path, start: int, data: bytes) -> None:
    """Replace everything in a file from a place on; on disk when it returns."""
    with open(path, "r+b") as stream:
        stream.seek(start)
        stream.write(data)
        stream.truncate()
        os.fsync(stream.fileno())


def _greatest(scores: Float[np.ndarray, "n"], count: int) -> Int[np.ndarray, "m"]:
    """Positions of the greatest scores, in no order."""
    if count >= len(scores):
        return np.arange(len(scores))
    return np.argpartition(scores, len(scores) - count)[len(scores) - count :]
