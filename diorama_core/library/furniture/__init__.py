"""Parametric furniture and household things, one module per family."""

from __future__ import annotations

from diorama_core.library.furniture import (
    bathroom,
    beds,
    climate,
    containers,
    decor,
    electronics,
    kitchen,
    kitchenware,
    leisure,
    lighting,
    openings,
    plain,
    plants,
    seating,
    shelving,
    storage,
    tables,
    textiles,
    upholstery,
)
from diorama_core.library.furniture.model import Design, designs_of

FAMILIES = (
    seating,
    upholstery,
    tables,
    beds,
    storage,
    shelving,
    lighting,
    kitchen,
    bathroom,
    electronics,
    leisure,
    textiles,
    plants,
    kitchenware,
    decor,
    containers,
    openings,
    plain,
    climate,
)


def designs() -> tuple[Design, ...]:
    """Every built-in design, in a stable order."""
    return designs_of(*FAMILIES)
