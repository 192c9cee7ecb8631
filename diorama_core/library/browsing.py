"""What a catalogue shows: shapes by category, style and size, from all of them or a shelf of one's own."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Literal

from diorama_core.library.record import Shape
from diorama_core.library.taxonomy import ROOMS

Shelf = Literal["all", "favourites", "recent", "own"]
SizeClass = Literal["small", "medium", "large"]
SIZES_M: dict[SizeClass, tuple[float, float]] = {"small": (0.0, 0.5), "medium": (0.5, 1.5), "large": (1.5, 1e9)}
"""Longest side of a shape, from and below."""


@dataclass(frozen=True)
class Filters:
    """What is asked for; empty fields ask for nothing."""

    shelf: Shelf = "all"
    category: str = ""
    room: str = ""
    """One of `company.ROOMS`: only kinds that are met there more often than elsewhere."""
    style: str = ""
    size: SizeClass | None = None
    fitting: bool = False
    """Only what finds a place in the room."""

    @property
    def any(self) -> bool:
        """Whether anything is asked for."""
        return self != Filters()


def browse(
    shapes: Sequence[Shape],
    filters: Filters,
    *,
    favourites: Sequence[str] = (),
    recent: Sequence[str] = (),
    is_own: Callable[[str], bool] = lambda shape_id: False,
    has_place: Callable[[Shape], bool] = lambda shape: True,
) -> tuple[Shape, ...]:
    """The shapes that pass the filters, in their order; on the shelf of recent ones the last used first.

    Args:
        shapes: all there are, or those that words found.
        filters: what is asked for.
        favourites: ids that the person has marked.
        recent: ids used lately, the last first.
        is_own: whether a shape is the person's own model.
        has_place: whether a shape finds a place in the room; asked last, of what passes everything else.
    """
    marked: Collection[str] = frozenset(favourites)
    low, high = SIZES_M[filters.size] if filters.size is not None else (0.0, float("inf"))
    matches = [
        s
        for s in shapes
        if (filters.shelf != "favourites" or s.id in marked)
        and (filters.shelf != "recent" or s.id in recent)
        and (filters.shelf != "own" or is_own(s.id))
        and filters.category in ("", s.category)
        and (not filters.room or s.category in ROOMS[filters.room])
        and filters.style in ("", s.style)
        and low <= max(s.size_m) < high
        and (not filters.fitting or has_place(s))
    ]
    if filters.shelf == "recent":
        rank = {shape_id: number for number, shape_id in enumerate(recent)}
        matches.sort(key=lambda s: rank[s.id])
    return tuple(matches)


def one_of_each(shapes: Sequence[Shape]) -> tuple[Shape, ...]:
    """The first shape of every category."""
    firsts: dict[str, Shape] = {}
    for shape in shapes:
        firsts.setdefault(shape.category, shape)
    return tuple(firsts.values())
