"""Convex parts of many shapes as few arrays, since an array costs more to open than to read: rows after one another.

Numbers are halved to four bytes: a micrometre in a hall.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from diorama_core.geometry.convex import ConvexPart

Parts = tuple[ConvexPart, ...]
NAMES = ("keys", "sizes", "counts", "vertices", "normals", "edges")
"""Names of the arrays, in the order in which `PackedParts` takes them."""


def packed(parts_by_key: Mapping[str, Parts]) -> dict[str, np.ndarray]:
    """The arrays: keys, parts per key (k), rows of each part in the three arrays (p 3), and these rows (n 3)."""
    parts = [part for group in parts_by_key.values() for part in group]
    columns = [[getattr(part, name) for part in parts] for name in NAMES[3:]]
    counts = np.array([[len(array) for array in column] for column in columns], dtype=np.int32).T
    sizes = np.array([len(group) for group in parts_by_key.values()], dtype=np.int32)
    rows = (np.concatenate(column).astype(np.float32) for column in columns)
    return dict(zip(NAMES, (np.array(list(parts_by_key)), sizes, counts, *rows), strict=True))


class PackedParts(Mapping[str, Parts]):
    """What `packed` made arrays of; parts are read when they are asked for.

    Args:
        arrays: In the order of `NAMES`.

    Raises:
        ValueError: when they do not belong together.
    """

    def __init__(self, *arrays: np.ndarray) -> None:
        keys, sizes, counts, *rows = arrays
        if len(keys) != len(sizes) or counts.shape != (int(sizes.sum()), 3):
            raise ValueError("the arrays of convex parts do not belong together")
        if counts.sum(axis=0).tolist() != [len(array) for array in rows]:
            raise ValueError("the arrays of convex parts do not belong together")
        last = np.cumsum(sizes)
        self._parts = dict(zip(keys.tolist(), zip((last - sizes).tolist(), last.tolist(), strict=True), strict=True))
        self._ends = np.cumsum(counts, axis=0)
        self._starts = self._ends - counts
        self._rows = rows

    def __getitem__(self, key: str) -> Parts:
        first, last = self._parts[key]
        return tuple(self._part(number) for number in range(first, last))

    def __iter__(self) -> Iterator[str]:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)

    def _part(self, number: int) -> ConvexPart:
        bounds = zip(self._starts[number].tolist(), self._ends[number].tolist(), strict=True)
        return ConvexPart(*(array[a:b].astype(np.float64) for array, (a, b) in zip(self._rows, bounds, strict=True)))
