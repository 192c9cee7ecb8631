"""What nobody saw of a surface: shading goes on smoothly, detail is copied, things before it are not."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter

from diorama_core.architecture.texture.continuation import complete_texture, gaussian_texture, has_lines, is_gaussian

SHAPE = (150, 220)
TINT = np.array([1.0, 0.8, 0.5])


def test_hidden_parts_are_filled_without_steps():
    seen = np.ones((60, 80), dtype=bool)
    seen[20:40, 30:50] = False
    colours = np.full((60, 80, 3), 120.0, np.float32)
    filled = complete_texture(colours, seen, (120 / 255,) * 3, 0.02, seen)
    assert np.abs(filled.astype(int) - 120).max() <= 2


def test_what_nobody_saw_is_the_plain_colour():
    seen = np.zeros((50, 400), dtype=bool)
    seen[:, :30] = True
    colours = np.full((50, 400, 3), 200.0, np.float32)
    filled = complete_texture(colours, seen, (0.2, 0.2, 0.2), 0.05, seen)
    assert np.abs(filled[:, -1].astype(int) - 51).max() <= 2
    assert np.abs(filled[:, 5].astype(int) - 200).max() <= 4


def boards(height=300, width=400, period=14):
    """A floor of boards 14 texels wide with dark joints."""
    picture = np.full((height, width, 3), 160.0, np.float32)
    picture[:, np.arange(width) % period < 2] = 110.0
    return picture


def test_boards_continue_where_nobody_saw_the_floor():
    colours, seen = boards(), np.zeros((300, 400), dtype=bool)
    seen[100:220, 100:260] = True
    filled = complete_texture(colours, seen, (0.6, 0.6, 0.6), 0.01, seen, ground=True).astype(float)
    unseen = filled[:, 300:384, 0] - filled[:, 300:384, 0].mean(axis=1, keepdims=True)
    # Along most rows the variation lives at the boards' period: six of them in 84 texels.
    spectrum = np.abs(np.fft.rfft(unseen, axis=1))
    assert np.median(spectrum[:, 6] / spectrum[:, 1:6].max(axis=1)) > 1.5


def test_a_poster_stays_where_it_is_and_is_not_copied():
    rng = np.random.default_rng(0)
    colours = (150 + rng.normal(0, 2, (300, 400, 1)) + np.zeros(3)).astype(np.float32)
    colours[120:170, 140:180] = (230.0, 20.0, 40.0)
    seen = np.zeros((300, 400), dtype=bool)
    seen[60:240, 60:280] = True
    own = seen & (colours[..., 1] > 100)
    filled = complete_texture(colours, seen, (150 / 255,) * 3, 0.01, own).astype(int)
    assert np.abs(filled[140, 160] - (230, 20, 40)).max() < 6
    away = filled.copy()
    away[100:190, 120:200] = 150
    assert np.abs(away - 150).max() < 25


def test_light_and_shade_go_on_beside_what_is_seen():
    shade = np.linspace(60.0, 190.0, 400, dtype=np.float32)
    colours = np.broadcast_to(shade[None, :, None], (300, 400, 3)).copy()
    seen = np.zeros((300, 400), dtype=bool)
    seen[100:200] = True
    filled = complete_texture(colours, seen, (0.5, 0.5, 0.5), 0.01, seen).astype(float)
    assert np.abs(filled[90, 20:380, 0] - shade[20:380]).max() < 12


def test_copies_of_a_small_piece_do_not_show_as_a_weave():
    rng = np.random.default_rng(0)
    colours = (150 + rng.normal(0, 2, (300, 300, 1)) + np.zeros(3)).astype(np.float32)
    seen = np.zeros((300, 300), dtype=bool)
    seen[130:170, 130:170] = True
    # A broad dark stripe across the little that is seen, as a thing's shadow leaves it.
    colours -= 18.0 * np.exp(-(((np.arange(300) - 150) / 6.0) ** 2))[:, None, None].astype(np.float32)
    filled = complete_texture(colours, seen, (150 / 255,) * 3, 0.01, seen, ground=True).astype(float)
    rows, places = filled[:90, 230:, 0].mean(axis=1), np.arange(90)
    assert np.std(rows - np.polyval(np.polyfit(places, rows, 3), places)) < 18.0 / 5.0


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
