"""Fireplaces, heaters, fans and air conditioners."""

from __future__ import annotations

from diorama_core.library.furniture.climate import air_conditioners, fans, fireplaces, heaters
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        fireplaces,
        heaters,
        fans,
        air_conditioners,
    )
    for design in kind.DESIGNS
)
