"""Tables of every height, and desks, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.tables import (
    carts,
    coffee_tables,
    console_tables,
    desks,
    dining_tables,
    gathering_tables,
    occasional_tables,
    side_tables,
    vanities,
    writing_desks,
)

KINDS = (
    dining_tables,
    gathering_tables,
    coffee_tables,
    side_tables,
    occasional_tables,
    console_tables,
    desks,
    writing_desks,
    vanities,
    carts,
)
DESIGNS: tuple[Design, ...] = tuple(design for kind in KINDS for design in kind.DESIGNS)
