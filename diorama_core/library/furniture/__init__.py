"""Parametric furniture and household things, one module per family."""

from __future__ import annotations

from diorama_core.library.furniture import bathroom, beds, electronics, kitchen, lighting, openings, plants, seating, smallware, storage, tables, textiles, upholstery
from diorama_core.library.furniture.model import Design

FAMILIES = (seating, upholstery, tables, beds, storage, lighting, kitchen, bathroom, electronics, textiles, plants, smallware, openings)


def designs() -> tuple[Design, ...]:
    """Every built-in design, in a stable order."""
    return tuple(design for family in FAMILIES for design in family.DESIGNS)
