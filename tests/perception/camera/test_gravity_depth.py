"""Gravity, axes and height from the depth of rooms whose camera is known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.perception.camera.frames import frame_difference_rad
from diorama_core.perception.camera.gravity_depth import frame_from_depth
from diorama_core.perception.camera.vanishing import prior_frame
from tests.perception.camera import boxroom
from tests.perception.camera.boxroom import degrees_between, depth, room_frame, view

TABLE = ((-0.9, 1.1, 0.70), (1.0, 2.2, 0.75))
WIDE_TABLE = ((-2.0, 0.6, 0.70), (2.0, 2.6, 0.75))
LOW_TABLE = ((-0.9, 1.2, 0.35), (0.9, 2.6, 0.45))
BED = ((-0.9, 1.6, 0.0), (0.9, 4.0, 0.5))


@settings(max_examples=5)
@given(st.floats(8, 35), st.floats(-6, 6), st.floats(-44, 44), st.floats(0.8, 2.0))
def test_recovers_the_camera(pitch: float, roll: float, heading: float, height: float) -> None:
    v = view(pitch_deg=pitch, roll_deg=roll, heading_deg=heading, focal=0.7, height_m=height)
    frame = frame_from_depth(depth(v, noise=0.0015), v.intrinsics, prior_frame())
    assert frame is not None
    assert degrees_between(frame.R_world_camera[2], room_frame(v)[2]) < 0.6
    assert np.rad2deg(frame_difference_rad(frame.R_world_camera, room_frame(v))) < 0.8
    assert frame.height_m == pytest.approx(height, rel=0.02)


@pytest.mark.parametrize("obstacle", [TABLE, LOW_TABLE, BED], ids=["table", "low table", "bed"])
def test_larger_surfaces_above_the_floor_are_not_taken_for_it(obstacle: tuple) -> None:
    v = view(pitch_deg=25, roll_deg=1, heading_deg=12, focal=0.7, height_m=1.5)
    frame = frame_from_depth(depth(v, boxes=(obstacle,), noise=0.0015), v.intrinsics, prior_frame())
    assert frame is not None
    assert frame.height_m == pytest.approx(1.5, rel=0.02)


@pytest.mark.parametrize("height", [5.0, 12.6])
def test_the_floor_of_a_large_room_is_found_from_high_up(height: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(boxroom, "ROOM", ((-14.0, -2.0, 0.0), (16.0, 30.0, 15.0)))
    v = view(pitch_deg=35, roll_deg=1, heading_deg=12, focal=0.7, height_m=height)
    crates = tuple(((x, y, 0.0), (x + 1.2, y + 1.0, 1.0)) for x in range(-8, 10, 4) for y in range(8, 24, 5))
    frame = frame_from_depth(depth(v, boxes=crates, noise=0.0005), v.intrinsics, prior_frame())
    assert frame is not None
    assert frame.height_m == pytest.approx(height, rel=0.02)
    assert degrees_between(frame.R_world_camera[2], room_frame(v)[2]) < 1.0


def test_what_is_absurdly_far_below_is_no_floor(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(boxroom, "ROOM", ((-60.0, -10.0, 0.0), (60.0, 110.0, 50.0)))
    v = view(pitch_deg=35, roll_deg=1, heading_deg=12, focal=0.7, height_m=42.0)
    frame = frame_from_depth(depth(v, boxes=()), v.intrinsics, prior_frame())
    assert frame is None or frame.height_m is None


def test_a_table_that_hides_the_floor_is_not_taken_for_it() -> None:
    v = view(pitch_deg=25, roll_deg=1, heading_deg=12, focal=0.7, height_m=1.5)
    frame = frame_from_depth(depth(v, boxes=(WIDE_TABLE,), noise=0.0015), v.intrinsics, prior_frame())
    assert frame is not None
    assert frame.height_m is None
    assert degrees_between(frame.R_world_camera[2], room_frame(v)[2]) < 0.5


def test_without_a_visible_floor_there_is_gravity_but_no_height() -> None:
    v = view(pitch_deg=0, roll_deg=2, heading_deg=20, focal=1.3, height_m=1.2)
    frame = frame_from_depth(depth(v), v.intrinsics, prior_frame())
    assert frame is not None
    assert frame.height_m is None
    assert degrees_between(frame.R_world_camera[2], room_frame(v)[2]) < 1.0


def test_missing_depth_is_not_geometry() -> None:
    v = view(pitch_deg=18, roll_deg=-2, heading_deg=20)
    measured = depth(v, noise=0.0015)
    holes = np.random.default_rng(0).random(measured.shape) < 0.1
    measured[holes] = 0.0
    measured[:, 200:260] = 0.0
    frame = frame_from_depth(measured, v.intrinsics, prior_frame())
    assert frame is not None
    assert frame.height_m == pytest.approx(1.4, rel=0.02)


def test_nothing_level_says_so() -> None:
    v = view(pitch_deg=0, roll_deg=0, heading_deg=0, focal=1.2)
    wall = np.full((480, 640), 2.0, dtype=np.float32)
    assert frame_from_depth(wall, v.intrinsics, prior_frame()) is None
    assert frame_from_depth(np.zeros((480, 640), np.float32), v.intrinsics, prior_frame()) is None


def test_points_scattered_at_random_do_not_crash() -> None:
    v = view(pitch_deg=0, roll_deg=0, heading_deg=0)
    noise = np.random.default_rng(0).uniform(0.5, 5.0, (480, 640)).astype(np.float32)
    frame = frame_from_depth(noise, v.intrinsics, prior_frame())
    assert frame is None or np.isfinite(frame.R_world_camera).all()
