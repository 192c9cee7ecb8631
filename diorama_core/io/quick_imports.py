"""What a program does before it loads large libraries, so that they load sooner."""

from __future__ import annotations

import gc
from importlib import import_module

GARBAGE_EVERY = 10_000
"""New objects between two searches for garbage: nearly all that importing makes stays, so the usual 700 cost time."""
_PLACE, _DECORATOR = "scipy._lib._array_api", "xp_capabilities"


def load_quickly() -> None:
    """Look for garbage less often, and let SciPy load without rewriting its documentation.

    SciPy 1.16 and later parse the texts of some four hundred functions while they are imported and add a table to each
    (`xp_capabilities`): a tenth of a second. Other versions load as they do.
    """
    gc.set_threshold(GARBAGE_EVERY)
    try:
        place = import_module(_PLACE)
    except ImportError:
        return
    if hasattr(place, _DECORATOR):
        setattr(place, _DECORATOR, lambda **_: lambda function: function)
