"""Bookcases, wall shelves, wardrobes and hall stands, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import designs_of
from diorama_core.library.furniture.shelving import (
    bookcases,
    hall_pieces,
    racks,
    wall_shelves,
    wardrobes,
)

DESIGNS = designs_of(bookcases, racks, wardrobes, wall_shelves, hall_pieces)
