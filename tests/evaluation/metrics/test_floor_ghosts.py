"""Ghosts on a floor's picture: what differs from its colour, lightness in full."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.evaluation.metrics.floor_ghosts import ghost_share, usual_colour


def test_ghosts_are_what_differs_from_the_floor():
    floor = np.full((100, 100, 3), (150, 120, 90), np.uint8)
    colour = usual_colour(floor)
    assert ghost_share(floor, colour) == 0.0
    floor[:50, :40] = (40, 90, 60)
    assert ghost_share(floor, colour) == pytest.approx(0.2)
    floor[:50, :40] = (75, 60, 45)  # a dark smear of the floor's own hue
    assert ghost_share(floor, colour) == pytest.approx(0.2)
    floor[:50, :40] = (135, 108, 80)
    assert ghost_share(floor, colour) == 0.0
