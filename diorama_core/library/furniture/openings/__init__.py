"""Windows and doors."""

from __future__ import annotations

from diorama_core.library.furniture.model import designs_of
from diorama_core.library.furniture.openings import doors, windows

DESIGNS = designs_of(windows, doors)
