"""Gravity, room axes and focal length from straight lines: a deterministic search over Manhattan frames.

Every frame is three vanishing points, up and two horizontals. A segment speaks for a vanishing point by the sine, in
the picture, between the segment and the line from its middle to that point (after Rother 2002; the search over frames
in place of RANSAC after Bazin et al. 2012). The response on a fixed set of directions is computed once; all frames of a
coarse grid read it; the best are scored again with each segment counted once, and refined.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from jaxtyping import Float, Float32, Int
from scipy.spatial import cKDTree

from diorama_core.perception.camera.frames import (
    facing_direction,
    frame_difference_rad,
    pitch_and_roll,
    up_in_camera,
    world_frame,
)
from diorama_core.scene.types import Intrinsics


@dataclass(frozen=True)
class LineCameraSettings:
    """How focal length and attitude are read from straight lines."""

    min_segments: int = 6
    """Fewer segments do not determine the room's axes."""
    frame_margin: float = 0.025
    """Share of the longer side within which a segment along the picture's side may be a frame's."""
    frame_slant: float = 0.02
    hopeless_gap: float = 0.12
    """A reading whose score is so much below the best one's is not worth a second look."""
    clear_gap: float = 0.05
    """A second reading whose score is nearer than this to the best one's makes the best one doubtful."""
    sure_support: float = 0.6
    unsure_support: float = 0.2
    """Shares of agreeing lines at which confidence is full and none."""
    doubtful: float = 0.35
    """Confidence up to which users are asked to check what lines say."""
    min_wall_share: float = 0.02
    """Share of the measured points on walls from which on they decide about the room's directions."""
    prior_weight: float = 0.03
    focal_prior: tuple[float, float] = (0.78, 0.25)
    """Focal length over the longer side: median, and standard deviation of the logarithm."""
    focal_range: tuple[float, float] = (0.35, 2.5)
    few_segments: float = 8.0
    """So many segments are half of full evidence against the prior."""
    directions: int = 4000
    rescored: int = 400
    difference: float = 2e-3


SETTINGS = LineCameraSettings()


SIGMA_RAD = float(np.deg2rad(1.5))
MIN_SIGMA_RAD = float(np.deg2rad(0.3))
PITCH_PRIOR_RAD = (float(np.deg2rad(12.0)), float(np.deg2rad(20.0)))
ROLL_SIGMA_RAD = float(np.deg2rad(5.0))
FOCAL_GRID = np.geomspace(0.5, 1.6, 13)
_REFINED = 10
_SEPARATION_RAD = float(np.deg2rad(5.0))


@dataclass(frozen=True)
class FrameFit:
    """One reading of the picture's lines."""

    R_world_camera: Float[np.ndarray, "3 3"]
    focal: float
    """Over the picture's longer side."""
    support: float
    """Share of the segments' weight that agrees with the frame, 0 to 1."""
    score: float
    """Support with the prior added; frames of one picture are compared by it."""


@dataclass(frozen=True)
class Lines:
    """Segments about the principal point, in units of the picture's longer side."""

    middles: Float32[np.ndarray, "n 2"]
    directions: Float32[np.ndarray, "n 2"]
    weights: Float32[np.ndarray, "n"]
    """Sum to at most 1; less where there are few segments."""

    @classmethod
    def of(
        cls, segments_px: Float[np.ndarray, "n 4"], intrinsics: Intrinsics, settings: LineCameraSettings = SETTINGS
    ) -> Lines:
        """Segments in pixels seen by a camera; only its centre and the proportion of its focal lengths are used."""
        side = max(intrinsics.width, intrinsics.height)
        scale = np.array([1.0, intrinsics.fx / intrinsics.fy]) / side
        ends = (segments_px.reshape(-1, 2, 2) - [intrinsics.cx, intrinsics.cy]) * scale
        along = ends[:, 1] - ends[:, 0]
        lengths = np.linalg.norm(along, axis=1)
        ends, along, lengths = ends[lengths > 1e-6], along[lengths > 1e-6], lengths[lengths > 1e-6]
        if len(lengths) == 0:
            return cls(*(np.zeros(shape, np.float32) for shape in ((0, 2), (0, 2), (0,))))
        weights = np.minimum(lengths, np.percentile(lengths, 95))
        weights *= len(lengths) / (len(lengths) + settings.few_segments) / weights.sum()
        as32 = (ends.mean(axis=1), along / lengths[:, None], weights)
        return cls(*(a.astype(np.float32) for a in as32))


def search_frames(lines: Lines, focal: float | None, settings: LineCameraSettings = SETTINGS) -> tuple[FrameFit, ...]:
    """The best room frames of a picture's lines, best first, at least one."""
    focals = FOCAL_GRID if focal is None else np.array([focal])
    starts: list[tuple[float, np.ndarray, float]] = []
    for f in focals.tolist():
        prior = _focal_log_prior(f, focal, settings)
        starts += [(s + prior, R, f) for s, R in _coarse_frames(lines, f, settings)]
    starts.sort(key=lambda s: -s[0])
    chosen = _select_distinct(starts, _REFINED)
    fits = sorted((_refine(lines, R, f, focal, settings) for _, R, f in chosen), key=lambda fit: -fit.score)
    return tuple(fits[:_REFINED])


def signed_sines(
    lines: Lines, axes_camera: Float[np.ndarray, "*k 3"], focal: float | Float[np.ndarray, "..."]
) -> Float[np.ndarray, "*k n"]:
    """Sine in the picture between each segment and the line from its middle to each direction's vanishing point."""
    axes = np.asarray(axes_camera, dtype=np.float32)[..., None, :]
    to_x = focal * axes[..., 0] - lines.middles[:, 0] * axes[..., 2]
    to_y = focal * axes[..., 1] - lines.middles[:, 1] * axes[..., 2]
    across = lines.directions[:, 0] * to_y - lines.directions[:, 1] * to_x
    return across / np.sqrt(to_x * to_x + to_y * to_y + 1e-12)


def _agreement(sines: Float[np.ndarray, "*n"], sigma: float = SIGMA_RAD) -> Float[np.ndarray, "*n"]:
    return np.exp(-0.5 * np.square(sines / sigma))


def _coarse_frames(
    lines: Lines, focal: float, settings: LineCameraSettings
) -> list[tuple[float, Float[np.ndarray, "3 3"]]]:
    """The best frames of the grid at one focal length, each segment counted once."""
    grid = _grid(settings)
    sines = signed_sines(lines, grid.directions, focal)
    response = _agreement(sines, 1.3 * SIGMA_RAD) @ lines.weights
    rough = response[grid.indices].sum(axis=1) + settings.prior_weight * grid.log_prior
    top = np.argpartition(-rough, settings.rescored)[: settings.rescored]
    top = top[np.lexsort((top, -rough[top]))]
    agreement = _agreement(signed_sines(lines, grid.frames[top], focal), 1.3 * SIGMA_RAD)
    scores = agreement.max(axis=1) @ lines.weights + settings.prior_weight * grid.log_prior[top]
    order = np.argsort(-scores, kind="stable")
    ranked = [(float(scores[i]), grid.frames[top[i]], focal) for i in order]
    return [(score, R) for score, R, _ in _select_distinct(ranked, _REFINED)]


def _select_distinct(
    ranked: list[tuple[float, Float[np.ndarray, "3 3"], float]], count: int
) -> list[tuple[float, Float[np.ndarray, "3 3"], float]]:
    """The best that differ from all better ones by more than five degrees (or ten percent of focal length)."""
    if not ranked:
        return []
    frames = np.array([R for _, R, _ in ranked])
    log_focals = np.log([f for _, _, f in ranked])
    alive = np.ones(len(ranked), dtype=bool)
    distinct: list[tuple[float, np.ndarray, float]] = []
    while alive.any() and len(distinct) < count:
        first = int(alive.argmax())
        distinct.append(ranked[first])
        near = frame_difference_rad(frames, frames[first]) < _SEPARATION_RAD
        alive &= ~(near & (np.abs(log_focals - log_focals[first]) < 0.1))
        alive[first] = False
    return distinct


def _refine(
    lines: Lines,
    R_start: Float[np.ndarray, "3 3"],
    focal_start: float,
    known: float | None,
    settings: LineCameraSettings,
) -> FrameFit:
    """Reweighted Gauss-Newton on rotation (and focal length), the tolerance narrowing to its final value."""
    R, focal = R_start, focal_start
    for sigma in np.array([2.0, 1.7, 1.4, 1.2, 1.0, 1.0, 1.0, 1.0]) * SIGMA_RAD:
        R, focal = _take_step(lines, R, focal, float(sigma), known, settings)
    for _ in range(5):
        R, focal = _take_step(lines, R, focal, _own_sigma(lines, R, focal), known, settings)
    R = world_frame(R[2], R[1])
    best = _agreement(signed_sines(lines, R, focal)).max(axis=0)
    support = float(best @ lines.weights)
    prior = settings.prior_weight * _frame_log_prior(R[2])
    return FrameFit(R, focal, support, support + float(prior) + _focal_log_prior(focal, known, settings))


def _own_sigma(lines: Lines, R: Float[np.ndarray, "3 3"], focal: float) -> float:
    """Spread of the inlier segments: sharp photos of straight edges allow a finer tolerance."""
    sines = np.abs(signed_sines(lines, R, focal)).min(axis=0)
    agreeing = sines[sines < 2.0 * SIGMA_RAD]
    spread = 1.48 * float(np.median(agreeing)) if len(agreeing) else SIGMA_RAD
    return float(np.clip(spread, MIN_SIGMA_RAD, SIGMA_RAD))


def _take_step(
    lines: Lines,
    R: Float[np.ndarray, "3 3"],
    focal: float,
    sigma: float,
    known: float | None,
    settings: LineCameraSettings,
) -> tuple[Float[np.ndarray, "3 3"], float]:
    """One step of least squares on the segments' sines and the priors, in units of their deviations (Gauss-Newton)."""
    free = 3 if known is not None else 4
    nearest = np.abs(signed_sines(lines, R, focal)).argmin(axis=0)
    pick = (nearest, np.arange(len(nearest)))
    trials = _trial_steps(free, settings)
    moved = R @ np.array([_rotation(t[:3]) for t in trials])
    focals = focal * np.exp(trials[:, 3]) if free == 4 else np.full(len(trials), focal)
    sines = signed_sines(lines, moved, focals[:, None, None])[:, *pick].astype(np.float64)
    weights = np.sqrt(lines.weights * _agreement(sines[-1], sigma))
    pitch, roll = pitch_and_roll(moved[:, 2])
    priors = [(pitch - PITCH_PRIOR_RAD[0]) / PITCH_PRIOR_RAD[1], roll / ROLL_SIGMA_RAD]
    if known is None:
        priors.append(np.log(focals / settings.focal_prior[0]) / settings.focal_prior[1])
    residuals = np.concatenate(
        [weights * sines / sigma, np.sqrt(settings.prior_weight) * np.stack(priors, axis=1)], axis=1
    )
    J = ((residuals[:free] - residuals[free:-1]) / (2 * settings.difference)).T
    step = -np.linalg.solve(J.T @ J + 1e-6 * np.eye(free), J.T @ residuals[-1])
    step = step * min(1.0, 0.1 / max(float(np.linalg.norm(step[:3])), 1e-9))
    if known is None:
        focal = float(np.clip(focal * np.exp(np.clip(step[3], -0.2, 0.2)), *settings.focal_range))
    return R @ _rotation(step[:3]), focal


@cache
def _trial_steps(free: int, settings: LineCameraSettings) -> Float[np.ndarray, "m free"]:
    """A little forward along each parameter, a little back, and nothing."""
    forward = np.eye(free) * settings.difference
    return np.concatenate([forward, -forward, np.zeros((1, free))])


def _rotation(vector: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """Rodrigues' formula, not `geometry.rotations`: another last digit here is another focal length in every scene."""
    angle = float(np.linalg.norm(vector))
    x, y, z = vector / max(angle, 1e-12)
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def _frame_log_prior(up_camera: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n"]:
    pitch, roll = pitch_and_roll(up_camera)
    centre, spread = PITCH_PRIOR_RAD
    return np.asarray(-0.5 * (np.square((pitch - centre) / spread) + np.square(roll / ROLL_SIGMA_RAD)))


def _focal_log_prior(focal: float, known: float | None, settings: LineCameraSettings) -> float:
    if known is not None:
        return 0.0
    median, log_sigma = settings.focal_prior
    return settings.prior_weight * -0.5 * float(np.square(np.log(focal / median) / log_sigma))


@dataclass(frozen=True)
class _Grid:
    """The fixed set of directions, and all coarse frames with the directions nearest to their axes."""

    directions: Float32[np.ndarray, "m 3"]
    frames: Float[np.ndarray, "g 3 3"]
    indices: Int[np.ndarray, "g 3"]
    log_prior: Float[np.ndarray, "g"]


@cache
def _grid(settings: LineCameraSettings) -> _Grid:
    """Pitch -30 to 62, roll -16 to 16, heading 0 to 88 degrees, by 2 degrees; computed once per process."""
    degrees = np.meshgrid(np.arange(-30, 63, 2), np.arange(-16, 17, 2), np.arange(0, 89, 2), indexing="ij")
    pitch, roll, heading = (np.deg2rad(d.ravel().astype(np.float64)) for d in degrees)
    up = up_in_camera(pitch, roll)
    forward = np.array([0.0, 0.0, 1.0]) - (up @ [0.0, 0.0, 1.0])[:, None] * up
    forward /= np.linalg.norm(forward, axis=1, keepdims=True)
    right = np.cross(forward, up)
    heading = heading - np.pi / 4
    c, s = np.cos(heading)[:, None], np.sin(heading)[:, None]
    along = c * forward + s * right
    frames = np.stack([np.cross(along, up), along, up], axis=1)
    directions = _hemisphere(settings.directions)
    tree = cKDTree(np.concatenate([directions, -directions]))
    indices = tree.query(frames.reshape(-1, 3))[1].reshape(-1, 3) % len(directions)
    return _Grid(directions.astype(np.float32), frames, indices, _frame_log_prior(up))


def _hemisphere(count: int) -> Float[np.ndarray, "count 3"]:
    """Evenly spread unit directions with z >= 0 (Fibonacci spiral)."""
    z = (np.arange(count) + 0.5) / count
    turn = np.arange(count) * np.pi * (3.0 - np.sqrt(5.0))
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)


def prior_frame() -> Float[np.ndarray, "3 3"]:
    """How a room is usually photographed: level, looking down a little, the room's axis straight ahead."""
    up = up_in_camera(PITCH_PRIOR_RAD[0], 0.0)
    return world_frame(up, facing_direction(up))
