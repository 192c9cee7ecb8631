"""Beds, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.beds import bunk_beds, framed_beds
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(design for kind in (framed_beds, bunk_beds) for design in kind.DESIGNS)
