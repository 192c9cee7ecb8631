"""Music, sport, books and play."""

from __future__ import annotations

from diorama_core.library.furniture.leisure import pianos
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(design for kind in (pianos,) for design in kind.DESIGNS)
