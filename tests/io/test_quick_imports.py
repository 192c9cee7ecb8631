"""Garbage is looked for less often once a program is about to load much."""

from __future__ import annotations

import gc

from diorama_core.io.quick_imports import GARBAGE_EVERY, load_quickly


def test_garbage_is_looked_for_less_often() -> None:
    before = gc.get_threshold()
    gc.set_threshold(700, *before[1:])  # other tests of this process may have called it
    try:
        load_quickly()
        assert gc.get_threshold() == (GARBAGE_EVERY, *before[1:])
        assert gc.isenabled()
    finally:
        gc.set_threshold(*before)
