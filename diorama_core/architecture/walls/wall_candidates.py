"""Vertical planes in measured points that may be walls, and whether what is seen allows it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.architecture.walls.surface import MeasuredSurface

BIN_RAD = np.deg2rad(5.0)
GROWTH_RAD = np.deg2rad(10.0)
"""Normals within this of a direction belong to it (PlainRecon's growth)."""
APART_RAD = np.deg2rad(12.5)
"""Directions nearer than this to a stronger one are not looked at on their own; fits turn freely."""
MAX_SNAP_RAD = np.deg2rad(6.0)
"""Walls turned from a room axis by less than this are taken to lie along it where their points agree with that: """
MIN_RISE_M = 0.4
"""A wall's points span at least this height."""


@dataclass(frozen=True)
class WallCandidatesSettings:
    """When a vertical plane may be a wall."""

    axis_share: float = 0.85
    """when at least this share of what lies on the freely turned line lies on the one along the axis too, within"""
    tight_m: float = 0.012
    tight_per_noise_m: float = 1.0
    """this distance, plus the second times the noise."""
    narrow_m: float = 1.2
    narrow_share: float = 0.6
    narrow_slack_m: float = 0.1
    """Directions of walls shorter than the first are known less well: less agreement is asked, and more turning
    allowed."""
    same_share: float = 0.5
    """A candidate more of whose points than this lie on a larger one is that one."""
    offset_bin_m: float = 0.05
    gap_m: float = 0.4
    """A wider gap along a wall, in plan, parts it in two that are judged on their own."""
    min_area_m2: float = 0.15
    min_points: int = 120
    max_seen_through: float = 0.5
    """A wall of which a larger share is seen through is furniture: windows and doorways stay below."""


SETTINGS = WallCandidatesSettings()


@dataclass(frozen=True)
class WallCandidate:
    """A vertical plane `normal . p = offset`, normal (2D) toward the room, with what supports it."""

    normal: Float[np.ndarray, "2"]
    offset: float
    inliers: Bool[np.ndarray, "n"]
    seen_through: float
    """Share of the wall's visible face through which something farther is measured."""
    area_m2: float

    @property
    def direction(self) -> Float[np.ndarray, "2"]:
        """Unit direction to the right as seen from the room."""
        return np.array([-self.normal[1], self.normal[0]])


def tolerance_m(depth_m: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
    """How far a point may be from its plane: sensors' errors grow with distance."""
    return 0.04 + 0.015 * depth_m


def find_walls(surface: MeasuredSurface, top_m: float) -> list[WallCandidate]:
    """Candidates that visibility allows, largest area first."""
    upright = (np.abs(surface.normals[:, 2]) < 0.35) & (surface.normals != 0).any(axis=1) & ~surface.is_object
    if upright.sum() < SETTINGS.min_points:
        return []
    candidates: list[WallCandidate] = []
    for normal in _directions(surface, upright):
        candidates += _parallel_walls(surface, upright, normal, top_m)
    distinct: list[WallCandidate] = []
    for wall in sorted(candidates, key=lambda w: -w.area_m2):
        if not any(same_wall(surface, wall, other) for other in distinct):
            distinct.append(wall)
    return distinct


def same_wall(surface: MeasuredSurface, minor: WallCandidate, major: WallCandidate) -> bool:
    """Whether the smaller candidate's points lie on the larger one too."""
    near = np.abs(surface.points[minor.inliers, :2] @ major.normal - major.offset)
    near = near < tolerance_m(surface.depth_m[minor.inliers])
    return bool(near.mean() > SETTINGS.same_share and minor.normal @ major.normal > np.cos(APART_RAD))


def _directions(surface: MeasuredSurface, upright: Bool[np.ndarray, "n"]) -> list[Float[np.ndarray, "2"]]:
    """Horizontal normals that much surface shares: peaks of the circular histogram, snapped to the room's axes."""
    heading = np.arctan2(surface.normals[upright, 1], surface.normals[upright, 0])
    weight = surface.area_m2[upright]
    bins = round(2 * np.pi / BIN_RAD)
    index = np.floor((heading + np.pi) / BIN_RAD).astype(int) % bins
    histogram = np.bincount(index, weights=weight, minlength=bins)
    smooth = histogram + 0.6 * (np.roll(histogram, 1) + np.roll(histogram, -1))
    angles: list[float] = []
    for peak in np.argsort(-smooth, kind="stable"):
        if smooth[peak] < max(SETTINGS.min_area_m2, 0.01 * weight.sum()):
            break
        centre = -np.pi + (peak + 0.5) * BIN_RAD
        if any(abs(_turn(centre - other)) < APART_RAD for other in angles):
            continue
        near = np.abs(_turn(heading - centre)) < GROWTH_RAD
        angles.append(centre + float(np.average(_turn(heading[near] - centre), weights=weight[near])))
    return [np.array([np.cos(a), np.sin(a)]) for a in angles]


def _turn(angle_rad: np.ndarray | float) -> np.ndarray:
    return np.asarray((np.asarray(angle_rad) + np.pi) % (2 * np.pi) - np.pi)


def _parallel_walls(
    surface: MeasuredSurface, upright: Bool[np.ndarray, "n"], normal: Float[np.ndarray, "2"], top_m: float
) -> list[WallCandidate]:
    """All walls facing one way: peaks of the histogram of offsets, each refined and checked."""
    member = upright & (surface.normals[:, :2] @ normal > np.cos(1.8 * GROWTH_RAD))
    offsets = surface.points[:, :2] @ normal
    if member.sum() < SETTINGS.min_points:
        return []
    low = float(offsets[member].min()) - SETTINGS.offset_bin_m
    index = ((offsets[member] - low) / SETTINGS.offset_bin_m).astype(int)
    histogram = np.bincount(index, weights=surface.area_m2[member])
    smooth = np.convolve(histogram, np.ones(3), mode="same")
    walls: list[WallCandidate] = []
    free = member.copy()
    for peak in np.argsort(-smooth, kind="stable"):
        if smooth[peak] < SETTINGS.min_area_m2:
            break
        centre = low + (peak + 0.5) * SETTINGS.offset_bin_m
        near = free & (np.abs(offsets - centre) < 2.5 * SETTINGS.offset_bin_m + tolerance_m(surface.depth_m))
        walls += _fit_walls(surface, near, normal, top_m)
        free &= ~near
    return walls


def _fit_walls(
    surface: MeasuredSurface, near: Bool[np.ndarray, "n"], normal: Float[np.ndarray, "2"], top_m: float
) -> list[WallCandidate]:
    """The wall through a slice of points; where that cannot be one, the walls among its parts between gaps."""
    if near.sum() < SETTINGS.min_points:
        return []
    fitted, offset = fit_line(surface.points[near, :2], surface.area_m2[near], normal, surface.noise)
    inliers = np.abs(surface.points[:, :2] @ fitted - offset) < tolerance_m(surface.depth_m)
    inliers &= (surface.normals[:, :2] @ fitted > np.cos(2.0 * GROWTH_RAD)) & ~surface.is_object
    if offset > surface.camera_position[:2] @ fitted - 0.1:
        return []
    whole = _validate_wall(surface, fitted, offset, inliers, top_m)
    if whole is not None:
        return [whole]
    along = np.array([-fitted[1], fitted[0]])
    parts = _split_at_gaps(surface.points[:, :2] @ along, inliers)
    judged = (_validate_wall(surface, fitted, offset, part, top_m) for part in parts if len(parts) > 1)
    return [wall for wall in judged if wall is not None]


def _validate_wall(
    surface: MeasuredSurface,
    normal: Float[np.ndarray, "2"],
    offset: float,
    inliers: Bool[np.ndarray, "n"],
    top_m: float,
) -> WallCandidate | None:
    """A wall, unless it is small, low, or farther objects are seen through it."""
    if inliers.sum() < SETTINGS.min_points or _spread(surface.points[inliers, 2]) < MIN_RISE_M:
        return None
    area = float(surface.area_m2[inliers].sum())
    through = _see_through_share(surface, normal, offset, inliers, top_m)
    if area < SETTINGS.min_area_m2 or through > SETTINGS.max_seen_through:
        return None
    return WallCandidate(normal, offset, inliers, through, area)


def _split_at_gaps(reach_m: Float[np.ndarray, "n"], member: Bool[np.ndarray, "n"]) -> list[Bool[np.ndarray, "n"]]:
    """Members split wherever none lies within `GAP_M` along the wall."""
    chosen = np.flatnonzero(member)
    if len(chosen) == 0:
        return []
    order = chosen[np.argsort(reach_m[chosen], kind="stable")]
    breaks = np.flatnonzero(np.diff(reach_m[order]) > SETTINGS.gap_m) + 1
    parts = []
    for indices in np.split(order, breaks):
        part = np.zeros(len(member), dtype=bool)
        part[indices] = True
        parts.append(part)
    return parts


def _spread(values: Float[np.ndarray, "n"]) -> float:
    low, high = np.quantile(values, [0.03, 0.97])
    return float(high - low)


def fit_line(
    points: Float[np.ndarray, "n 2"], weights: Float[np.ndarray, "n"], normal: Float[np.ndarray, "2"], noise: float
) -> tuple[Float[np.ndarray, "2"], float]:
    """Robust line through points seen from above: its normal, along a room axis where that agrees, and offset.

    Args:
        points: In plan, at least two.
        weights: Of the points.
        normal: About where it faces.
        noise: Relative error of the depths.
    """
    offset = float(np.median(points @ normal))
    core = np.ones(len(points), dtype=bool)
    for _ in range(4):
        residual = np.abs(points @ normal - offset)
        core = residual <= max(2.5 * float(np.median(residual)), 0.005)
        centre = np.average(points[core], axis=0, weights=weights[core])
        turned = np.linalg.eigh(np.cov((points[core] - centre).T, aweights=weights[core]))[1][:, 0]
        normal = turned if turned @ normal > 0 else -turned
        offset = float(centre @ normal)
    length = float(np.ptp(points[core] @ np.array([-normal[1], normal[0]])))
    max_rad = MAX_SNAP_RAD + float(np.arctan2(SETTINGS.narrow_slack_m, length))
    axis = _axis_aligned_line(points, weights, normal, noise, max_rad)
    if axis is None:
        return normal, offset
    tight = SETTINGS.tight_m + SETTINGS.tight_per_noise_m * noise
    agree, at_axis = (weights[np.abs(points @ n - o) < tight].sum() for n, o in ((normal, offset), axis))
    share = SETTINGS.axis_share if length > SETTINGS.narrow_m else SETTINGS.narrow_share
    return axis if at_axis > share * agree else (normal, offset)


def _axis_aligned_line(
    points: Float[np.ndarray, "n 2"],
    weights: Float[np.ndarray, "n"],
    normal: Float[np.ndarray, "2"],
    noise: float,
    max_rad: float,
) -> tuple[Float[np.ndarray, "2"], float] | None:
    """The line along the nearest room axis that most points lie on; none when that is too far turned."""
    heading = float(np.arctan2(normal[1], normal[0]))
    quarter = round(heading / (np.pi / 2)) * (np.pi / 2)
    if abs(_turn(heading - quarter)) > max_rad:
        return None
    axis = np.round([np.cos(quarter), np.sin(quarter)])
    offsets = points @ axis
    width = SETTINGS.tight_m + SETTINGS.tight_per_noise_m * noise
    index = ((offsets - offsets.min()) / width).astype(int)
    votes = np.convolve(np.bincount(index, weights=weights), np.ones(2), mode="same")
    centre = float(offsets.min()) + float(votes.argmax()) * width
    core = np.abs(offsets - centre) < 1.5 * width
    return axis, float(np.average(offsets[core], weights=weights[core])) if core.any() else centre


def _see_through_share(
    surface: MeasuredSurface,
    normal: Float[np.ndarray, "2"],
    offset: float,
    inliers: Bool[np.ndarray, "n"],
    top_m: float,
) -> float:
    """Share of the would-be wall, floor to ceiling over its points' width, that has farther objects behind it.

    One when what is in view above its own top is mostly farther: a screen, a wardrobe, a half-height partition.
    """
    along = np.array([-normal[1], normal[0]])
    low, high = np.quantile(surface.points[inliers, :2] @ along, [0.02, 0.98])
    crossing, share = crossings(surface, normal, offset)
    reach = crossing[:, :2] @ along
    within = (share > 0) & (reach > low) & (reach < high) & (crossing[:, 2] > 0.05) & (crossing[:, 2] < top_m - 0.05)
    rest = (1.0 - share) * np.linalg.norm(surface.points[:, :2] - surface.camera_position[:2], axis=1)
    beyond = within & (rest > 0.10 + 2.0 * tolerance_m(surface.depth_m))
    # Weighted by the wall's own area, not by that of what lies far behind it.
    size = surface.area_m2 * np.clip(share, 0.0, 1.0) ** 2
    own_top = float(np.quantile(surface.points[inliers, 2], 0.98))
    above = within & (crossing[:, 2] > own_top + 0.05)
    if above.sum() >= SETTINGS.min_points and own_top < top_m - 0.3 and (beyond & above).sum() > 0.6 * above.sum():
        return 1.0
    on = within & inliers
    return float(size[beyond].sum() / max(size[beyond].sum() + size[on].sum(), 1e-9))


def crossings(
    surface: MeasuredSurface, normal: Float[np.ndarray, "2"], offset: float
) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n"]]:
    """Where the rays to the points cross a vertical plane from its front, and at which share of their length.

    The share is -1 where they do not.
    """
    origin = surface.camera_position
    ray = surface.points - origin
    slope = ray[:, :2] @ normal
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (offset - origin[:2] @ normal) / slope
    share = np.where(np.isfinite(share) & (slope < 0), share, -1.0)
    return origin + share[:, None] * ray, share
