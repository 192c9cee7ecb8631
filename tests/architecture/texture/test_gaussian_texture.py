"""Textures made anew look like their sample: same spread, same grain, no repetition."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter

from diorama_core.architecture.texture.gaussian_texture import gaussian_texture, has_lines, is_gaussian

SHAPE = (150, 220)
TINT = np.array([1.0, 0.8, 0.5])


def grain(along: float = 6.0, across: float = 1.5, seed: int = 0) -> np.ndarray:
    """Grain of wood: longer along the rows than across them, with a deviation of 8 levels."""
    noise = gaussian_filter(np.random.default_rng(seed).normal(size=SHAPE), (across, along))
    return (8.0 * noise / noise.std())[..., None].astype(np.float32) * TINT.astype(np.float32)


def corner() -> np.ndarray:
    """A sample that is no rectangle: a triangle at the upper left."""
    rows, columns = np.mgrid[: SHAPE[0], : SHAPE[1]]
    return np.asarray(rows + columns < 120)


def lag(picture: np.ndarray, rows: int, columns: int) -> float:
    """Correlation of a picture with itself, moved."""
    height, width = picture.shape
    return float(
        np.corrcoef(picture[rows:, columns:].ravel(), picture[: height - rows, : width - columns].ravel())[0, 1]
    )


def test_what_is_made_has_the_spread_and_the_grain_of_its_sample() -> None:
    detail, sample = grain(), corner()
    made = gaussian_texture(np.where(sample[..., None], detail, 1e3).astype(np.float32), sample)
    assert made.shape == detail.shape
    np.testing.assert_allclose(made.std(axis=(0, 1)), 8.0 * TINT, rtol=0.25)
    np.testing.assert_allclose(made.mean(axis=(0, 1)), 0.0, atol=2.0)
    for rows, columns in ((0, 4), (2, 0), (3, 3)):
        assert lag(made[..., 0], rows, columns) == pytest.approx(lag(detail[..., 0], rows, columns), abs=0.15)


def test_colours_stay_those_of_the_material() -> None:
    made = gaussian_texture(grain(), corner()).reshape(-1, 3)
    np.testing.assert_allclose(made / TINT, made[:, :1].repeat(3, axis=1), atol=1e-3)


def test_nothing_of_it_repeats() -> None:
    made = gaussian_texture(grain(), corner())[..., 0]
    assert max(abs(lag(made, 0, columns)) for columns in range(60, 120, 4)) < 0.3


def test_the_same_seed_gives_the_same_texture() -> None:
    np.testing.assert_array_equal(gaussian_texture(grain(), corner(), 2), gaussian_texture(grain(), corner(), 2))


def test_grain_is_gaussian_and_lines_and_two_colours_are_not() -> None:
    everywhere = np.ones(SHAPE, dtype=bool)
    lines, squares = np.zeros((*SHAPE, 3), np.float32), np.zeros((*SHAPE, 3), np.float32)
    lines[::12] = -30.0
    squares[:, ::40] = 0.0
    squares[:] = np.where((np.arange(SHAPE[1]) // 20 % 2)[None, :, None] > 0, 15.0, -15.0)
    noise = np.random.default_rng(0).normal(size=(*SHAPE, 1)).astype(np.float32)
    assert is_gaussian(grain(), corner())
    assert not is_gaussian(lines + noise, everywhere)
    assert not is_gaussian(squares + noise, everywhere)
    assert not is_gaussian(np.zeros((*SHAPE, 3), np.float32), everywhere)


def test_gaps_between_boards_are_lines_and_grain_is_not() -> None:
    boards = grain()
    boards[::14] -= 30.0
    everywhere = np.ones(SHAPE, dtype=bool)
    assert has_lines(boards, everywhere)
    assert not has_lines(grain(), everywhere)
    assert not has_lines(np.zeros((*SHAPE, 3), np.float32), everywhere)


@settings(max_examples=15)
@given(top=st.integers(0, 140), left=st.integers(0, 210), height=st.integers(1, 150), width=st.integers(1, 220))
def test_any_sample_gives_finite_colours(top: int, left: int, height: int, width: int) -> None:
    sample = np.zeros(SHAPE, dtype=bool)
    sample[top : top + height, left : left + width] = True
    made = gaussian_texture(grain(), sample)
    assert np.isfinite(made).all()
    assert made.std() < 40.0
