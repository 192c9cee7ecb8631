"""Sofas, armchairs and ottomans: what is soft, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import designs_of
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

DESIGNS = designs_of(
    sofas,
    period_sofas,
    sectional_sofas,
    modular_sofas,
    chaises,
    armchairs,
    lounge_chairs,
    recliners,
    reclining_chairs,
    rocking_chairs,
    rockers,
    ottomans,
    storage_ottomans,
    bean_bags,
)
