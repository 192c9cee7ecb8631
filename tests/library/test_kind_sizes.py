from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.kind_sizes import BROAD_SHARE, size_density, sizes_of_kind
from diorama_core.library.taxonomy import CATEGORIES, category


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
