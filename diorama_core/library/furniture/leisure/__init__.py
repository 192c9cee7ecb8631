"""Music, sport, books and play."""

from __future__ import annotations

from diorama_core.library.furniture.leisure import books, instruments, pianos, sports, toys
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        pianos,
        instruments,
        sports,
        books,
        toys,
    )
    for design in kind.DESIGNS
)
