"""Outlines stay within their boxes and touch every side; sizes and covariances are proper."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.kinds import BROAD_SHARE, modes_of_kind, outline_of, size_density, sizes_of_kind
from diorama_core.library.taxonomy import CATEGORIES, category

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


def test_shares_add_up_to_those_of_the_library_that_are_used_and_the_taxonomys() -> None:
    for kind in CATEGORIES:
        parts = sizes_of_kind(kind.name)
        assert BROAD_SHARE - 1e-9 <= sum(p.share for p in parts) <= 1.0 + 5e-3
        assert all(np.linalg.eigvalsh(p.covariance).min() > 0 for p in parts)


def test_the_usual_size_is_denser_than_others_either_way_round() -> None:
    usual = np.exp(category("sofa").priors[0].log_median_xyz)
    dense = size_density("sofa", usual, 0.2)
    assert dense == pytest.approx(size_density("sofa", usual[[1, 0, 2]], 0.2))
    for factor in (0.5, 2.0):
        assert size_density("sofa", factor * usual, 0.2) < 0.1 * dense


def test_what_is_measured_badly_says_less() -> None:
    small = 0.5 * np.exp(category("sofa").priors[0].log_median_xyz)
    sharp, blurred = (size_density("sofa", small, s) / size_density("sofa", 2 * small, s) for s in (0.1, 0.6))
    assert sharp < blurred < 1
