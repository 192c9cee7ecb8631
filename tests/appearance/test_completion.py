from __future__ import annotations

import cv2
import numpy as np

from diorama_core.appearance.completion import completed_picture, mirrored
from diorama_core.appearance.rectify import Rectified


def patterned(seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return cv2.resize(rng.uniform(20, 230, (8, 10, 3)).astype(np.float32), (160, 128), interpolation=cv2.INTER_CUBIC)


def test_a_symmetric_picture_is_filled_from_its_other_side() -> None:
    half = patterned()
    whole = np.concatenate([half, half[:, ::-1]], axis=1)
    seen = np.ones(whole.shape[:2], dtype=bool)
    seen[30:90, 200:290] = False
    broken = np.where(seen[..., None], whole, 0).astype(np.float32)
    filled, known = mirrored(broken, seen)
    assert known.all()
    assert np.abs(filled - whole).mean() < 1.0


def test_another_picture_is_not_mirrored() -> None:
    whole = patterned()
    seen = np.ones(whole.shape[:2], dtype=bool)
    seen[30:90, 100:150] = False
    _, known = mirrored(whole, seen)
    np.testing.assert_array_equal(known, seen)


def test_what_was_seen_stays_and_the_rest_is_about_its_colour() -> None:
    rng = np.random.default_rng(3)
    whole = (np.array([150, 110, 80]) + rng.normal(0, 6, (120, 160, 3))).astype(np.float32)
    seen = np.ones((120, 160), dtype=bool)
    seen[:, 110:] = False
    picture = completed_picture(Rectified(np.where(seen[..., None], whole, 255).astype(np.float32), seen), 0.01)
    assert np.abs(picture[:, :100].astype(float) - whole[:, :100]).max() < 2
    assert np.abs(picture[:, 120:].reshape(-1, 3).mean(axis=0) - [150, 110, 80]).max() < 12
