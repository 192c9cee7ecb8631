"""What ingestion hands over, and to whom."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from diorama_core.library.record import Shape


@dataclass(frozen=True)
class Ingested:
    """One model, read, put upright and measured: everything a store keeps of it."""

    record: Shape
    """With support surfaces, content hash and what was guessed. Its id is unique in the library."""
    glb: bytes
    """Geometry with materials, in the canonical frame (+X front, +Z up, centred, metres); textures embedded."""
    thumbnail_png: bytes | None
    """A square picture on a transparent background; None when none was asked for."""
    source_key: str
    """Names the source file's state and the settings it was read with: the same key, the same result."""
    warnings: tuple[str, ...] = ()
    """What was repaired or left out, one line each."""


@runtime_checkable
class ShapeSink(Protocol):
    """A store that takes shapes in. Used by one thread of one process; readers may read meanwhile.

    Each `add` is durable when it returns, so that a stopped run resumes after the last one.
    """

    def source_keys(self) -> Set[str]:
        """The `source_key` of everything kept: what a resumed run need not read again."""
        ...

    def add(self, item: Ingested) -> None:
        """Keep one shape; one with the same id is replaced. Raises `LibraryError` when it cannot be written."""
        ...
