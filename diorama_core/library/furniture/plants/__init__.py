"""Plants in pots, trees, and cut flowers."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.plants import cut_flowers, pot_plants, trees

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        pot_plants,
        trees,
        cut_flowers,
    )
    for design in kind.DESIGNS
)
