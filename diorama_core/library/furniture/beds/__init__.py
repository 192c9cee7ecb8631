"""Beds for one, two and the very young, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.beds import (
    bedsteads,
    bunk_beds,
    day_beds,
    framed_beds,
    nursery,
    stacked_beds,
)
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(framed_beds, bedsteads, bunk_beds, stacked_beds, day_beds, nursery)
