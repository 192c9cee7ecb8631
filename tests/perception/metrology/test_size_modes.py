"""Size modes are a proper mixture; portable things stand where their size belongs."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.perception.metrology.priors import plain_mode, size_modes, standing_costs


@pytest.mark.parametrize("name", ["chair", "table", "bed", "plant", "television"])
def test_modes_are_ranked_and_whitened(name: str) -> None:
    modes = size_modes(name)
    assert min(m.cost for m in modes) == 0
    for mode in modes:
        covariance = np.linalg.inv(mode.whitening.T @ mode.whitening)
        assert np.allclose(np.sqrt(np.diag(covariance)), mode.sigma)


def test_small_plants_stand_on_furniture_and_tall_ones_on_the_floor() -> None:
    small, tall = (plain_mode(np.log([0.2, 0.2, h]), np.full(3, 0.2), 0.0, "plant") for h in (0.25, 1.5))
    assert standing_costs("plant", small)[0] > 3 > 0.5 > standing_costs("plant", small)[1]
    assert standing_costs("plant", tall)[1] > 3 > 0.5 > standing_costs("plant", tall)[0]
    assert standing_costs("chair", small) == (0.0, 0.0)
