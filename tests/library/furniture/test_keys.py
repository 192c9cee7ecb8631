"""Keyboards and keypads: as many keys as they should have, in their places."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.keys import keypad, keys_of, piano_keys, spread
from diorama_core.library.furniture.solids import Solid, box

KEY = box((0.01, 0.01, 0.004), 0.001)


def centre(solid: Solid) -> np.ndarray:
    return (solid.vertices.min(axis=0) + solid.vertices.max(axis=0)) / 2


@given(st.integers(1, 12), st.floats(0.005, 0.1), st.floats(-1.0, 1.0))
def test_places_are_even_and_round_their_middle(count: int, pitch: float, middle: float) -> None:
    places = np.array(spread(count, pitch, middle))
    assert places.mean() == pytest.approx(middle, abs=1e-9)
    assert np.allclose(np.diff(places), pitch)


def test_a_keypad_has_a_key_at_every_crossing() -> None:
    keys = keypad(KEY, [(0.0, 0.1), (0.02, 0.1)], spread(3, 0.02))
    places = {tuple(np.round(centre(k)[:2], 6) + 0.0) for k in keys}
    assert places == {(x, y) for x in (0.0, 0.02) for y in (-0.02, 0.0, 0.02)}
    assert all(np.ptp(k.vertices, axis=0) == pytest.approx([0.01, 0.01, 0.004]) for k in keys)


def test_a_keyboard_has_a_row_with_the_space_bar_and_full_rows() -> None:
    parts = keys_of(0.12, 0.4, 5, 13, 0.0, 0.01, m.BLACK)
    assert len(parts) == 5 + 4 * 13
    widest = max(parts, key=lambda p: float(np.ptp(p.solid.vertices[:, 1])))
    assert centre(widest.solid)[0] == max(centre(p.solid)[0] for p in parts)  # toward the typist
    points = np.concatenate([p.solid.vertices for p in parts])
    assert np.abs(points[:, :2]).max(axis=0) == pytest.approx([0.06, 0.2], abs=0.004)


def test_a_piano_has_52_white_keys_and_black_ones_in_twos_and_threes() -> None:
    parts = piano_keys(-0.6, 0.023, (0.14, 0.021, 0.02), (0.0, 0.0), (0.09, 0.011, 0.012), (-0.02, 0.02))
    white, black = ([centre(p.solid)[1] for p in parts if p.material == k] for k in (m.WHITE, m.BLACK))
    assert len(white) == 52
    assert white[0] == pytest.approx(-0.6 + 0.0115)
    gaps = "".join(str(round(g)) for g in np.diff(black) / 0.023)
    assert gaps.startswith("12112121121211")  # two, a gap, three, a gap
