"""The embedded camera stage, without networks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import CameraEstimate, CameraHypothesis, Inputs, Photo
from diorama_core.geometry.segments import line_segments_px
from diorama_core.perception.camera.frames import frame_difference_rad
from diorama_core.perception.camera.gravity_depth import DepthFrame, frame_from_depth
from diorama_core.perception.camera.vanishing import FOCAL_PRIOR, FrameFit, Lines, prior_frame, search_frames
from diorama_core.progress import Progress
from diorama_core.scene.types import Intrinsics

MIN_SEGMENTS = 6
"""Fewer segments do not determine the room's axes."""
DISTINCT_RAD = float(np.deg2rad(3.0))
"""Readings nearer than this are the same reading."""
FRAME_MARGIN = 0.025
"""Share of the longer side within which a segment along the picture's side may be a frame's."""
FRAME_SLANT = 0.02
HOPELESS_GAP = 0.12
"""A reading whose score is so much below the best one's is not worth a second look."""
CLEAR_GAP = 0.05
"""A second reading whose score is nearer than this to the best one's makes the best one doubtful."""
SURE_SUPPORT, UNSURE_SUPPORT = 0.6, 0.2
"""Shares of agreeing lines at which confidence is full and none."""


@dataclass(frozen=True)
class EmbeddedCamera:
    """Intrinsics from the user, the photo's header, vanishing points or habit; gravity from depth or vanishing points.

    Implements `diorama_core.protocols.CameraStage`.
    """

    hypotheses: int = 3
    """Maximum number of camera hypotheses."""

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        """The readings of one photo, best first; never fails on a picture without lines, but says so."""
        photo = inputs.photo
        given, source = _stated_intrinsics(inputs)
        progress.report(0.1, "looking for straight lines")
        segments = _of_the_room(line_segments_px(photo.rgb), photo)
        assumed = given or _habitual_intrinsics(photo, FOCAL_PRIOR[0])
        side = max(photo.width, photo.height)
        progress.report(0.3, "reading the room's directions")
        fits: tuple[FrameFit, ...] = ()
        if len(segments) >= MIN_SEGMENTS:
            fits = search_frames(Lines.of(segments, assumed), given.fx / side if given else None)
        fits = _distinct(fits, self.hypotheses)
        readings = tuple(
            CameraHypothesis(given or _habitual_intrinsics(photo, f.focal), f.R_world_camera, _unit(f.score))
            for f in fits
        )
        estimate = _from_lines(readings, fits, assumed, source, given is not None)
        if inputs.depth_m is None:
            return estimate
        progress.report(0.7, "looking for the floor in the measured depth")
        return _with_depth(estimate, inputs, self.hypotheses)


def _of_the_room(segments_px: Float[np.ndarray, "n 4"], photo: Photo) -> Float[np.ndarray, "m 4"]:
    """Without the edges of a plain frame around the picture, which many cameras' rectification leaves behind."""
    size = np.array([photo.width, photo.height])
    margin = FRAME_MARGIN * size.max()
    ends = segments_px.reshape(-1, 2, 2)
    straight = np.abs(ends[:, 0] - ends[:, 1]) < FRAME_SLANT * np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)[:, None]
    near = (ends < margin).all(axis=1) | (ends > size - margin).all(axis=1)
    return segments_px[~(straight & near).any(axis=1)]


def _stated_intrinsics(inputs: Inputs) -> tuple[Intrinsics | None, str]:
    photo = inputs.photo
    if inputs.intrinsics is not None:
        return inputs.intrinsics, "focal length given"
    if photo.exif_focal_px is not None:
        focal = photo.exif_focal_px / max(photo.width, photo.height)
        return _habitual_intrinsics(photo, focal), "focal length from the photo's header"
    return None, ""


def _habitual_intrinsics(photo: Photo, focal: float) -> Intrinsics:
    """Square pixels, centred; `focal` over the longer side."""
    pixels = focal * max(photo.width, photo.height)
    return Intrinsics(photo.width, photo.height, pixels, pixels, photo.width / 2, photo.height / 2)


def _distinct(fits: tuple[FrameFit, ...], count: int) -> tuple[FrameFit, ...]:
    """The best readings that differ from all better ones, and are not hopeless beside the first."""
    retained: list[FrameFit] = []
    for fit in fits:
        if fit.score > fits[0].score - HOPELESS_GAP and all(
            frame_difference_rad(fit.R_world_camera, k.R_world_camera) > DISTINCT_RAD for k in retained
        ):
            retained.append(fit)
    return tuple(retained[:count])


def _from_lines(
    readings: tuple[CameraHypothesis, ...], fits: tuple[FrameFit, ...], assumed: Intrinsics, source: str, known: bool
) -> CameraEstimate:
    if not readings:
        habit = CameraHypothesis(assumed, prior_frame(), 0.0)
        focal = source or "usual focal length assumed"
        return CameraEstimate((habit,), 0.05, f"{focal}; too few straight lines, usual tilt assumed")
    confidence = _unit((fits[0].support - UNSURE_SUPPORT) / (SURE_SUPPORT - UNSURE_SUPPORT))
    if len(fits) > 1:
        confidence *= 1.0 - 0.5 * (1.0 - _unit((fits[0].score - fits[1].score) / CLEAR_GAP))
    confidence = max(0.05, confidence if known else 0.85 * confidence)
    focal = source or "focal length from vanishing points"
    doubt = "" if confidence > 0.35 else " (few agreeing lines: check it)"
    return CameraEstimate(readings, confidence, f"{focal}; tilt and room directions from vanishing points{doubt}")


def _with_depth(estimate: CameraEstimate, inputs: Inputs, count: int) -> CameraEstimate:
    """Measured surfaces decide over lines; the readings of the lines stay behind as alternatives."""
    assert inputs.depth_m is not None
    best = estimate.best
    frame = frame_from_depth(inputs.depth_m, best.intrinsics, best.R_world_camera)
    focal = estimate.source.split(";")[0]
    if frame is None:
        said = f"{estimate.source}; no floor or other level surface in the measured depth"
        return CameraEstimate(estimate.hypotheses, 0.8 * estimate.confidence, said)
    reading = CameraHypothesis(best.intrinsics, frame.R_world_camera, 1.0)
    others = [
        h for h in estimate.hypotheses if frame_difference_rad(h.R_world_camera, frame.R_world_camera) > DISTINCT_RAD
    ]
    return CameraEstimate(
        hypotheses=(reading, *others[: count - 1]),
        confidence=_depth_confidence(frame),
        source=f"{focal}; {_depth_words(frame)}",
        height_m=frame.height_m,
    )


def _depth_confidence(frame: DepthFrame) -> float:
    if frame.height_m is None:
        return 0.6
    return 0.8 + 0.2 * _unit(frame.level_share / 0.15)


def _depth_words(frame: DepthFrame) -> str:
    axes = "room directions from measured walls" if frame.wall_share > 0.02 else "room directions from lines"
    if frame.height_m is None:
        return f"tilt from measured level surfaces, {axes}; no floor visible, so the height over it is unknown"
    return f"tilt from the measured floor, {axes}; camera {frame.height_m:.2f} m above it"


def _unit(value: float) -> float:
    return float(np.clip(value, 0.0, 1.0))
