"""What a program does before it loads large libraries, so that they load sooner."""

from __future__ import annotations

import gc

GARBAGE_EVERY = 10_000
"""New objects between two searches for garbage: nearly all that importing makes stays, so the usual 700 cost time."""


def load_quickly() -> None:
    """Look for garbage less often."""
    gc.set_threshold(GARBAGE_EVERY)
