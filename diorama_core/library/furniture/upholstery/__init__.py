"""Sofas, armchairs and ottomans: what is soft, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.upholstery import (
    armchairs,
    ottomans,
    recliners,
    rocking_chairs,
    sectional_sofas,
    sofas,
)

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (sofas, sectional_sofas, armchairs, rocking_chairs, ottomans, recliners)
    for design in kind.DESIGNS
)
