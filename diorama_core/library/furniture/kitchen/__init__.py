"""Kitchen furniture and machines, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.kitchen import (
    appliances,
    cookers,
    counters,
    islands,
    laundry,
    microwaves,
    refrigerators,
)
from diorama_core.library.furniture.model import Design

KINDS = (refrigerators, cookers, laundry, appliances, counters, islands, microwaves)
DESIGNS: tuple[Design, ...] = tuple(design for kind in KINDS for design in kind.DESIGNS)
