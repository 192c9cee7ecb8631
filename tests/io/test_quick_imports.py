"""Garbage is looked for less often once a program is about to load much."""

from __future__ import annotations

import gc

from diorama_core.io.quick_imports import GARBAGE_EVERY, load_quickly


def test_garbage_is_looked_for_less_often() -> None:
    before = gc.get_threshold()
    try:
        load_quickly()
        assert gc.get_threshold()[0] == GARBAGE_EVERY > before[0]
        assert gc.isenabled()
    finally:
        gc.set_threshold(*before)
