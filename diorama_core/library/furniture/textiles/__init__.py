"""Cushions, curtains, blinds, carpets, blankets and towels."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.textiles import blinds, curtains, cushions, linens, rugs

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        cushions,
        curtains,
        blinds,
        rugs,
        linens,
    )
    for design in kind.DESIGNS
)
