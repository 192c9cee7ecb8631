from __future__ import annotations

import cv2
import numpy as np
import pytest

from diorama_core.appearance.texture_example import Example, pattern_strength, tileable


def checks(side: int = 96, cell: int = 8) -> np.ndarray:
    y, x = np.mgrid[0:side, 0:side] // cell % 2
    return np.repeat(np.where(x ^ y, 190.0, 90.0)[..., None], 3, axis=2).astype(np.float32)


def plain(side: int = 96) -> np.ndarray:
    return (120 + np.random.default_rng(0).normal(0, 1.2, (side, side, 3))).astype(np.float32)


def seamed() -> np.ndarray:
    piece = plain()
    cv2.line(piece, (0, 40), (95, 52), (40, 40, 40), 4)
    return piece


def folded() -> np.ndarray:
    return plain() + 40 * np.sin(np.linspace(0, 3, 96))[None, :, None].astype(np.float32)


def marked() -> np.ndarray:
    piece = checks()
    cv2.circle(piece, (30, 30), 14, (250, 20, 20), -1)
    return piece


def test_checks_are_a_pattern() -> None:
    assert pattern_strength(checks()) > 0.5


@pytest.mark.parametrize("piece", [plain(), seamed(), folded(), marked()], ids=["plain", "seam", "fold", "mark"])
def test_what_does_not_repeat_is_none(piece: np.ndarray) -> None:
    assert pattern_strength(piece) == 0.0


def test_a_texture_repeats_without_a_seam() -> None:
    rng = np.random.default_rng(1)
    weave = cv2.GaussianBlur(rng.normal(0, 60, (110, 110, 3)), (0, 0), 1.5).astype(np.float32) + 120
    tile = tileable(Example(weave, 0.002)).astype(float)
    across = np.abs(tile[:, 0] - tile[:, -1]).mean()
    down = np.abs(tile[0] - tile[-1]).mean()
    inside = np.abs(np.diff(tile, axis=1)).mean()
    assert max(across, down) < 1.5 * inside
    assert np.abs(tile.mean(axis=(0, 1)) - weave.mean(axis=(0, 1))).max() < 4


def test_a_small_piece_is_mirrored() -> None:
    tile = tileable(Example(checks(22, 3), 0.002))
    np.testing.assert_array_equal(tile[0], tile[-1])
    np.testing.assert_array_equal(tile[:, 0], tile[:, -1])
