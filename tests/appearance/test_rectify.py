from __future__ import annotations

import cv2
import numpy as np

from diorama_core.appearance.rectify import corners_in_photo, rectified
from diorama_core.scene.types import Camera, Intrinsics

CAMERA = Camera(Intrinsics(400, 300, 300.0, 300.0, 200.0, 150.0), np.eye(4))


def square(turn_rad: float) -> np.ndarray:
    """A rectangle two metres ahead, turned about the vertical, clockwise from its top left."""
    c, s = np.cos(turn_rad), np.sin(turn_rad)
    flat = np.array([[-0.6, -0.4, 0], [0.6, -0.4, 0], [0.6, 0.4, 0], [-0.6, 0.4, 0]])
    return flat @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T + [0, 0, 2.0]


def test_a_rectangle_seen_from_behind_or_edge_on_is_not_read() -> None:
    assert corners_in_photo(CAMERA, square(0.5)) is not None
    assert corners_in_photo(CAMERA, square(np.pi)) is None
    assert corners_in_photo(CAMERA, square(np.pi / 2 - 0.01)) is None
    assert corners_in_photo(CAMERA, square(0.0) - [0, 0, 2.0]) is None


def test_the_photo_is_seen_head_on_again() -> None:
    rng = np.random.default_rng(1)
    art = cv2.resize(rng.integers(0, 255, (6, 9, 3)).astype(np.uint8), (270, 180), interpolation=cv2.INTER_CUBIC)
    corners = corners_in_photo(CAMERA, square(0.6))
    assert corners is not None
    source = np.array([[0, 0], [270, 0], [270, 180], [0, 180]], np.float32)
    M = cv2.getPerspectiveTransform(source - 0.5, corners.astype(np.float32) - 0.5)
    photo = cv2.warpPerspective(art, M, (400, 300), flags=cv2.INTER_AREA)
    hidden = np.zeros((300, 400), dtype=bool)
    hidden[:, :180] = True
    found = rectified(photo, hidden, corners)
    assert found is not None
    assert not found.seen.all()
    assert found.seen.any()
    want = cv2.resize(art, found.seen.shape[::-1], interpolation=cv2.INTER_AREA)
    inner = cv2.erode(found.seen.astype(np.uint8), np.ones((7, 7)), borderValue=0).astype(bool)
    assert np.abs(found.colours - want)[inner].mean() < 6


def test_what_lies_outside_the_photo_is_not_seen() -> None:
    photo = np.full((300, 400, 3), 90, np.uint8)
    corners = np.array([[-100, 50], [100, 50], [100, 250], [-100, 250]], float)
    found = rectified(photo, np.zeros((300, 400), dtype=bool), corners)
    assert found is not None
    assert 0.4 < found.seen.mean() < 0.6


def test_what_is_too_small_shows_nothing() -> None:
    corners = np.array([[10, 10], [18, 10], [18, 90], [10, 90]], float)
    assert rectified(np.zeros((300, 400, 3), np.uint8), np.zeros((300, 400), dtype=bool), corners) is None
