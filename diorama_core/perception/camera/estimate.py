"""The embedded camera stage, and a camera whose tilt and roll a person has stated."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import CameraEstimate, CameraHypothesis, Inputs, Photo
from diorama_core.geometry.rotations import CameraAttitude
from diorama_core.geometry.segments import line_segments_px
from diorama_core.perception.camera.frames import frame_difference_rad
from diorama_core.perception.camera.gravity_depth import frame_from_depth
from diorama_core.perception.camera.vanishing import (
    SETTINGS,
    FrameFit,
    LineCameraSettings,
    Lines,
    prior_frame,
    search_frames,
)
from diorama_core.progress import Progress
from diorama_core.protocols import CameraStage
from diorama_core.provenance import AttitudeSource, CameraSource, FocalSource, HeadingSource
from diorama_core.scene.types import Intrinsics

DISTINCT_RAD = float(np.deg2rad(3.0))
"""Readings nearer than this are the same reading."""


@dataclass(frozen=True)
class EmbeddedCamera:
    """Intrinsics from the user, the photo's header, vanishing points or habit; gravity from depth or vanishing points.

    Implements `diorama_core.protocols.CameraStage`.
    """

    hypotheses: int = 3
    """Maximum number of camera hypotheses."""
    settings: LineCameraSettings = SETTINGS

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        """The readings of one photo, best first; never fails on a picture without lines, but says so."""
        photo = inputs.photo
        given, stated = _intrinsics_from_inputs(inputs)
        progress.report(0.1, "looking for straight lines")
        segments = _without_frame_edges(line_segments_px(photo.rgb), photo, self.settings)
        assumed = given or _habitual_intrinsics(photo, self.settings.focal_prior[0])
        side = max(photo.width, photo.height)
        progress.report(0.3, "reading the room's directions")
        fits: tuple[FrameFit, ...] = ()
        if len(segments) >= self.settings.min_segments:
            fits = search_frames(
                Lines.of(segments, assumed, self.settings), given.fx / side if given else None, settings=self.settings
            )
        fits = _distinct(fits, self.hypotheses, self.settings)
        readings = tuple(
            CameraHypothesis(given or _habitual_intrinsics(photo, f.focal), f.R_world_camera, _unit(f.score))
            for f in fits
        )
        estimate = _from_lines(readings, fits, assumed, stated, self.settings)
        if inputs.depth_m is None:
            return estimate
        progress.report(0.7, "looking for the floor in the measured depth")
        return _with_depth(estimate, inputs, self.hypotheses, self.settings)


def _without_frame_edges(
    segments_px: Float[np.ndarray, "n 4"], photo: Photo, settings: LineCameraSettings
) -> Float[np.ndarray, "m 4"]:
    """Segments without the edges of a plain frame around the picture, which rectification often leaves behind."""
    size = np.array([photo.width, photo.height])
    margin = settings.frame_margin * size.max()
    ends = segments_px.reshape(-1, 2, 2)
    straight = (
        np.abs(ends[:, 0] - ends[:, 1])
        < settings.frame_slant * np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)[:, None]
    )
    near = (ends < margin).all(axis=1) | (ends > size - margin).all(axis=1)
    return segments_px[~(straight & near).any(axis=1)]


def _intrinsics_from_inputs(inputs: Inputs) -> tuple[Intrinsics | None, FocalSource | None]:
    photo = inputs.photo
    if inputs.intrinsics is not None:
        return inputs.intrinsics, FocalSource.GIVEN
    if photo.exif_focal_px is not None:
        focal = photo.exif_focal_px / max(photo.width, photo.height)
        return _habitual_intrinsics(photo, focal), FocalSource.HEADER
    return None, None


def _habitual_intrinsics(photo: Photo, focal: float) -> Intrinsics:
    """Square pixels, centred; `focal` over the longer side."""
    pixels = focal * max(photo.width, photo.height)
    return Intrinsics(photo.width, photo.height, pixels, pixels, photo.width / 2, photo.height / 2)


def _distinct(fits: tuple[FrameFit, ...], count: int, settings: LineCameraSettings) -> tuple[FrameFit, ...]:
    """The best readings that differ from all better ones, and are not hopeless beside the first."""
    distinct: list[FrameFit] = []
    for fit in fits:
        if fit.score > fits[0].score - settings.hopeless_gap and all(
            frame_difference_rad(fit.R_world_camera, k.R_world_camera) > DISTINCT_RAD for k in distinct
        ):
            distinct.append(fit)
    return tuple(distinct[:count])


def _from_lines(
    readings: tuple[CameraHypothesis, ...],
    fits: tuple[FrameFit, ...],
    assumed: Intrinsics,
    stated: FocalSource | None,
    settings: LineCameraSettings,
) -> CameraEstimate:
    """The readings of the lines; the usual camera where there are none."""
    if not readings:
        habit = CameraHypothesis(assumed, prior_frame(), 0.0)
        focal = stated or FocalSource.ASSUMED
        return CameraEstimate((habit,), 0.05, CameraSource(focal, AttitudeSource.ASSUMED, HeadingSource.ASSUMED))
    confidence = _unit((fits[0].support - settings.unsure_support) / (settings.sure_support - settings.unsure_support))
    if len(fits) > 1:
        confidence *= 1.0 - 0.5 * (1.0 - _unit((fits[0].score - fits[1].score) / settings.clear_gap))
    confidence = max(0.05, 0.85 * confidence if stated is None else confidence)
    source = CameraSource(
        stated or FocalSource.VANISHING_POINTS,
        AttitudeSource.VANISHING_POINTS,
        HeadingSource.VANISHING_POINTS,
        few_lines=confidence <= settings.doubtful,
    )
    return CameraEstimate(readings, confidence, source)


def _with_depth(estimate: CameraEstimate, inputs: Inputs, count: int, settings: LineCameraSettings) -> CameraEstimate:
    """Measured surfaces decide over lines; the readings of the lines stay behind as alternatives."""
    assert inputs.depth_m is not None
    best = estimate.best
    frame = frame_from_depth(inputs.depth_m, best.intrinsics, best.R_world_camera)
    if frame is None:
        source = replace(estimate.source, no_level_surface=True)
        return CameraEstimate(estimate.hypotheses, 0.8 * estimate.confidence, source)
    reading = CameraHypothesis(best.intrinsics, frame.R_world_camera, 1.0)
    others = [
        h for h in estimate.hypotheses if frame_difference_rad(h.R_world_camera, frame.R_world_camera) > DISTINCT_RAD
    ]
    no_floor = frame.height_m is None
    source = CameraSource(
        estimate.source.focal,
        AttitudeSource.LEVEL_SURFACES if no_floor else AttitudeSource.FLOOR,
        HeadingSource.WALLS if frame.wall_share > settings.min_wall_share else HeadingSource.VANISHING_POINTS,
    )
    confidence = 0.6 if no_floor else 0.8 + 0.2 * _unit(frame.level_share / 0.15)
    return CameraEstimate((reading, *others[: count - 1]), confidence, source, height_m=frame.height_m)


def _unit(value: float) -> float:
    return float(np.clip(value, 0.0, 1.0))


@dataclass(frozen=True)
class GivenAttitudeCamera:
    """A camera stage that replaces the attitude of another stage's cameras by a given one."""

    stage: CameraStage
    camera_attitude: CameraAttitude

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        """One reading: the other stage's best, tilted and rolled as given; its heading stays."""
        estimate = self.stage.estimate(inputs, progress)
        best = replace(
            estimate.best, R_world_camera=self.camera_attitude.rotation(estimate.best.R_world_camera[:, 2]), score=1.0
        )
        source = replace(estimate.source, attitude_corrected=True)
        return replace(estimate, hypotheses=(best,), confidence=1.0, source=source)


def with_given_attitude(stage: CameraStage, camera_attitude: CameraAttitude | None) -> CameraStage:
    """The stage with the given attitude, where there is one."""
    if camera_attitude is None or isinstance(stage, GivenAttitudeCamera):
        return stage
    return GivenAttitudeCamera(stage, camera_attitude)
