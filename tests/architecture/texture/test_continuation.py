"""What nobody saw of a surface: shading goes on smoothly, detail is copied, things before it are not."""

from __future__ import annotations

import numpy as np

from diorama_core.architecture.texture.continuation import completed


def test_hidden_parts_are_filled_without_steps():
    seen = np.ones((60, 80), dtype=bool)
    seen[20:40, 30:50] = False
    colours = np.full((60, 80, 3), 120.0, np.float32)
    filled = completed(colours, seen, (120 / 255,) * 3, 0.02, seen)
    assert np.abs(filled.astype(int) - 120).max() <= 2


def test_what_nobody_saw_is_the_plain_colour():
    seen = np.zeros((50, 400), dtype=bool)
    seen[:, :30] = True
    colours = np.full((50, 400, 3), 200.0, np.float32)
    filled = completed(colours, seen, (0.2, 0.2, 0.2), 0.05, seen)
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
    filled = completed(colours, seen, (0.6, 0.6, 0.6), 0.01, seen, ground=True).astype(float)
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
    filled = completed(colours, seen, (150 / 255,) * 3, 0.01, own).astype(int)
    assert np.abs(filled[140, 160] - (230, 20, 40)).max() < 6
    away = filled.copy()
    away[100:190, 120:200] = 150
    assert np.abs(away - 150).max() < 25


def test_light_and_shade_go_on_beside_what_is_seen():
    shade = np.linspace(60.0, 190.0, 400, dtype=np.float32)
    colours = np.broadcast_to(shade[None, :, None], (300, 400, 3)).copy()
    seen = np.zeros((300, 400), dtype=bool)
    seen[100:200] = True
    filled = completed(colours, seen, (0.5, 0.5, 0.5), 0.01, seen).astype(float)
    assert np.abs(filled[90, 20:380, 0] - shade[20:380]).max() < 12


def test_copies_of_a_small_piece_do_not_show_as_a_weave():
    rng = np.random.default_rng(0)
    colours = (150 + rng.normal(0, 2, (300, 300, 1)) + np.zeros(3)).astype(np.float32)
    seen = np.zeros((300, 300), dtype=bool)
    seen[130:170, 130:170] = True
    # A broad dark stripe across the little that is seen, as a thing's shadow leaves it.
    colours -= 18.0 * np.exp(-(((np.arange(300) - 150) / 6.0) ** 2))[:, None, None].astype(np.float32)
    filled = completed(colours, seen, (150 / 255,) * 3, 0.01, seen, ground=True).astype(float)
    rows, places = filled[:90, 230:, 0].mean(axis=1), np.arange(90)
    assert np.std(rows - np.polyval(np.polyfit(places, rows, 3), places)) < 18.0 / 5.0
