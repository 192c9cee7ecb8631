"""Bookcases, wall shelves, wardrobes and hall stands, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.shelving import (
    bookcases,
    hall_pieces,
    racks,
    wall_shelves,
    wardrobes,
)

KINDS = (bookcases, racks, wardrobes, wall_shelves, hall_pieces)
DESIGNS: tuple[Design, ...] = tuple(design for kind in KINDS for design in kind.DESIGNS)
