"""Boxes as files have them, before they are laid over the photo."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeVar

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
    document: Any
    """A JSON value, an XML root element, or the lines of a text."""
    photo_name: str
    photo_size: Size
    """Size of the upright original."""


def picture_of(pictures: Iterable[tuple[object, T]], text: BoxText, what: str) -> T:
    """Picks of a file's pictures, each with its name, the one that is the photo; the only one where there is one.

    Folders, endings, and what Roboflow and Label Studio add to names do not count.

    Raises:
        InputError: none of several is called like the photo, or more than one.
    """
    named, photo = list(pictures), _plain(text.photo_name)
    matches = [picture for name, picture in named if len(named) == 1 or _plain(str(name)) == photo]
    if len(matches) != 1:
        raise InputError(
            f"{text.source.name}: this {what} is of {len(named)} pictures, none of them called "
            f"{shorten(text.photo_name, 60)}; keep the annotations of this photo"
        )
    return matches[0]


def rows_of_picture(rows: Iterable[tuple[object, T]], text: BoxText, what: str) -> list[T]:
    """The rows of the photo, where each has the name of its picture; raises as `picture_of`."""
    by_name: dict[object, list[T]] = {}
    for name, row in rows:
        by_name.setdefault(name, []).append(row)
    return picture_of(by_name.items(), text, what)


def _plain(name: str) -> str:
    stem = re.split(r"[/\\]", name)[-1].rsplit(".", 1)[0].lower()
    stem = re.sub(r"\.rf\.[0-9a-z]+$", "", stem)  # Roboflow: room_jpg.rf.0a1b2c
    return re.sub(r"_(jpe?g|png|webp|bmp|tiff?)$", "", re.sub(r"^[0-9a-f]{8}-", "", stem))


def entries_of(boxes: Iterable[tuple[Corners | None, str, float]]) -> tuple[BoxEntry, ...]:
    """Entries of corners, words and scores, where there are corners."""
    return tuple(BoxEntry(corners, word, score) for corners, word, score in boxes if corners is not None)


def from_layout(numbers: Corners, layout: Layout) -> Corners:
    """Corners of four numbers."""
    a, b, c, d = numbers
    if layout == "sized":
        return a, b, a + c, b + d
    if layout == "rows":
        return b, a, d, c
    return (a - c / 2, b - d / 2, a + c / 2, b + d / 2) if layout == "centred" else numbers
