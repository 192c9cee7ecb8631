"""Cases with doors and drawers, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import designs_of
from diorama_core.library.furniture.storage import (
    cabinets,
    case_pieces,
    chests,
    display_cabinets,
    dressers,
    filing_cabinets,
    lockers,
    night_stands,
    sideboards,
    special_cabinets,
    tv_stands,
)

DESIGNS = designs_of(
    night_stands,
    dressers,
    cabinets,
    case_pieces,
    filing_cabinets,
    lockers,
    display_cabinets,
    special_cabinets,
    sideboards,
    tv_stands,
    chests,
)
