from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.kind_sizes import BROAD_COUNT, size_density, sizes_of_kind
from diorama_core.library.taxonomy import CATEGORIES, category


def test_the_taxonomy_counts_as_some_shapes_of_the_library() -> None:
    for kind in CATEGORIES:
        parts = sizes_of_kind(kind.name)
        assert sum(p.share for p in parts) == pytest.approx(1.0)
        broad, count = parts[: len(kind.priors)], sum(p.count for p in parts)
        assert sum(p.share for p in broad) == pytest.approx(BROAD_COUNT / (BROAD_COUNT + count))
        assert all(np.linalg.eigvalsh(p.covariance).min() > 0 for p in parts)


def test_most_tables_are_of_one_height() -> None:
    tall = max(sizes_of_kind("table"), key=lambda p: p.share)
    assert np.exp(tall.log_size[2]) == pytest.approx(0.75, abs=0.02)
    assert np.sqrt(tall.covariance[2, 2]) < 0.07


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
