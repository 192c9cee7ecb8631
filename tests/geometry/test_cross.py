from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.cross import cross

vector = st.tuples(*[st.floats(-1e3, 1e3)] * 3).map(np.array)


@given(vector, vector)
def test_it_is_numpys_vector_product(a, b) -> None:
    np.testing.assert_array_equal(cross(a, b), np.cross(a, b))


def test_it_broadcasts_over_the_last_axis(rng) -> None:
    a, b = rng.normal(size=(4, 1, 3)), rng.normal(size=(5, 3))
    np.testing.assert_allclose(cross(a, b), np.cross(a, b), rtol=1e-12)
    np.testing.assert_allclose(cross(a[:, 0], b[0]), np.cross(a[:, 0], b[0]), rtol=1e-12)
