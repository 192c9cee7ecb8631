from __future__ import annotations

import numpy as np

from diorama_core.export.xml_values import inertia_terms, numbers, srgb_rgba
from diorama_core.render.appearance import Material


def test_numbers_and_inertia_are_read_back() -> None:
    values = np.array([1.0, -0.25, 1e-7, 123456.789])
    np.testing.assert_allclose(np.array(numbers(values).split(), float), values, rtol=1e-8)
    tensor = np.array([[1.0, 0.1, 0.2], [0.1, 2.0, 0.3], [0.2, 0.3, 3.0]])
    assert {k: float(v) for k, v in inertia_terms(tensor).items()} == {
        "ixx": 1.0, "ixy": 0.1, "ixz": 0.2, "iyy": 2.0, "iyz": 0.3, "izz": 3.0,
    }  # fmt: skip


def test_colours_are_display_values() -> None:
    np.testing.assert_allclose(
        srgb_rgba(Material("x", (0.0, 0.2158605, 1.0), alpha=0.5)), [0, 0.50196, 1, 0.5], atol=1e-4
    )
