"""Photos of lenses that bend, straightened with everything that lies on them."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import InputError
from diorama_core.multiview.lens import Lens, lens_of, straight_points, undistort, without_distortion
from diorama_core.scene.types import Intrinsics

K = Intrinsics(160, 120, 110.0, 112.0, 78.0, 61.0)
LENS = Lens((-0.25, 0.06), (0.002, -0.003))


def bent(points: np.ndarray, k: Intrinsics, lens: Lens) -> np.ndarray:
    rays = np.column_stack([(points - [k.cx, k.cy]) / [k.fx, k.fy], np.ones(len(points))])
    return cv2.projectPoints(rays, np.zeros(3), np.zeros(3), k.matrix, lens.coefficients)[0].reshape(-1, 2)


def test_points_boxes_and_pictures_are_straightened_alike() -> None:
    straight = np.array([[20.0, 20.0], [60.0, 20.0], [60.0, 70.0], [20.0, 70.0]])
    there = bent(straight, K, LENS)
    assert straight_points(there, K, LENS) == pytest.approx(straight, abs=0.05)
    rgb = np.zeros((120, 160, 3), np.uint8)
    cv2.fillPoly(rgb, [np.round(there).astype(np.int32)], (255, 255, 255))
    low, high = there.min(axis=0), there.max(axis=0)
    box = LabelledBox((float(low[0]), float(low[1]), float(high[0]), float(high[1])), "table", "table")
    depth = np.full((120, 160), 2.0, np.float32)
    found = undistort(Inputs(Photo(rgb, "a.jpg", (160, 120)), (box,), depth_m=depth), K, LENS)
    rows, columns = np.nonzero(found.photo.rgb[..., 0] > 128)
    assert [columns.min(), rows.min(), columns.max(), rows.max()] == pytest.approx([20, 20, 60, 70], abs=2)
    assert found.boxes[0].box == pytest.approx((20, 20, 60, 70), abs=3)
    assert found.depth_m is not None
    assert set(np.unique(found.depth_m)) <= {0.0, 2.0}


def test_a_straight_lens_changes_nothing() -> None:
    inputs = Inputs(Photo(np.zeros((120, 160, 3), np.uint8), "a.jpg", (160, 120)))
    assert undistort(inputs, K, Lens()) is inputs
    assert undistort(inputs, K, Lens((1e-6,))) is inputs


def test_a_lens_turns_with_its_picture() -> None:
    points = np.array([[20.0, 90.0], [130.0, 30.0]])
    there = bent(points, K, LENS)
    turned = Intrinsics(120, 160, K.fy, K.fx, 120 - K.cy, K.cx)
    around = np.column_stack([120 - points[:, 1], points[:, 0]])
    assert bent(around, turned, LENS.rotate(1)) == pytest.approx(np.column_stack([120 - there[:, 1], there[:, 0]]))


def test_a_fisheye_lens_is_straightened() -> None:
    lens = Lens((0.05, 0.01, 0.0, 0.0), fisheye=True)
    assert lens.bends
    assert straight_points(np.array([[K.cx, K.cy]]), K, lens) == pytest.approx(np.array([[K.cx, K.cy]]))


def test_given_coefficients_are_opencvs() -> None:
    assert lens_of((-0.1,)) == Lens((-0.1,))
    assert lens_of((-0.25, 0.06, 0.002, -0.003, 0.01)) == Lens((-0.25, 0.06, 0.01), (0.002, -0.003))
    for wrong in ((0.1, 0.2, 0.3), (float("nan"),)):
        with pytest.raises(InputError, match="--distortion"):
            lens_of(wrong)


def test_one_photo_is_straightened_around_its_own_camera() -> None:
    rgb = np.zeros((120, 160, 3), np.uint8)
    rgb[::8] = 255
    with pytest.raises(InputError, match="add --fov"):
        without_distortion(Inputs(Photo(rgb, "a.jpg", (160, 120))), LENS)
    found = without_distortion(Inputs(Photo(rgb, "a.jpg", (160, 120), exif_focal_px=110.0)), LENS)
    assert found.intrinsics == Intrinsics(160, 120, 110.0, 110.0, 80.0, 60.0)
    expected = undistort(Inputs(Photo(rgb, "a.jpg", (160, 120))), found.intrinsics, LENS)
    assert np.array_equal(found.photo.rgb, expected.photo.rgb)
    assert not np.array_equal(found.photo.rgb, rgb)
