"""What the shipped recogniser makes of pictures of any size, and of weights that are not there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.errors import UnavailableError
from diorama_core.io.assets import FOLDER
from diorama_core.models.images import CROP_SIDE, box_crop, box_geometry
from diorama_core.models.recogniser import Recogniser, fit, own_recogniser


@given(width=st.integers(20, 400), height=st.integers(20, 400))
@settings(max_examples=25)
def test_any_picture_is_fitted_into_whole_cells(width: int, height: int) -> None:
    pixels, scale = fit(np.full((height, width, 3), 200, np.uint8), 64 * 96)
    assert pixels.shape[2] % 32 == 0
    assert pixels.shape[3] % 32 == 0
    assert abs(width * scale - pixels.shape[3]) <= 33
    assert abs(height * scale - pixels.shape[2]) <= 33
    assert pixels[0, 0, 0, 0] == pytest.approx(200 / 255, abs=1e-3)


def test_a_crop_has_its_box_in_the_middle() -> None:
    rgb = np.zeros((200, 300, 3), np.uint8)
    rgb[60:140, 100:140] = 255
    crop = box_crop(rgb, np.array([100.0, 60.0, 140.0, 140.0]))
    assert crop.shape == (CROP_SIDE, CROP_SIDE, 3)
    bright = np.argwhere(crop[..., 0] > 128)
    assert np.abs(bright.mean(axis=0) - (CROP_SIDE - 1) / 2).max() < 1.0
    assert 0.45 < np.ptp(bright[:, 1]) / np.ptp(bright[:, 0]) < 0.55


def test_geometry_does_not_depend_on_the_pictures_resolution() -> None:
    box = np.array([30.0, 40.0, 90.0, 100.0])
    np.testing.assert_allclose(box_geometry(box, 200, 150), box_geometry(box * 3, 600, 450), atol=1e-6)


def test_missing_weights_are_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(UnavailableError, match="is missing") as error:
        Recogniser.of(tmp_path)
    assert "\n" not in str(error.value)


@pytest.mark.skipif(not (FOLDER / "recogniser.json").exists(), reason="no weights are shipped")
def test_the_shipped_weights_find_the_examples_furniture() -> None:
    from diorama_app.projects.example import example_inputs
    from diorama_core.models.boxes import overlaps

    inputs = example_inputs().inputs
    recogniser = own_recogniser()
    found = recogniser.propose(inputs.photo.rgb, 0.05, 20)
    known = np.array([b.box for b in inputs.boxes])
    assert (overlaps(found.boxes, known).max(axis=0) > 0.5).mean() > 0.25
    named = recogniser.name(inputs.photo.rgb, known)
    np.testing.assert_allclose(named.sum(axis=1), 1.0, atol=1e-5)
