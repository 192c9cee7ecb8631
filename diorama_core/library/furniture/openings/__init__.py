"""Windows and doors."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.openings import doors, windows

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        windows,
        doors,
    )
    for design in kind.DESIGNS
)
