"""Cases as a style would have them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from diorama_core.library.furniture.kit import *


def styled_case(size: Size, style: Style, bays: Sequence[Cell], **changes: Any) -> Parts:
    """A case of bays in a style's wood, on its feet, with its fronts and handles; `changes` go to `case`."""
    options: dict[str, Any] = {
        "pull": style.fitting,
        "handle": style.handle,
        "base": style.base,
        "base_h": style.base_h,
        "legs": style.frame,
        "top": style.top,
        "panel": style.panel,
        "infill": style.infill,
    }
    return case(size, style.wood, bays, **{**options, **changes})
