"""Plants in pots, trees, and cut flowers."""

from __future__ import annotations

from diorama_core.library.furniture.model import designs_of
from diorama_core.library.furniture.plants import cut_flowers, pot_plants, trees

DESIGNS = designs_of(pot_plants, trees, cut_flowers)
