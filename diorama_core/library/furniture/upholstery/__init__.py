"""Sofas, armchairs and ottomans: what is soft, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.upholstery import (
    armchairs,
    bean_bags,
    chaises,
    lounge_chairs,
    modular_sofas,
    ottomans,
    period_sofas,
    recliners,
    reclining_chairs,
    rockers,
    rocking_chairs,
    sectional_sofas,
    sofas,
    storage_ottomans,
)

KINDS = (
    *(sofas, period_sofas, sectional_sofas, modular_sofas, chaises),
    *(armchairs, lounge_chairs, recliners, reclining_chairs, rocking_chairs, rockers),
    *(ottomans, storage_ottomans, bean_bags),
)
DESIGNS: tuple[Design, ...] = tuple(design for kind in KINDS for design in kind.DESIGNS)
