from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.kinds import BROAD_SHARE, MAX_MODES, modes_of_kind
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, Category, category
from diorama_core.perception.metrology.priors import SizeMode, modes_held, plain_mode, size_modes, standing_costs


def usual_sizes(kind: Category) -> list[np.ndarray]:
    """The sizes of a category by the taxonomy, then by the library."""
    return [p.log_median_xyz for p in kind.priors] + [m.log_size for m in modes_of_kind(kind.name)[:MAX_MODES]]


def own_modes(kind: Category) -> tuple[SizeMode, ...]:
    """Without what a general word is used for besides."""
    return size_modes(kind.name)[: len(usual_sizes(kind))]


def test_every_category_has_finite_modes_and_the_cheapest_first() -> None:
    for kind in (k for k in CATEGORIES if k is not UNKNOWN):
        found = size_modes(kind.name)
        for mode in found:
            assert np.isfinite(mode.log_size).all()
            assert (mode.sigma > 0).all()
            assert np.abs(mode.outline).max() == pytest.approx(0.5)
            assert mode.cost >= found[0].cost == 0
            covariance = np.linalg.inv(mode.whitening.T @ mode.whitening)
            assert np.allclose(np.sqrt(np.diag(covariance)), mode.sigma)


def test_every_category_has_the_sizes_of_the_taxonomy_and_of_the_library() -> None:
    for kind in CATEGORIES:
        if kind is not UNKNOWN:
            found = own_modes(kind)
            assert [m.cost for m in found] == sorted(m.cost for m in found)
            expected = sorted(size.tolist() for size in usual_sizes(kind))
            assert sorted(m.log_size.tolist() for m in found) == expected


def test_costs_are_log_densities_of_a_mixture_with_the_taxonomys_share() -> None:
    kinds = [k for k in CATEGORIES if k is not UNKNOWN and 0 < len(modes_of_kind(k.name)) <= MAX_MODES]
    assert len(kinds) > 50
    for kind in kinds:
        shares = {tuple(m.log_size): np.exp(-m.cost / 2) / abs(np.linalg.det(m.whitening)) for m in own_modes(kind)}
        broad = sum(shares[tuple(p.log_median_xyz)] for p in kind.priors)
        # The library's shares are rounded to thousandths.
        assert broad / sum(shares.values()) == pytest.approx(BROAD_SHARE, abs=2e-3)


def test_general_words_cover_more_at_a_price() -> None:
    extra = size_modes("table")[len(own_modes(category("table"))) :]
    assert [m.cost for m in extra] == [1.5, 2.5]
    np.testing.assert_array_equal(extra[0].log_size, category("coffee table").priors[0].log_median_xyz)
    assert len(size_modes("bed")) == len(own_modes(category("bed")))


@pytest.mark.parametrize(("depth", "square"), [(0.5, True), (0.54, True), (0.6, False)])
def test_square_sizes_need_no_quarter_turn(depth: float, square: bool) -> None:
    assert plain_mode(np.log([depth, 0.5, 0.9]), np.ones(3), 0.0, "chair").square is square


def test_what_a_word_may_mean_here_takes_the_place_of_what_it_is_said_of() -> None:
    meanings = (("cabinet", 0.6), ("sideboard", 0.3), ("wall cabinet", 0.08), ("locker", 0.001))
    own = len(own_modes(category("cabinet")))
    extra = size_modes("cabinet", meanings)[own:]
    assert len(extra) == 1, "what hangs on walls does not stand here, and lockers are too rare"
    np.testing.assert_array_equal(extra[0].log_size, size_modes("sideboard")[0].log_size)
    assert extra[0].cost >= 0
    likelier = size_modes("cabinet", (("sideboard", 0.6), ("cabinet", 0.3)))[own:]
    assert likelier[0].cost <= extra[0].cost


def test_a_thing_without_a_name_has_the_sizes_of_what_it_may_be_where_it_is_held() -> None:
    meanings = (("picture", 0.4), ("chair", 0.3), ("ceiling lamp", 0.2), ("vase", 0.1), ("desk", 0.05))
    for mount, kind in (("wall", "picture"), ("ceiling", "ceiling lamp"), ("surface", "vase")):
        (found,) = modes_held(UNKNOWN.name, meanings, mount)
        assert found.log_size.tolist() == size_modes(kind)[0].log_size.tolist()
    chair, desk, anything = size_modes(UNKNOWN.name, meanings)
    assert chair.log_size.tolist() == size_modes("chair")[0].log_size.tolist()
    assert chair.cost == 0 < desk.cost
    assert anything.cost > 0


def test_small_plants_stand_on_furniture_and_tall_ones_on_the_floor() -> None:
    small, tall = (plain_mode(np.log([0.2, 0.2, h]), np.full(3, 0.2), 0.0, "plant") for h in (0.25, 1.5))
    assert standing_costs("plant", small)[0] > 3 > 0.5 > standing_costs("plant", small)[1]
    assert standing_costs("plant", tall)[1] > 3 > 0.5 > standing_costs("plant", tall)[0]
    assert standing_costs("chair", small) == (0.0, 0.0)
