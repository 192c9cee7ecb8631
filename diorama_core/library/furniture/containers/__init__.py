"""Boxes, baskets, bins and luggage."""

from __future__ import annotations

from diorama_core.library.furniture.containers import baskets, bins, boxes, luggage
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(boxes, baskets, bins, luggage)
