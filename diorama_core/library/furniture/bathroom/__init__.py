"""Basins, lavatories, baths, showers, radiators and small things."""

from __future__ import annotations

from diorama_core.library.furniture.bathroom import accessories, basins, radiators, sanitary, showers
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(basins, sanitary, radiators, showers, accessories)
