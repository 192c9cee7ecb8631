"""Cases with doors and drawers, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.storage import (
    cabinets,
    display_cabinets,
    dressers,
    filing_cabinets,
    lockers,
    night_stands,
    sideboards,
    tv_stands,
)

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (filing_cabinets, lockers, display_cabinets, night_stands, dressers, cabinets, sideboards, tv_stands)
    for design in kind.DESIGNS
)
