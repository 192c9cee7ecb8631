from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.labels import meanings
from diorama_core.library.taxonomy import category
from diorama_core.retrieval.measured_sizes import as_measured


def likely(word: str, size_m) -> dict[str, float]:
    found = as_measured(meanings(word, word), np.array(size_m))
    whole = sum(found.values())
    return {kind: value / whole for kind, value in found.items()}


@pytest.mark.parametrize(
    ("word", "kind"),
    [("table", "coffee table"), ("table", "side table"), ("table", "table"), ("cabinet", "sideboard"),
     ("cabinet", "wardrobe"), ("cabinet", "night stand"), ("lamp", "floor lamp"), ("chair", "armchair")],
)  # fmt: skip
def test_a_size_makes_kinds_that_are_so_large_likelier(word, kind) -> None:
    size_m = np.exp(category(kind).priors[0].log_median_xyz)
    assert likely(word, size_m)[kind] > 1.25 * meanings(word, word)[kind]


def test_width_and_depth_may_have_changed_places() -> None:
    assert likely("table", (0.4, 1.2, 0.8)) == pytest.approx(likely("table", (1.2, 0.4, 0.8)))


def test_a_size_that_fits_nothing_leaves_every_kind_possible() -> None:
    for size_m in ((30.0, 30.0, 30.0), (0.0, 0.0, 0.0)):
        found = likely("table", size_m)
        assert all(0 < share < 1 for share in found.values())
