"""Bookcases, wall shelves and wardrobes, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.shelving import bookcases, wall_shelves, wardrobes

DESIGNS: tuple[Design, ...] = tuple(design for kind in (bookcases, wardrobes, wall_shelves) for design in kind.DESIGNS)
