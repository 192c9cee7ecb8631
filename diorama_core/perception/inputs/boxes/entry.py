"""Boxes as files have them, before they are laid over the photo."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeVar

from diorama_core.errors import InputError
from diorama_core.io.bounded import shorten
from diorama_core.perception.inputs.source import Source

Corners = tuple[float, float, float, float]
Unit = Literal["pixels", "shares", "percent", "thousandths"]
"""Unit of coordinates; all but pixels are relative to the picture's sides."""
Layout = Literal["corners", "sized", "centred", "rows"]
"""Four numbers as x1, y1, x2, y2; x, y, width, height; middle x, middle y, width, height; or y1, x1, y2, x2."""
T = TypeVar("T")

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
        """A copy with more to tell."""
        return replace(self, notes=(*self.notes, *notes))


@dataclass(frozen=True)
class BoxText:
    """The content of a file, parsed as far as its container goes."""

    source: Source
    document: object
    """A JSON value, an XML root element, or the lines of a text."""
    photo_name: str
    photo_size: Size
    """Size of the upright original."""


def is_of(name: object, photo_name: str) -> bool:
    """Whether a picture that a file names is the photo: folders, endings, and what Roboflow and Label Studio add to
    names apart."""
    return _plain(str(name)) == _plain(photo_name)


def picture_of(pictures: Sequence[T], names: Sequence[object], text: BoxText, what: str) -> T:
    """Picks the picture of a file that is the photo; the only one where there is one.

    Args:
        pictures: what the file says of each.
        names: of them, as the file has them.
        text: the file.
        what: it is, for people.

    Raises:
        InputError: none of several is called like the photo, or more than one.
    """
    matches = [p for p, name in zip(pictures, names, strict=True) if len(pictures) == 1 or is_of(name, text.photo_name)]
    if len(matches) != 1:
        raise InputError(
            f"{text.source.name}: this {what} is of {len(pictures)} pictures, none of them called "
            f"{shorten(text.photo_name, 60)}; keep the annotations of this photo"
        )
    return matches[0]


def _plain(name: str) -> str:
    stem = re.split(r"[/\\]", name)[-1].rsplit(".", 1)[0].lower()
    stem = re.sub(r"\.rf\.[0-9a-z]+$", "", stem)  # Roboflow: room_jpg.rf.0a1b2c
    return re.sub(r"_(jpe?g|png|webp|bmp|tiff?)$", "", re.sub(r"^[0-9a-f]{8}-", "", stem))


def from_layout(numbers: Corners, layout: Layout) -> Corners:
    """Corners of four numbers."""
    a, b, c, d = numbers
    if layout == "sized":
        return a, b, a + c, b + d
    if layout == "rows":
        return b, a, d, c
    return (a - c / 2, b - d / 2, a + c / 2, b + d / 2) if layout == "centred" else numbers
