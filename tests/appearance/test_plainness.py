from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.appearance.plainness import contrast, shows_plain
from diorama_core.appearance.surface_view import surface_view
from diorama_core.library.slots import slots_of
from diorama_core.scene.types import Pose
from tests.appearance.test_surface_view import CAMERA, parts

WEAVE = np.random.default_rng(1).integers(80, 170, (24, 24, 3)).astype(np.uint8)


@pytest.fixture(scope="module")
def view():
    found = surface_view(parts(), slots_of(parts()), Pose.upright((0.0, 0.0, 0.0)), CAMERA, np.ones((150, 200), bool))
    assert found is not None
    return found


def test_a_smooth_surface_is_plainer_than_a_weave_and_a_woven_one_is_not(view) -> None:
    smooth = np.full((150, 200, 3), 120, np.uint8)
    woven = cv2.resize(np.tile(WEAVE, (4, 5, 1)), (200, 150), interpolation=cv2.INTER_NEAREST)
    assert shows_plain(view, view.slot >= 0, smooth, WEAVE, 0.3)
    assert not shows_plain(view, view.slot >= 0, woven, WEAVE, 0.3)


def test_a_weave_too_fine_to_be_seen_is_kept(view) -> None:
    smooth = np.full((150, 200, 3), 120, np.uint8)
    assert not shows_plain(view, view.slot >= 0, smooth, WEAVE, 0.03)


def test_too_few_pixels_tell_nothing(view) -> None:
    few = np.zeros(view.slot.shape, dtype=bool)
    few[70:80, 90:100] = True
    assert not shows_plain(view, few, np.full((150, 200, 3), 120, np.uint8), WEAVE, 0.3)


@given(st.floats(0.2, 1.0), st.integers(0, 99))
def test_contrast_does_not_depend_on_brightness(factor: float, seed: int) -> None:
    grey = np.random.default_rng(seed).uniform(60, 200, (30, 30)).astype(np.float32)
    where = np.ones((30, 30), dtype=bool)
    assert contrast(factor * grey, where) == pytest.approx(contrast(grey, where), rel=1e-3)
