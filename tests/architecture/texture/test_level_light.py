"""A floor's picture in even light: blurred mirror images and shadows go, boards stay."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.texture.level_light import level_light

PIXEL_M = 0.01
OWN = np.ones((200, 300), dtype=bool)


def floor(*, joints: bool) -> np.ndarray:
    """Grey, with a little noise and, if asked for, boards of 20 cm with dark joints and tones of their own."""
    rng = np.random.default_rng(0)
    picture = 140.0 + rng.normal(0.0, 0.5, (200, 300, 1)) + np.zeros(3)
    if joints:
        board = np.arange(300) // 20
        picture += rng.normal(0.0, 8.0, board.max() + 1)[board][None, :, None]
        picture[:, np.arange(300) % 20 < 2] -= 40.0
    return picture.astype(np.float32)


def blob(width_m: float, levels: float) -> np.ndarray:
    """A blurred bright spot in the middle."""
    rows, columns = np.mgrid[0:200, 0:300]
    far = ((rows - 100) ** 2 + (columns - 150) ** 2) * PIXEL_M**2
    return (levels * np.exp(-far / (2 * width_m**2)))[..., None].astype(np.float32)


@pytest.mark.parametrize("width_m", [0.15, 0.4])
def test_a_blurred_mirror_image_goes(width_m: float) -> None:
    mirrored = level_light(floor(joints=False) + blob(width_m, 40.0), OWN, PIXEL_M)
    spot = mirrored[90:110, 140:160].mean() - np.median(mirrored)
    assert abs(spot) < 14.0  # of 40; what is left of the broader one is the room's brighter side


def test_boards_keep_their_joints_and_tones() -> None:
    boards = floor(joints=True)
    kept = level_light(boards, OWN, PIXEL_M)
    across, before = kept[:, 40:260].mean(axis=(0, 2)), boards[:, 40:260].mean(axis=(0, 2))
    assert np.corrcoef(across, before)[0, 1] > 0.95
    assert across.std() > 0.7 * before.std()


def test_what_is_not_the_floors_own_changes_nothing() -> None:
    picture, own = floor(joints=True), OWN.copy()
    own[:, 200:] = False
    other = picture.copy()
    other[:, 200:] = 0.0
    np.testing.assert_allclose(
        level_light(other, own, PIXEL_M)[own], level_light(picture, own, PIXEL_M)[own], atol=1e-3
    )


def test_nothing_of_the_floor_leaves_the_picture_alone() -> None:
    picture = floor(joints=False)
    np.testing.assert_array_equal(level_light(picture, np.zeros_like(OWN), PIXEL_M), picture)
