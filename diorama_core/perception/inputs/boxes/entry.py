"""Boxes as files have them, before they are laid over the photo."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from diorama_core.perception.inputs.source import Source

Corners = tuple[float, float, float, float]
Unit = Literal["pixels", "shares", "percent", "thousandths"]
"""Of what coordinates are: of the picture's sides, except pixels."""
Layout = Literal["corners", "sized", "centred"]
"""Four numbers as x1, y1, x2, y2; x, y, width, height; or middle x, middle y, width, height."""

Size = tuple[int, int]
UNNAMED = "object"


@dataclass(frozen=True)
class BoxEntry:
    """One box of a file."""

    corners: Corners
    word: str = UNNAMED
    score: float = 1.0


@dataclass(frozen=True)
class BoxFile:
    """What a file says, in its own coordinates."""

    entries: tuple[BoxEntry, ...]
    size: Size | None = None
    """Width and height of the annotated picture, where the file states them."""
    unit: Unit = "pixels"
    ambiguous_layout: bool = False
    """Whether the four numbers were taken for corners for want of anything that says so."""
    notes: tuple[str, ...] = ()

    def with_notes(self, *notes: str) -> BoxFile:
        """The same with more to tell."""
        return replace(self, notes=(*self.notes, *notes))


@dataclass(frozen=True)
class BoxText:
    """The content of a file, parsed as far as its container goes."""

    source: Source
    document: object
    """A JSON value, an XML root element, or the lines of a text."""
    photo_name: str
    photo_size: Size
    """Of the upright original."""


def from_layout(numbers: Corners, layout: Layout) -> Corners:
    """Corners of four numbers."""
    a, b, c, d = numbers
    if layout == "sized":
        return a, b, a + c, b + d
    return (a - c / 2, b - d / 2, a + c / 2, b + d / 2) if layout == "centred" else numbers
