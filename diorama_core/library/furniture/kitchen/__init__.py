"""Kitchen furniture and machines, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.kitchen import (
    appliances,
    cookers,
    counters,
    islands,
    laundry,
    microwaves,
    refrigerators,
)
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(refrigerators, cookers, laundry, appliances, counters, islands, microwaves)
