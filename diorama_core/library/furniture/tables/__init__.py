"""Tables of every height, and desks, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import designs_of
from diorama_core.library.furniture.tables import (
    carts,
    coffee_tables,
    console_tables,
    desks,
    dining_tables,
    gathering_tables,
    occasional_tables,
    plain_tables,
    shelved_desks,
    side_tables,
    vanities,
    writing_desks,
)

DESIGNS = designs_of(
    dining_tables,
    gathering_tables,
    coffee_tables,
    side_tables,
    occasional_tables,
    plain_tables,
    console_tables,
    desks,
    writing_desks,
    shelved_desks,
    vanities,
    carts,
)
