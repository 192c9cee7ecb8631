"""Basins, lavatories, baths, showers, radiators and small things."""

from __future__ import annotations

from diorama_core.library.furniture.bathroom import accessories, basins, radiators, sanitary, showers
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        basins,
        sanitary,
        radiators,
        showers,
        accessories,
    )
    for design in kind.DESIGNS
)
