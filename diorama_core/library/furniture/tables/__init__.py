"""Tables of every height, and desks, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.tables import coffee_tables, console_tables, desks, dining_tables, side_tables

DESIGNS: tuple[Design, ...] = tuple(
    design for kind in (dining_tables, side_tables, coffee_tables, desks, console_tables) for design in kind.DESIGNS
)
