"""Kitchen furniture and machines, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.kitchen import cookers, counters, laundry, microwaves, refrigerators
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(
    design for kind in (refrigerators, cookers, laundry, counters, microwaves) for design in kind.DESIGNS
)
