from __future__ import annotations

import cv2
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.appearance.rectify import face_homography, outline_px, rectify
from diorama_core.geometry.projection import NEAR_M
from diorama_core.scene.types import Camera, Intrinsics

CAMERA = Camera(Intrinsics(400, 300, 300.0, 300.0, 200.0, 150.0), np.eye(4))


def square(turn_rad: float) -> np.ndarray:
    """A rectangle two metres ahead, turned about the vertical, clockwise from its top left."""
    c, s = np.cos(turn_rad), np.sin(turn_rad)
    flat = np.array([[-0.6, -0.4, 0], [0.6, -0.4, 0], [0.6, 0.4, 0], [-0.6, 0.4, 0]])
    return flat @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T + [0, 0, 2.0]


def on_photo(corners: list[list[float]]) -> np.ndarray:
    """The homography of a rectangle that faces the camera at a metre, by its corners' pixels."""
    k = CAMERA.intrinsics
    flat = (np.array(corners, float) - [k.cx, k.cy]) / [k.fx, k.fy]
    H = face_homography(CAMERA, np.concatenate([flat, np.ones((4, 1))], axis=1))
    assert H is not None
    return H


def test_a_rectangle_seen_from_behind_or_edge_on_is_not_read() -> None:
    assert face_homography(CAMERA, square(0.5)) is not None
    assert face_homography(CAMERA, square(np.pi)) is None
    assert face_homography(CAMERA, square(np.pi / 2 - 0.01)) is None
    assert face_homography(CAMERA, square(0.0) - [0, 0, 2.1]) is None


def art_at(uv: np.ndarray) -> np.ndarray:
    """A smooth picture over the unit square and beyond, 0 to 255."""
    u, v = uv[..., 0], uv[..., 1]
    return np.stack([128 + 90 * np.sin(3 * u + 1), 128 + 90 * np.cos(4 * v), 128 + 60 * np.sin(2 * (u - v))], axis=-1)


@given(
    height_m=st.floats(0.6, 2.0),
    down_rad=st.floats(0.1, 0.9),
    turn_rad=st.floats(-3.1, 3.1),
    size_m=st.tuples(st.floats(0.8, 5.0), st.floats(0.8, 5.0)),
    ahead_m=st.floats(-0.5, 3.0),
)
def test_a_rug_is_read_where_it_lies_before_the_camera_and_nowhere_else(
    height_m: float, down_rad: float, turn_rad: float, size_m: tuple[float, float], ahead_m: float
) -> None:
    c, s = np.cos(down_rad), np.sin(down_rad)
    T = np.eye(4)
    T[:3, :3] = np.array([[1, 0, 0], [0, -s, c], [0, -c, -s]])
    T[2, 3] = height_m
    camera = Camera(Intrinsics(200, 150, 150.0, 150.0, 100.0, 75.0), T)
    ct, st_ = np.cos(turn_rad), np.sin(turn_rad)
    flat = np.array([[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]]) * size_m
    xy = flat @ np.array([[ct, st_], [-st_, ct]]) + [0.0, ahead_m]
    corners = np.concatenate([xy, np.zeros((4, 1))], axis=1)
    H = face_homography(camera, corners)
    if H is None:
        assert (camera.to_camera(corners)[:, 2] < NEAR_M).all() or height_m < 0.1 * np.hypot(ahead_m, height_m)
        return
    pixels = np.stack(np.meshgrid(np.arange(200) + 0.5, np.arange(150) + 0.5), axis=-1)
    rays = camera.rays(pixels)
    ground = camera.position + rays * np.where(rays[..., 2:] < -1e-6, -height_m / rays[..., 2:], np.nan)
    axes = np.stack([corners[1] - corners[0], corners[3] - corners[0]], axis=1)
    uv = (ground - corners[0]) @ axes / (axes**2).sum(axis=0)
    photo = np.nan_to_num(art_at(uv)).clip(0, 255).astype(np.uint8)
    found = rectify(photo, np.zeros((150, 200), dtype=bool), H)
    if found is None:
        return
    rows, columns = found.seen.shape
    texels = np.stack(np.meshgrid((np.arange(columns) + 0.5) / columns, (np.arange(rows) + 0.5) / rows), axis=-1)
    points = corners[0] + texels @ axes.T
    where = camera.project(points)
    ahead = camera.to_camera(points)[..., 2] >= NEAR_M
    inside = ahead & ((where > 1.0) & (where < [199.0, 149.0])).all(axis=-1)
    beyond = ~ahead | ((where < -1.0) | (where > [201.0, 151.0])).any(axis=-1)
    assert found.seen[inside].all()
    assert not found.seen[beyond].any()
    if inside.any():
        assert np.quantile(np.abs(found.colours - art_at(texels))[inside], 0.98) < 12
        outline = outline_px(H)
        low, high = outline.min(axis=0), outline.max(axis=0)
        assert ((where[inside] >= low - 0.5) & (where[inside] <= high + 0.5)).all()


def test_the_photo_is_seen_head_on_again() -> None:
    rng = np.random.default_rng(1)
    art = cv2.resize(rng.integers(0, 255, (6, 9, 3)).astype(np.uint8), (270, 180), interpolation=cv2.INTER_CUBIC)
    H = face_homography(CAMERA, square(0.6))
    assert H is not None
    corners = outline_px(H)
    source = np.array([[0, 0], [270, 0], [270, 180], [0, 180]], np.float32)
    M = cv2.getPerspectiveTransform(source - 0.5, corners.astype(np.float32) - 0.5)
    photo = cv2.warpPerspective(art, M, (400, 300), flags=cv2.INTER_AREA)
    hidden = np.zeros((300, 400), dtype=bool)
    hidden[:, :180] = True
    found = rectify(photo, hidden, H)
    assert found is not None
    assert not found.seen.all()
    assert found.seen.any()
    want = cv2.resize(art, found.seen.shape[::-1], interpolation=cv2.INTER_AREA)
    inner = cv2.erode(found.seen.astype(np.uint8), np.ones((7, 7)), borderValue=0).astype(bool)
    assert np.abs(found.colours - want)[inner].mean() < 6


def test_what_lies_outside_the_photo_is_not_seen() -> None:
    photo = np.full((300, 400, 3), 90, np.uint8)
    H = on_photo([[-100, 50], [100, 50], [100, 250], [-100, 250]])
    found = rectify(photo, np.zeros((300, 400), dtype=bool), H)
    assert found is not None
    assert 0.4 < found.seen.mean() < 0.6


def test_what_is_too_small_shows_nothing() -> None:
    H = on_photo([[190, 110], [198, 110], [198, 190], [190, 190]])
    assert rectify(np.zeros((300, 400, 3), np.uint8), np.zeros((300, 400), dtype=bool), H) is None
