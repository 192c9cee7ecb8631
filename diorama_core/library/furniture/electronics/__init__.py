"""Screens, computers, sound and small devices."""

from __future__ import annotations

from diorama_core.library.furniture.electronics import computers, gadgets, printers, screens, sound
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        screens,
        computers,
        printers,
        sound,
        gadgets,
    )
    for design in kind.DESIGNS
)
