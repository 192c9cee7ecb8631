"""Rotations of a camera over the floor."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.perception.camera.frames import (
    facing_direction,
    frame_difference_rad,
    pitch_and_roll,
    up_in_camera,
    world_frame,
)

pitches = st.floats(-1.3, 1.3)
rolls = st.floats(-1.3, 1.3)
headings = st.floats(-3.1, 3.1)


def horizontal(up: np.ndarray, heading: float) -> np.ndarray:
    forward = facing_direction(up)
    return np.cos(heading) * forward + np.sin(heading) * np.cross(forward, up)


@given(pitches, rolls)
def test_pitch_and_roll_round_trip(pitch: float, roll: float) -> None:
    np.testing.assert_allclose(pitch_and_roll(up_in_camera(pitch, roll)), (pitch, roll), atol=1e-9)


def test_signs_are_as_stated() -> None:
    down = up_in_camera(np.deg2rad(30), 0.0)
    assert down[1] < 0  # up in the world is up in the picture
    assert down[2] < 0  # looking down, up points back at the viewer
    clockwise = up_in_camera(0.0, np.deg2rad(10))
    assert clockwise[0] < 0  # a camera leaning right sees the world lean left


@given(pitches, rolls, headings)
def test_world_frame_is_a_rotation_in_the_world_convention(pitch: float, roll: float, heading: float) -> None:
    up = up_in_camera(pitch, roll)
    R = world_frame(up, horizontal(up, heading))
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(R) > 0
    np.testing.assert_allclose(R @ up, [0, 0, 1], atol=1e-9)
    view = R @ [0.0, 0.0, 1.0]
    assert view[1] >= abs(view[0]) - 1e-6  # +Y is the axis nearest to the viewing direction


@given(pitches, rolls, headings, st.integers(0, 3))
def test_any_of_the_rooms_four_directions_gives_the_same_frame(
    pitch: float, roll: float, heading: float, quarter: int
) -> None:
    up = up_in_camera(pitch, roll)
    one = world_frame(up, horizontal(up, heading))
    other = world_frame(up, horizontal(up, heading + quarter * np.pi / 2))
    assert frame_difference_rad(one, other) < 1e-6


@given(pitches, rolls, headings)
def test_mirrored_pictures_have_mirrored_frames(pitch: float, roll: float, heading: float) -> None:
    mirror = np.diag([-1.0, 1.0, 1.0])
    up = up_in_camera(pitch, roll)
    along = horizontal(up, heading)
    R = world_frame(up, along)
    mirrored = world_frame(mirror @ up, mirror @ along)
    assert frame_difference_rad(mirrored, mirror @ R @ mirror) < 1e-6


@given(st.floats(0.0, 0.7))
def test_difference_measures_the_turn(angle: float) -> None:
    a = world_frame(np.array([0.0, -1.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    b = world_frame(up_in_camera(angle, 0.0), np.array([0.0, 0.0, 1.0]))
    np.testing.assert_allclose(frame_difference_rad(a, b), angle, atol=1e-6)


def test_looking_straight_down_still_has_a_frame() -> None:
    R = world_frame(np.array([0.0, 0.0, -1.0]), np.array([0.0, 0.0, 1.0]))
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-9)
