"""What is there to be looked at."""

from __future__ import annotations

from diorama_core.library.furniture.decor import vases
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(design for kind in (vases,) for design in kind.DESIGNS)
