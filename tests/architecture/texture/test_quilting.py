from __future__ import annotations

import cv2
import numpy as np
import pytest

from diorama_core.architecture.texture.quilting import broad_shading, detail_continued, wide_blur


def boards(height: int = 160, width: int = 200) -> np.ndarray:
    """Upright boards, ten pixels wide, with a little grain."""
    rng = np.random.default_rng(0)
    stripes = 12.0 * np.where(np.arange(width) % 10 < 5, 1.0, -1.0)
    return (stripes[None, :, None] + rng.normal(0, 0.5, (height, width, 1)) * np.ones(3)).astype(np.float32)


def seen_left(shape: tuple[int, ...], share: float = 0.6) -> np.ndarray:
    seen = np.zeros(shape[:2], dtype=bool)
    seen[:, : int(share * shape[1])] = True
    return seen


def test_boards_go_on_where_nobody_saw_them_and_what_was_seen_stays() -> None:
    detail = boards()
    seen = seen_left(detail.shape)
    found = detail_continued(np.where(seen[..., None], detail, 0.0).astype(np.float32), seen, 40.0)
    np.testing.assert_array_equal(found[seen], detail[seen])
    copied = found[:, 125:, 0]
    assert copied.std() == pytest.approx(detail[..., 0].std(), rel=0.25)
    # The pattern repeats every ten pixels, as boards do.
    shifted = np.corrcoef(copied[:, :-10].ravel(), copied[:, 10:].ravel())[0, 1]
    assert shifted > 0.8


def test_the_same_seed_gives_the_same_picture() -> None:
    detail = boards()
    seen = seen_left(detail.shape)
    given = np.where(seen[..., None], detail, 0.0).astype(np.float32)
    np.testing.assert_array_equal(detail_continued(given, seen, 40.0, 3), detail_continued(given, seen, 40.0, 3))


def test_a_picture_on_the_wall_is_not_copied() -> None:
    detail = boards()
    detail[60:100, 30:70] = 90.0
    seen = seen_left(detail.shape)
    found = detail_continued(np.where(seen[..., None], detail, 0.0).astype(np.float32), seen, 40.0)
    assert np.abs(found[:, 125:]).max() < 40.0
    np.testing.assert_array_equal(found[60:100, 30:70], detail[60:100, 30:70])


@pytest.mark.parametrize("share", [0.0, 0.05])
def test_too_little_to_copy_from_is_none(share: float) -> None:
    detail = boards()
    assert detail_continued(detail, seen_left(detail.shape, share), 40.0) is None


def test_shading_is_smooth_and_takes_nothing_from_what_was_not_seen() -> None:
    colours = np.full((60, 80, 3), 100.0, np.float32)
    seen = seen_left(colours.shape, 0.5)
    colours[~seen] = 5000.0
    np.testing.assert_allclose(broad_shading(colours, seen, 3.0)[:, :42], 100.0, rtol=1e-3)
    ramp = np.broadcast_to(np.arange(80.0)[None, :, None], (60, 80, 3)).astype(np.float32)
    whole = np.ones((60, 80), dtype=bool)
    np.testing.assert_allclose(broad_shading(ramp, whole, 2.0)[:, 10:70], ramp[:, 10:70], atol=0.2)


def test_blocks_that_fit_at_odd_places_only_are_found() -> None:
    """A source as wide as a block beside a wider rest that is no source."""
    detail, seen = boards(160, 200), np.zeros((160, 200), dtype=bool)
    seen[21:101, 31:79] = True
    seen[20, 30] = True
    found = detail_continued(np.where(seen[..., None], detail, 0.0).astype(np.float32), seen, 40.0)
    assert found is not None
    assert np.abs(found[:, 100:]).mean() > 3.0


@pytest.mark.parametrize("sigma_px", [2.0, 13.0, 40.0, 130.0])
@pytest.mark.parametrize("size", [(240, 517), (480, 300)])
def test_as_a_gaussian_blur_to_within_a_level_or_two(size: tuple[int, int], sigma_px: float) -> None:
    rng = np.random.default_rng(3)
    picture = rng.uniform(0.0, 255.0, (*size, 3)).astype(np.float32)
    picture[: size[0] // 3, : size[1] // 3] = 20.0
    exact = cv2.GaussianBlur(picture, (0, 0), sigma_px)
    inner = (slice(size[0] // 8, -size[0] // 8), slice(size[1] // 8, -size[1] // 8))
    off = np.abs(wide_blur(picture, sigma_px) - exact)
    assert off[inner].max() < 1.5
    assert off.mean() < 0.5


def test_an_even_picture_stays_even_and_one_channel_stays_one() -> None:
    even = np.full((90, 70), 37.0, np.float32)
    blurred = wide_blur(even, 300.0)
    assert blurred.shape == even.shape
    np.testing.assert_allclose(blurred, even, rtol=1e-5)
