"""Music, sport, books and play."""

from __future__ import annotations

from diorama_core.library.furniture.leisure import books, instruments, pianos, sports, toys
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(pianos, instruments, sports, books, toys)
