from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.geometry.rotations import rotation_from_vector, rotation_vector
from diorama_core.multiview.sphere_room import SphereRoom
from diorama_core.multiview.sphere_scene import SphereLines, room_axes, sphere_lines, sphere_planes
from diorama_core.scene.types import yaw_rotation
from tests.multiview.spheres import BOX, room_sphere


def test_planes_look_into_the_room_and_share_corners() -> None:
    room = sphere_planes(SphereRoom(BOX, 0.8, np.array([0.7, 0.1, 0.7, 0.7])), 1.5)
    middle = np.array([0.1, 0.1, 1.4])
    assert all(float(p.normal @ middle) > p.offset for p in room.planes)
    assert [w.is_seen for w in room.by_role("wall")] == [True, False, True, True]
    assert room.by_role("ceiling")[0].polygon[:, 2] == pytest.approx(1.5 * 1.8)


def off_deg(found: np.ndarray, true: np.ndarray) -> float:
    """Angle between two frames, quarter turns about the vertical apart."""
    return min(
        float(np.rad2deg(np.linalg.norm(rotation_vector(yaw_rotation(k * np.pi / 2) @ found @ true.T))))
        for k in range(4)
    )


@settings(max_examples=20)
@given(st.integers(0, 10_000))
def test_axes_are_found_among_lines_of_no_room(seed: int) -> None:
    rng = np.random.default_rng(seed)
    tilt = rotation_from_vector(np.array([*rng.uniform(-0.12, 0.12, 2), 0.0]))
    true = yaw_rotation(rng.uniform(-np.pi, np.pi)) @ tilt
    axes = np.eye(3)[rng.integers(0, 3, 150)] + rng.normal(0, 0.004, (150, 3))
    normals = np.cross(axes, rng.normal(size=(150, 3))) @ true
    normals = np.concatenate([normals, rng.normal(size=(60, 3))])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    found = room_axes(SphereLines(normals, rng.uniform(0.1, 0.5, 210)))
    assert off_deg(found, true) < 0.3


def test_a_tilted_picture_of_a_room_is_levelled() -> None:
    true = yaw_rotation(0.3) @ rotation_from_vector(np.array([0.05, -0.03, 0.0]))
    picture = cv2.resize(room_sphere(BOX, 0.8, true, 2048), (1024, 512), interpolation=cv2.INTER_AREA)
    assert off_deg(room_axes(sphere_lines(picture)), true) < 0.3


def test_a_picture_without_lines_stays() -> None:
    plain = np.full((64, 128, 3), 90, np.uint8)
    assert room_axes(sphere_lines(plain)) == pytest.approx(np.eye(3))
