"""Outlines stay within their boxes and touch every side; sizes and covariances are proper."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.kinds import modes_of_kind, outline_of
from diorama_core.library.taxonomy import CATEGORIES

KNOWN = [c.name for c in CATEGORIES if modes_of_kind(c.name)]


def test_every_kind_is_proper() -> None:
    for name in KNOWN:
        modes = modes_of_kind(name)
        assert sum(m.share for m in modes) == pytest.approx(1, abs=0.01), name
        for mode in modes:
            assert np.linalg.eigvalsh(mode.covariance).min() > 0.05**2, name
            assert np.abs(mode.outline).max() <= 0.5, name
            assert np.abs(np.exp(mode.log_size)).max() < 5, name


@pytest.mark.parametrize("name", ["chair", "table", "sofa", "plant", "lamp", "bed"])
def test_outlines_reach_their_boxes_sides_but_not_all_corners(name: str) -> None:
    outline = outline_of(name)
    assert outline.shape == (40, 3)
    for axis in range(2):
        assert outline[:, axis].max() == pytest.approx(0.5, abs=0.02)
        assert outline[:, axis].min() == pytest.approx(-0.5, abs=0.02)
    corner = (outline @ np.array([1.0, 1.0, 1.0])).max()
    assert 0.5 < corner < 1.5


def test_what_has_no_name_has_the_mean_outline() -> None:
    assert outline_of("nothing of this name").shape == (40, 3)
