"""What is cooked with, eaten from and drunk from."""

from __future__ import annotations

from diorama_core.library.furniture.kitchenware import (
    blenders,
    bottles,
    bowls,
    coffee_machines,
    cookware,
    cups,
    glasses,
    jars,
    kettles,
)
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(bowls, cups, glasses, bottles, jars, kettles, coffee_machines, blenders, cookware)
