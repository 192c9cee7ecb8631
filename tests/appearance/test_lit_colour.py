"""Which of a surface's colours is its material's."""

from __future__ import annotations

import cv2
import numpy as np

from diorama_core.appearance.lit_colour import is_glossed, is_shade, select_material_colour
from diorama_core.io.srgb import linear_to_srgb


def lab(*linear: float) -> np.ndarray:
    rgb = linear_to_srgb(np.array(linear)).astype(np.float32)
    return cv2.cvtColor(rgb[None, None], cv2.COLOR_RGB2Lab)[0, 0]


WHITE, GREY = lab(0.8, 0.8, 0.78), lab(0.2, 0.2, 0.195)
WALNUT, GLOSSY = lab(0.10, 0.03, 0.02), lab(0.29, 0.22, 0.21)
RED, BLUE = lab(0.4, 0.05, 0.04), lab(0.04, 0.06, 0.3)


def test_a_shade_gives_way_to_the_lit_colour() -> None:
    assert is_shade(GREY, WHITE)
    np.testing.assert_array_equal(select_material_colour(GREY, [GREY, WHITE]), WHITE)
    np.testing.assert_array_equal(select_material_colour(WHITE, [GREY]), WHITE)


def test_gloss_gives_way_to_the_bare_colour() -> None:
    assert is_glossed(GLOSSY, WALNUT)
    np.testing.assert_array_equal(select_material_colour(GLOSSY, [WALNUT]), WALNUT)
    np.testing.assert_array_equal(select_material_colour(WALNUT, [GLOSSY]), WALNUT)


def test_other_colours_are_neither() -> None:
    for one, other in ((RED, BLUE), (BLUE, RED), (WALNUT, WHITE), (RED, WHITE)):
        assert not is_shade(one, other)
        np.testing.assert_array_equal(select_material_colour(one, [other]), one)
    assert not is_glossed(WHITE, GREY)
    assert not is_glossed(WHITE, BLUE)
