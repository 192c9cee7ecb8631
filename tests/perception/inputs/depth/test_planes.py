"""Numbers and the inverse depth that they stand for become one another."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.perception.inputs.depth.planes import DEPTH, INVERSE, ROOT, DepthFunction

NUMBERS = np.linspace(0.3, 4.0, 20)


@pytest.mark.parametrize("function", [DEPTH, INVERSE, ROOT, DepthFunction(offset=0.7), DepthFunction(rate=1.3)])
def test_there_and_back(function: DepthFunction) -> None:
    inverse = function.inverse_depth(NUMBERS)
    np.testing.assert_allclose(function.numbers(inverse), NUMBERS)
    larger = function.scale(10.0).inverse_depth(10.0 * NUMBERS)
    assert np.ptp(np.log(larger / inverse)) < 1e-9
    assert np.isinf(function.numbers(np.array([-1.0, 0.0]))).all()
