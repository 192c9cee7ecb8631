from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, category
from diorama_core.perception.metrology.priors import SizeMode, hanging_modes, hung_modes, size_modes, supported_modes


@pytest.mark.parametrize("modes", [size_modes, supported_modes, hung_modes, hanging_modes])
def test_every_category_has_finite_modes_and_its_own_first(modes) -> None:
    for kind in CATEGORIES:
        found = modes(kind.name)
        for mode in found:
            assert np.isfinite(mode.log_size).all()
            assert (mode.sigma > 0).all()
            assert mode.cost >= 0
        if kind is not UNKNOWN:
            np.testing.assert_array_equal(found[0].log_size, kind.priors[0].log_median_xyz)
            assert found[0].cost == 0


def test_general_words_cover_more_at_a_price() -> None:
    own = len(category("table").priors)
    extra = size_modes("table")[own:]
    assert [m.cost for m in extra] == [1.5, 2.5]
    np.testing.assert_array_equal(extra[0].log_size, category("coffee table").priors[0].log_median_xyz)
    assert len(size_modes("bed")) == len(category("bed").priors)


def test_unnamed_things_are_furniture_on_the_floor_small_on_top_flat_on_walls_and_lamps_above() -> None:
    floor = size_modes(UNKNOWN.name)
    assert len(floor) > 5
    assert floor[-1].cost == max(m.cost for m in floor)
    (small,), (flat,), (lamp,) = (f(UNKNOWN.name) for f in (supported_modes, hung_modes, hanging_modes))
    assert np.exp(small.log_size).max() < 0.3
    assert np.exp(flat.log_size)[0] < 0.1
    np.testing.assert_array_equal(lamp.log_size, category("ceiling lamp").priors[0].log_median_xyz)
    assert (lamp.sigma > category("ceiling lamp").priors[0].log_sigma_xyz).all()


@pytest.mark.parametrize(("depth", "square"), [(0.5, True), (0.54, True), (0.6, False)])
def test_square_sizes_need_no_quarter_turn(depth: float, square: bool) -> None:
    assert SizeMode(np.log([depth, 0.5, 0.9]), np.ones(3), 0.0).square is square
