"""Cushions, curtains, blinds, carpets, blankets and towels."""

from __future__ import annotations

from diorama_core.library.furniture.model import designs_of
from diorama_core.library.furniture.textiles import blinds, curtains, cushions, linens, rugs

DESIGNS = designs_of(cushions, curtains, blinds, rugs, linens)
