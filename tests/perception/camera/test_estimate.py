"""The camera stage on whole inputs: synthetic rooms, hopeless pictures, real photos."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import CameraEstimate, Inputs, Photo
from diorama_core.errors import Cancelled
from diorama_core.perception.camera.estimate import EmbeddedCamera
from diorama_core.perception.camera.frames import frame_difference_rad, pitch_and_roll
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from diorama_core.provenance import AttitudeSource, CameraSource, FocalSource, HeadingSource
from tests.perception.camera.boxroom import degrees_between, depth, room_frame, shaded_picture, view

LINES = (AttitudeSource.VANISHING_POINTS, HeadingSource.VANISHING_POINTS)
NOTHING = CameraSource(FocalSource.ASSUMED, AttitudeSource.ASSUMED, HeadingSource.ASSUMED)


def inputs_of(rgb: np.ndarray, **more: object) -> Inputs:
    size = (rgb.shape[1], rgb.shape[0])
    return Inputs(Photo(rgb=rgb, name="room.png", original_size=size), **more)


def estimate(inputs: Inputs) -> CameraEstimate:
    return EmbeddedCamera().estimate(inputs, Progress())


def gravity_error_deg(found: CameraEstimate, truth: np.ndarray) -> float:
    return degrees_between(found.best.R_world_camera[2], truth[2])


class TestSyntheticRooms:
    v = view(pitch_deg=14, roll_deg=2, heading_deg=24)

    def test_from_a_picture_with_given_intrinsics(self) -> None:
        found = estimate(inputs_of(shaded_picture(self.v), intrinsics=self.v.intrinsics))
        assert gravity_error_deg(found, room_frame(self.v)) < 1.0
        assert found.best.intrinsics == self.v.intrinsics
        assert found.height_m is None
        assert found.source == CameraSource(FocalSource.GIVEN, *LINES)

    def test_from_a_picture_alone(self) -> None:
        found = estimate(inputs_of(shaded_picture(self.v)))
        assert gravity_error_deg(found, room_frame(self.v)) < 1.5
        assert found.best.intrinsics.fx == pytest.approx(self.v.intrinsics.fx, rel=0.08)
        assert found.source == CameraSource(FocalSource.VANISHING_POINTS, *LINES)

    def test_with_depth(self) -> None:
        given = inputs_of(shaded_picture(self.v), intrinsics=self.v.intrinsics, depth_m=depth(self.v, noise=0.0015))
        found = estimate(given)
        assert gravity_error_deg(found, room_frame(self.v)) < 0.5
        assert found.height_m == pytest.approx(1.4, rel=0.02)
        assert found.source == CameraSource(FocalSource.GIVEN, AttitudeSource.FLOOR, HeadingSource.WALLS)

    def test_the_header_is_believed_before_vanishing_points(self) -> None:
        given = inputs_of(shaded_picture(self.v))
        given = replace(given, photo=replace(given.photo, exif_focal_px=500.0))
        found = estimate(given)
        assert found.best.intrinsics.fx == 500.0
        assert found.source.focal is FocalSource.HEADER

    def test_a_frame_around_the_picture_is_no_room(self) -> None:
        rgb = shaded_picture(self.v).copy()
        rgb[:6], rgb[-6:], rgb[:, :6], rgb[:, -6:] = 255, 255, 255, 255
        assert gravity_error_deg(estimate(inputs_of(rgb, intrinsics=self.v.intrinsics)), room_frame(self.v)) < 1.0


class TestHopelessPictures:
    @pytest.mark.parametrize("size", [(32, 32), (480, 640), (1600, 200)])
    def test_blank(self, size: tuple[int, int]) -> None:
        found = estimate(inputs_of(np.full((*size, 3), 200, np.uint8)))
        pitch, roll = pitch_and_roll(found.best.R_world_camera[2])
        assert np.rad2deg(pitch) == pytest.approx(12)
        assert roll == pytest.approx(0)
        assert found.confidence < 0.1
        assert found.source == NOTHING

    def test_noise(self) -> None:
        rgb = np.random.default_rng(0).integers(0, 256, (240, 320, 3)).astype(np.uint8)
        found = estimate(inputs_of(rgb))
        assert found.confidence < 0.3

    def test_one_line(self) -> None:
        rgb = np.full((240, 320, 3), 255, np.uint8)
        rgb[60:180, 158:160] = 0
        assert estimate(inputs_of(rgb)).confidence < 0.1

    def test_depth_without_anything_level(self) -> None:
        rgb = np.full((240, 320, 3), 200, np.uint8)
        found = estimate(inputs_of(rgb, depth_m=np.full((240, 320), 2.0, np.float32)))
        assert found.height_m is None
        assert found.source == replace(NOTHING, no_level_surface=True)

    def test_can_be_stopped(self) -> None:
        token = CancelToken()
        token.cancel()
        with pytest.raises(Cancelled):
            EmbeddedCamera().estimate(inputs_of(np.zeros((64, 64, 3), np.uint8)), Progress(token=token))

    def test_reports_what_it_does(self) -> None:
        events: list[ProgressEvent] = []
        EmbeddedCamera().estimate(inputs_of(np.zeros((64, 64, 3), np.uint8)), Progress(on_event=events.append))
        assert [e.fraction for e in events] == sorted(e.fraction for e in events)


@pytest.fixture(scope="module")
def as_given(photos: list) -> dict[str, CameraEstimate]:
    """What is estimated of photos with all that they came with, where that is depth or no focal length."""
    return {p.id: estimate(p.inputs) for p in photos if p.depth is not None or p.intrinsics is None}


@pytest.fixture(scope="module")
def withheld(photos: list) -> dict[str, CameraEstimate]:
    """What is estimated of photos without the depth and the focal length that they came with."""
    return {
        p.id: estimate(replace(p.inputs, intrinsics=None, depth_m=None)) for p in photos if p.intrinsics is not None
    }


class TestRealPhotos:
    def test_every_photo_gets_distinct_valid_readings(
        self, photos: list, as_given: dict[str, CameraEstimate], withheld: dict[str, CameraEstimate]
    ) -> None:
        assert {*as_given, *withheld} == {p.id for p in photos}
        for found in (*as_given.values(), *withheld.values()):
            assert 1 <= len(found.hypotheses) <= 3
            for i, one in enumerate(found.hypotheses):
                R = one.R_world_camera
                np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-6)
                assert (R @ [0, 0, 1])[1] >= abs((R @ [0, 0, 1])[0]) - 1e-6
                assert all(frame_difference_rad(R, o.R_world_camera) > np.deg2rad(3) for o in found.hypotheses[i + 1 :])

    def test_gravity_of_lines_agrees_with_the_measured_floor(
        self, photos: list, as_given: dict[str, CameraEstimate]
    ) -> None:
        errors = []
        for entry in photos:
            if entry.depth is not None:
                measured = as_given[entry.id]
                assert measured.height_m is not None
                without = replace(entry.inputs, depth_m=None)
                errors.append(gravity_error_deg(estimate(without), measured.best.R_world_camera))
        assert len(errors) == 4
        assert np.median(errors) < 1.5
        assert max(errors) < 3.0

    def test_withheld_focal_lengths_are_found(self, photos: list, withheld: dict[str, CameraEstimate]) -> None:
        known = {p.id: p.inputs.intrinsics.fx for p in photos if p.intrinsics is not None}
        errors = [abs(found.best.intrinsics.fx / known[name] - 1) for name, found in withheld.items()]
        assert np.median(errors) < 0.05
        assert np.mean(np.array(errors) < 0.1) > 0.85
