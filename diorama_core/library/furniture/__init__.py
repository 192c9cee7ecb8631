"""Parametric furniture and household things, one module per family."""

from __future__ import annotations

from diorama_core.library.furniture import bathroom, beds, kitchen, lighting, seating, storage, tables, upholstery
from diorama_core.library.furniture.model import Design

FAMILIES = (seating, upholstery, tables, beds, storage, lighting, kitchen, bathroom)


def designs() -> tuple[Design, ...]:
    """Every built-in design, in a stable order."""
    return tuple(design for family in FAMILIES for design in family.DESIGNS)
