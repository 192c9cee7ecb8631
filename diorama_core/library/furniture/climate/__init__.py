"""Fireplaces, heaters, fans and air conditioners."""

from __future__ import annotations

from diorama_core.library.furniture.climate import air_conditioners, fans, fireplaces, heaters
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(fireplaces, heaters, fans, air_conditioners)
