from __future__ import annotations

import cv2
import numpy as np
import pytest

from diorama_core.appearance.flat_faces import (
    FACES,
    box_alignment,
    complete_picture,
    face_kind,
    fill_from_mirror_images,
    is_lit,
    pale_frame,
    sides_told,
)
from diorama_core.appearance.rectify import Rectified
from diorama_core.library.taxonomy import CATEGORIES


def aligned(
    corners: np.ndarray,
    projected: np.ndarray,
    box: tuple[float, float, float, float],
    told: tuple[bool, bool, bool, bool] = (True,) * 4,
) -> np.ndarray:
    return (np.c_[corners, np.ones(len(corners))] @ box_alignment(projected, box, told).T)[:, :2]


def test_flat_categories_are_the_librarys() -> None:
    assert set(FACES) <= {c.name for c in CATEGORIES}


def test_corners_follow_the_objects_box() -> None:
    corners = np.array([[20, 20], [80, 20], [80, 60], [20, 60]], float)
    found = aligned(corners, np.array([10.0, 10, 90, 70]), (14.0, 10.0, 94.0, 76.0))
    np.testing.assert_allclose(found, [[24, 21], [84, 21], [84, 65], [24, 65]])


def test_the_photos_edge_is_no_edge_of_the_object() -> None:
    corners = np.array([[-20, 20], [80, 20], [80, 60], [-20, 60]], float)
    told = sides_told((0.0, 10.0, 90.0, 70.0), np.zeros((200, 200), dtype=bool))
    assert told == (False, True, True, True)
    found = aligned(corners, np.array([-30.0, 10, 90, 70]), (0.0, 10.0, 90.0, 70.0), told)
    np.testing.assert_allclose(found, corners)


def test_what_hides_a_side_says_nothing_of_where_the_object_ends() -> None:
    """A rug that goes on below a bed."""
    hidden = np.zeros((200, 200), dtype=bool)
    hidden[10:70, :66] = True
    told = sides_told((60.0, 10.0, 120.0, 70.0), hidden)
    assert told == (False, True, True, True)
    corners = np.array([[32, 20], [118, 20], [118, 60], [32, 60]], float)
    found = aligned(corners, np.array([30.0, 10, 120, 70]), (60.0, 10.0, 120.0, 70.0), told)
    np.testing.assert_allclose(found, corners)


def test_a_white_frame_is_found_and_a_white_thing_at_the_edge_is_none() -> None:
    photo = np.full((200, 300, 3), 120, np.uint8)
    assert not pale_frame(photo).any()
    photo[:40, 100:160] = 255
    assert not pale_frame(photo).any()
    photo[-3:] = 255
    frame = pale_frame(photo)
    assert frame[-3:].all()
    assert not frame[:180].any()


def test_a_box_somewhere_else_is_ignored() -> None:
    corners = np.array([[20, 20], [80, 20], [80, 60], [20, 60]], float)
    found = aligned(corners, np.array([10.0, 10, 90, 70]), (100.0, 100.0, 150.0, 150.0))
    np.testing.assert_array_equal(found, corners)


@pytest.mark.parametrize(("level", "contrast", "lit"), [(12, 3, False), (150, 10, True), (30, 120, True)])
def test_a_screen_that_is_off_is_dark(level: float, contrast: float, lit: bool) -> None:
    colours = np.full((40, 60, 3), level, np.float32)
    colours[:, ::2] += contrast
    assert is_lit(Rectified(colours, np.ones((40, 60), dtype=bool))) == lit


def test_books_show_their_spines_in_a_row_and_their_cover_when_one_lies_flat() -> None:
    row, lying, stack = (
        face_kind("books", np.array(size)) for size in ((0.2, 0.5, 0.3), (0.2, 0.3, 0.03), (0.2, 0.3, 0.2))
    )
    assert row is not None
    assert row[1] == "front"
    assert lying is not None
    assert lying[1] == "top"
    assert stack is None
    assert face_kind("chair", np.ones(3)) is None


def patterned(seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return cv2.resize(rng.uniform(20, 230, (8, 10, 3)).astype(np.float32), (160, 128), interpolation=cv2.INTER_CUBIC)


def test_a_symmetric_picture_is_filled_from_its_other_side() -> None:
    half = patterned()
    whole = np.concatenate([half, half[:, ::-1]], axis=1)
    seen = np.ones(whole.shape[:2], dtype=bool)
    seen[30:90, 200:290] = False
    broken = np.where(seen[..., None], whole, 0).astype(np.float32)
    filled, known = fill_from_mirror_images(broken, seen)
    assert known.all()
    assert np.abs(filled - whole).mean() < 1.0


def test_another_picture_is_not_mirrored() -> None:
    whole = patterned()
    seen = np.ones(whole.shape[:2], dtype=bool)
    seen[30:90, 100:150] = False
    _, known = fill_from_mirror_images(whole, seen)
    np.testing.assert_array_equal(known, seen)


def test_what_was_seen_stays_and_the_rest_is_about_its_colour() -> None:
    rng = np.random.default_rng(3)
    whole = (np.array([150, 110, 80]) + rng.normal(0, 6, (120, 160, 3))).astype(np.float32)
    seen = np.ones((120, 160), dtype=bool)
    seen[:, 110:] = False
    picture = complete_picture(Rectified(np.where(seen[..., None], whole, 255).astype(np.float32), seen), 0.01)
    assert np.abs(picture[:, :100].astype(float) - whole[:, :100]).max() < 2
    assert np.abs(picture[:, 120:].reshape(-1, 3).mean(axis=0) - [150, 110, 80]).max() < 12
