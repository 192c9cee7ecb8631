"""Screens, computers, sound and small devices."""

from __future__ import annotations

from diorama_core.library.furniture.electronics import computers, gadgets, printers, screens, sound
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(screens, computers, printers, sound, gadgets)
