"""The lens of one photo by its bent lines."""

from __future__ import annotations

import re

import cv2
import numpy as np
import pytest

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.multiview.lens import Lens, straight_points
from diorama_core.multiview.plumb_lines import box_before_straightening, fit_lens, undistort_by_lines

SIZE = (640, 480)
K1 = -0.15


def bent(rgb: np.ndarray, k1: float) -> np.ndarray:
    """A picture as a lens shows it whose coefficient is for half a diagonal."""
    k, _ = fit_lens(rgb)
    y, x = np.mgrid[: rgb.shape[0], : rgb.shape[1]].astype(float)
    maps = straight_points(np.column_stack([x.ravel(), y.ravel()]), k, Lens((k1,))).astype(np.float32)
    return cv2.remap(rgb, maps[:, 0].reshape(x.shape), maps[:, 1].reshape(x.shape), cv2.INTER_LINEAR)


@pytest.fixture(scope="module")
def room() -> np.ndarray:
    return lines()


def lines() -> np.ndarray:
    """Edges of walls, frames and boards, and a round lamp."""
    rgb = np.full((SIZE[1], SIZE[0], 3), 200, np.uint8)
    for x1, y1, x2, y2, grey in [(40, 30, 250, 400, 120), (330, 60, 610, 200, 70), (300, 260, 560, 450, 150)]:
        cv2.rectangle(rgb, (x1, y1), (x2, y2), (grey, grey, grey), -1)
    cv2.line(rgb, (0, 470), (639, 430), (30, 30, 30), 3)
    cv2.circle(rgb, (470, 330), 60, (240, 240, 90), -1)
    return rgb


@pytest.mark.parametrize("k1", [K1, -0.08, 0.1])
def test_the_coefficient_is_found(room: np.ndarray, k1: float) -> None:
    _, lens = fit_lens(bent(room, k1))
    assert lens.k == pytest.approx((k1,), abs=0.01)


def test_straight_lines_and_round_things_say_nothing(room: np.ndarray) -> None:
    assert not fit_lens(room)[1].bends
    rings = np.full_like(room, 200)
    for radius in (90, 130, 170, 210):
        cv2.circle(rings, (320, 240), radius, (40, 40, 40), 2)
    assert not fit_lens(rings)[1].bends
    assert not fit_lens(np.full_like(room, 90))[1].bends


def test_a_bent_photo_is_straightened_and_said(room: np.ndarray) -> None:
    given = Inputs(Photo(bent(room, K1), "a.jpg", SIZE, exif_focal_px=400.0))
    straight, (note,) = undistort_by_lines(given)
    assert "straightened by them" in note
    assert straight.photo.straightened == pytest.approx(K1, abs=0.01)
    assert re.search(r"k1 -0\.1[45]\d", note)
    inside = np.s_[60:420, 60:580]
    off = np.abs(straight.photo.rgb[inside].astype(int) - room[inside])
    assert np.median(off) == 0
    assert off.mean() < 4.0
    assert np.abs(given.photo.rgb[inside].astype(int) - room[inside]).mean() > 2 * off.mean()
    assert undistort_by_lines(Inputs(Photo(room, "a.jpg", SIZE)))[1] == ()


def test_boxes_go_back_to_where_they_were_drawn(room: np.ndarray) -> None:
    drawn = [(90.0, 70.0, 250.0, 360.0), (0.0, 0.0, 100.0, 480.0), (300.0, 200.0, 340.0, 260.0)]
    given = Inputs(Photo(bent(room, K1), "a.jpg", SIZE), tuple(LabelledBox(b, "chair", "chair") for b in drawn))
    straight, _ = undistort_by_lines(given)
    back = [box_before_straightening(b, straight.photo).box for b in straight.boxes]
    assert np.abs(np.array(back) - drawn).max() < 0.05
    assert undistort_by_lines(given, 0.0) == (given, ())
