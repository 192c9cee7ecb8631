from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_app.reconstruction.camera_correction import check_angles
from diorama_core.artefacts import CameraEstimate, CameraHypothesis, Inputs
from diorama_core.errors import InputError
from diorama_core.geometry.rotations import CameraAttitude
from diorama_core.perception.camera.estimate import GivenAttitudeCamera
from diorama_core.progress import Progress
from diorama_core.provenance import CameraSource
from diorama_core.scene.types import Intrinsics, yaw_rotation
from tests.app.small_room import photo_camera, plain_photo


@given(st.floats(-1.3, 1.3), st.floats(-0.7, 0.7), st.floats(-3.1, 3.1))
def test_a_camera_attitude_is_read_back(tilt: float, roll: float, heading: float) -> None:
    R = CameraAttitude(tilt, roll).rotation(np.array([np.cos(heading), np.sin(heading), 0.3]))
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(R) == pytest.approx(1.0)
    read = CameraAttitude.of(R)
    assert (read.pitch_rad, read.roll_rad) == pytest.approx((tilt, roll), abs=1e-6)
    np.testing.assert_allclose(read.rotation(R[:, 2]), R, atol=1e-6)
    assert float(np.arctan2(R[1, 2], R[0, 2])) == pytest.approx(heading, abs=1e-6)


def test_the_small_rooms_camera_is_pitched_twelve_degrees_down() -> None:
    camera_attitude = CameraAttitude.of(photo_camera().T_world_camera[:3, :3])
    assert np.degrees([camera_attitude.pitch_rad, camera_attitude.roll_rad]) == pytest.approx([12.0, 0.0], abs=1e-6)


class Found:
    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        R = yaw_rotation(0.2) @ photo_camera().T_world_camera[:3, :3]
        reading = CameraHypothesis(Intrinsics.from_fov(640, 480, 1.0), R, 0.5)
        return CameraEstimate((reading, replace(reading, score=0.1)), 0.4, CameraSource.exact())


def test_what_is_said_of_the_tilt_leaves_heading_and_focal_length() -> None:
    estimate = GivenAttitudeCamera(Found(), CameraAttitude(0.3, 0.1)).estimate(Inputs(plain_photo()), Progress())
    assert len(estimate.hypotheses) == 1
    assert CameraAttitude.of(estimate.best.R_world_camera).pitch_rad == pytest.approx(0.3)
    before = Found().estimate(Inputs(plain_photo()), Progress()).best
    after = estimate.best
    assert after.intrinsics == before.intrinsics
    forward = [R[:2, 2] / np.linalg.norm(R[:2, 2]) for R in (before.R_world_camera, after.R_world_camera)]
    np.testing.assert_allclose(*forward, atol=1e-9)
    assert estimate.source == replace(CameraSource.exact(), attitude_corrected=True)


@pytest.mark.parametrize(("tilt", "roll"), [(85.0, 0.0), (0.0, -50.0)])
def test_nobody_holds_a_camera_so(tilt: float, roll: float) -> None:
    with pytest.raises(InputError, match="not possible for a photo of a room"):
        check_angles(tilt, roll)
