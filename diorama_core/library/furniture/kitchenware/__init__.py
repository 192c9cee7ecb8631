"""What is cooked with, eaten from and drunk from."""

from __future__ import annotations

from diorama_core.library.furniture.kitchenware import bottles, bowls, cups, glasses, jars
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        bowls,
        cups,
        glasses,
        bottles,
        jars,
    )
    for design in kind.DESIGNS
)
