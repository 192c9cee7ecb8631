"""Gravity, room axes and focal length from the edges of rooms whose camera is known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.perception.camera.frames import frame_difference_rad
from diorama_core.perception.camera.vanishing import (
    FrameFit,
    Lines,
    prior_frame,
    search_frames,
    signed_sines,
)
from diorama_core.scene.types import Intrinsics
from tests.perception.camera.boxroom import View, degrees_between, room_frame, segments_px, view

PITCHES, ROLLS = st.floats(-5, 32), st.floats(-6, 6)


def best(v: View, segments: np.ndarray, focal: float | None) -> FrameFit:
    return search_frames(Lines.of(segments, v.intrinsics), focal)[0]


@settings(max_examples=8)
@given(PITCHES, ROLLS, st.floats(-44, 44), st.floats(0.6, 1.1))
def test_gravity_within_half_a_degree_where_the_focal_length_is_known(
    pitch: float, roll: float, heading: float, focal: float
) -> None:
    v = view(pitch_deg=pitch, roll_deg=roll, heading_deg=heading, focal=focal)
    fit = best(v, segments_px(v, noise_px=0.15), focal)
    assert degrees_between(fit.R_world_camera[2], room_frame(v)[2]) < 0.5
    assert np.rad2deg(frame_difference_rad(fit.R_world_camera, room_frame(v))) < 1.5


@pytest.mark.parametrize("heading", [-33, 18])
@pytest.mark.parametrize("focal", [0.65, 0.78, 0.95])
def test_focal_length_within_two_percent_from_a_two_point_view(heading: float, focal: float) -> None:
    v = view(pitch_deg=12, roll_deg=2, heading_deg=heading, focal=focal)
    fit = best(v, segments_px(v), None)
    assert fit.focal == pytest.approx(focal, rel=0.02)
    assert degrees_between(fit.R_world_camera[2], room_frame(v)[2]) < 0.5


def test_clutter_does_not_carry_the_day() -> None:
    v = view(pitch_deg=14, roll_deg=-2, heading_deg=20)
    rng = np.random.default_rng(3)
    starts = rng.uniform(20, 460, (60, 2))
    turns = rng.uniform(0, np.pi, 60)
    ends = starts + rng.uniform(20, 50, (60, 1)) * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    segments = np.concatenate([segments_px(v, 0.3), np.concatenate([starts, ends], axis=1)])
    assert degrees_between(best(v, segments, 0.8).R_world_camera[2], room_frame(v)[2]) < 1.0


def test_mirrored_segments_give_the_mirrored_frame() -> None:
    v = view(pitch_deg=14, roll_deg=-3, heading_deg=20)
    segments = segments_px(v)
    mirrored = segments * [-1, 1, -1, 1] + [v.intrinsics.width, 0, v.intrinsics.width, 0]
    mirror = np.diag([-1.0, 1.0, 1.0])
    one, other = best(v, segments, 0.8), best(v, mirrored, 0.8)
    assert np.rad2deg(frame_difference_rad(mirror @ one.R_world_camera @ mirror, other.R_world_camera)) < 0.1


def test_scale_of_the_picture_does_not_matter() -> None:
    small = view(pitch_deg=14, roll_deg=-3, heading_deg=20)
    large = view(pitch_deg=14, roll_deg=-3, heading_deg=20, size=(1280, 960))
    one, other = best(small, segments_px(small), 0.8), best(large, segments_px(small) * 2, 0.8)
    np.testing.assert_allclose(one.R_world_camera, other.R_world_camera, atol=1e-5)


def test_anisotropic_pixels_and_a_shifted_centre_are_honoured() -> None:
    v = view(pitch_deg=10, roll_deg=1, heading_deg=25)
    k = v.intrinsics
    squeezed = segments_px(v) * [1, 0.8, 1, 0.8] + [30, -10, 30, -10]
    camera = Intrinsics(k.width, k.height, k.fx, 0.8 * k.fy, k.cx + 30, 0.8 * k.cy - 10)
    fit = search_frames(Lines.of(squeezed, camera), 0.8)[0]
    assert degrees_between(fit.R_world_camera[2], room_frame(v)[2]) < 0.5


def test_the_same_picture_gives_the_same_bytes() -> None:
    v = view(pitch_deg=10, roll_deg=1, heading_deg=25)
    lines = Lines.of(segments_px(v, 0.5), v.intrinsics)
    first, second = search_frames(lines, None), search_frames(lines, None)
    assert [f.R_world_camera.tobytes() for f in first] == [f.R_world_camera.tobytes() for f in second]


def test_frames_are_rotations_and_ranked() -> None:
    v = view(pitch_deg=10, roll_deg=1, heading_deg=25)
    fits = search_frames(Lines.of(segments_px(v, 0.5), v.intrinsics), None)
    scores = [f.score for f in fits]
    assert scores == sorted(scores, reverse=True)
    for fit in fits:
        np.testing.assert_allclose(fit.R_world_camera @ fit.R_world_camera.T, np.eye(3), atol=1e-6)
        assert np.linalg.det(fit.R_world_camera) > 0
        assert 0 <= fit.support <= 1


@pytest.mark.parametrize("count", [0, 1, 2, 3])
@pytest.mark.parametrize("focal", [0.8, None])
def test_a_few_segments_leave_it_to_habit(count: int, focal: float | None) -> None:
    camera = Intrinsics(640, 480, 512, 512, 320, 240)
    segments = np.array([[100.0, 400.0, 300.0, 80.0], [5.0, 5.0, 5.0, 5.0], [10.0, 20.0, 400.0, 25.0]])[:count]
    fit = search_frames(Lines.of(segments, camera), focal)[0]
    assert np.isfinite(fit.R_world_camera).all()
    assert degrees_between(fit.R_world_camera[2], prior_frame()[2]) < 25


def test_a_segment_through_the_vanishing_point_agrees() -> None:
    camera = Intrinsics(200, 100, 100, 100, 100, 50)
    lines = Lines.of(np.array([[120.0, 50.0, 150.0, 50.0], [120.0, 50.0, 120.0, 90.0]]), camera)
    sines = np.abs(signed_sines(lines, np.array([[0.0, 0.0, 1.0]]), 0.5))[0]
    np.testing.assert_allclose(sines, [0.0, 20 / np.hypot(20, 20)], atol=1e-5)
