"""Gravity, room axes and the camera's height from measured depth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from diorama_core.geometry.depth_grid import points_camera, reduce, smooth_normals_camera
from diorama_core.perception.camera.frames import world_frame
from diorama_core.scene.types import Intrinsics

UP_CONE_RAD = float(np.deg2rad(50.0))
"""How far gravity may lie from the expected direction."""
UNSUPPORTED_CONE_RAD = float(np.deg2rad(25.0))
"""Where no floor confirms it: what faces further away is more likely a wall."""
ALIGNED_RAD = float(np.deg2rad(12.0))
LEVEL_RAD = float(np.deg2rad(8.0))
NORMAL_NOISE_RAD = float(np.deg2rad(3.0))


@dataclass(frozen=True)
class GravityDepthSettings:
    """How gravity and height are fitted to depth."""

    working_side_px: int = 240
    """Depth is read at no more than so many pixels a side; planes need no more."""
    min_level_m2: float = 0.12
    """Least area of level surface at one height that counts as a floor."""
    floor_height_m: tuple[float, float] = (0.35, 30.0)
    """Camera heights over a floor: nearer level surfaces are tables, and no hall is seen from higher up."""
    below_share: float = 0.02
    """More than this share of all points clearly below a surface means that it is not the floor."""
    point_noise_m: float = 0.006
    depth_noise_per_m: float = 0.003
    """Deviation of a measured point from its surface: a constant part, and one that grows with the square of depth."""
    points_per_fact: float = 10.0
    normals_per_fact: float = 50.0
    """So many neighbouring points, or smoothed normals, err together and count as one."""
    max_trials: int = 300
    max_voters: int = 4000
    bin_m: float = 0.02


SETTINGS = GravityDepthSettings()


@dataclass(frozen=True)
class GravityFrame:
    """Camera attitude estimated from measured depth."""

    R_world_camera: Float[np.ndarray, "3 3"]
    height_m: float | None
    """Over the floor; None where no floor is visible."""
    level_share: float
    """Share of the measured points that lie on level surfaces: the evidence for gravity."""
    wall_share: float
    """Share of the measured points that face one of the room's horizontal directions."""


@dataclass(frozen=True)
class _Samples:
    """Measured points with normals, and the area that each stands for."""

    points: Float[np.ndarray, "n 3"]
    normals: Float[np.ndarray, "n 3"]
    areas: Float[np.ndarray, "n"]


def frame_from_depth(
    depth_m: Float32[np.ndarray, "h w"], intrinsics: Intrinsics, R_expected: Float[np.ndarray, "3 3"]
) -> GravityFrame | None:
    """Gravity from level surfaces, room axes from walls, height from the floor.

    Args:
        depth_m: Measured depth, 0 where missing.
        intrinsics: Of the depth map's grid.
        R_expected: `R_world_camera` expected from lines or habit; gravity is looked for around it, and its axes serve
            where no wall is measured.

    Returns:
        The frame, or None where no level surface can be seen.
    """
    samples = _samples(depth_m, intrinsics)
    up = _level_direction(samples, R_expected[2])
    if up is None:
        return None
    floor = _floor(samples, up)
    if floor is None and up @ R_expected[2] < np.cos(UNSUPPORTED_CONE_RAD):
        return None
    if floor is not None:
        up, height = floor
    level = samples.normals @ up > np.cos(LEVEL_RAD)
    axis, wall_share = _wall_direction(samples, up, R_expected[1])
    return GravityFrame(
        R_world_camera=world_frame(up, axis),
        height_m=None if floor is None else height,
        level_share=float(level.mean()),
        wall_share=wall_share,
    )


def _samples(depth_m: Float32[np.ndarray, "h w"], intrinsics: Intrinsics) -> _Samples:
    small, k = reduce(depth_m, intrinsics, SETTINGS.working_side_px)
    points = points_camera(small, k)
    normals = smooth_normals_camera(small, k)
    known = (normals != 0).any(axis=-1)
    p, n = points[known], normals[known]
    rays = p / np.maximum(np.linalg.norm(p, axis=1, keepdims=True), 1e-9)
    slant = np.maximum(np.abs((rays * n).sum(axis=1)), 0.1)
    return _Samples(p, n, p[:, 2] ** 2 / (k.fx * k.fy) / slant)


def _level_direction(samples: _Samples, up_expected: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"] | None:
    """The direction near the expected up that most measured area faces and most other area lies along.

    All candidates are weighed at once; the best is refined by least squares on the normals that agree.
    """
    near = samples.normals @ up_expected > np.cos(UP_CONE_RAD)
    normals, areas = samples.normals[near], _area_weights(samples.areas[near])
    if len(normals) < 30:
        return None
    candidates = normals[_spread(len(normals), SETTINGS.max_trials)]
    voters = _spread(len(normals), SETTINGS.max_voters)
    agreement = np.exp((normals[voters] @ candidates.T - 1.0) / np.deg2rad(5.0) ** 2)
    support = areas[voters] @ agreement * (len(normals) / len(voters))
    # Walls cross level surfaces at right angles: a direction that walls lie along is more likely up.
    others = samples.normals[~near]
    across = others[_spread(len(others), SETTINGS.max_voters)]
    along_walls = (np.abs(across @ candidates.T) < np.sin(np.deg2rad(4.0))).sum(axis=0)
    support += 0.3 * along_walls * (len(others) / max(len(across), 1))
    prior = 1.0 - 0.5 * (1.0 - candidates @ up_expected) / (1.0 - np.cos(UP_CONE_RAD))
    up = candidates[int((support * prior).argmax())]
    for limit in (ALIGNED_RAD, LEVEL_RAD, LEVEL_RAD, LEVEL_RAD):
        level = normals[normals @ up > np.cos(limit)]
        if len(level) < 30:
            return None
        upright = samples.normals[np.abs(samples.normals @ up) < np.sin(limit)]
        form = len(level) * np.eye(3) - level.T @ level + upright.T @ upright
        least = np.linalg.eigh(form)[1][:, 0]
        up = least if least @ up > 0 else -least
    return up


def _spread(total: int, count: int) -> Int[np.ndarray, "m"]:
    """At most `count` indices, evenly spread."""
    return np.linspace(0, total - 1, min(count, total)).astype(int)


def _area_weights(areas: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
    """Relative weights between pixels and areas: far points are few, but noisy."""
    return np.sqrt(areas / areas.mean()) if len(areas) else areas


def _floor(samples: _Samples, up: Float[np.ndarray, "3"]) -> tuple[Float[np.ndarray, "3"], float] | None:
    """The lowest level surface of some extent with next to nothing below it: refined up, and camera height."""
    level = samples.normals @ up > np.cos(ALIGNED_RAD)
    drops = -(samples.points[level] @ up)
    if len(drops) == 0:
        return None
    edges = np.arange(SETTINGS.floor_height_m[0], SETTINGS.floor_height_m[1], SETTINGS.bin_m)
    histogram = np.histogram(drops, bins=edges, weights=samples.areas[level])[0]
    broad = np.convolve(histogram, np.ones(5), mode="same")
    enough = np.flatnonzero(broad > max(SETTINGS.min_level_m2, 0.05 * broad.max()))
    all_drops = -(samples.points @ up)
    for start in enough[::-1]:
        low = max(0, start - 5)
        height = float(edges[low + int(broad[low : start + 1].argmax())]) + 0.5 * SETTINGS.bin_m
        if (all_drops > height + 0.06 + 0.03 * height).mean() < SETTINGS.below_share:
            return _fit_floor(samples, level, up, height)
    return None


def _fit_floor(
    samples: _Samples, level: Bool[np.ndarray, "n"], up: Float[np.ndarray, "3"], height: float
) -> tuple[Float[np.ndarray, "3"], float]:
    """The direction that fits the floor's points and the walls' normals best, each trusted as far as it reaches.

    A wide floor decides alone; a far sliver is tilted by the depth's noise, and upright surfaces keep it straight. Both
    are quadratic forms in the direction sought, so their sum's least eigenvector is the answer.
    """
    points = samples.points[level]
    noise = SETTINGS.point_noise_m + SETTINGS.depth_noise_per_m * points[:, 2] ** 2
    start = up
    for _ in range(4):
        near = np.abs(points @ up + height) < 3.0 * noise
        if near.sum() < 30:
            break
        weights = 1.0 / noise[near] ** 2
        centre = (weights[:, None] * points[near]).sum(axis=0) / weights.sum()
        off = (points[near] - centre) * np.sqrt(weights / SETTINGS.points_per_fact)[:, None]
        upright = samples.normals[np.abs(samples.normals @ up) < np.sin(LEVEL_RAD)]
        form = off.T @ off + upright.T @ upright / (NORMAL_NOISE_RAD**2 * SETTINGS.normals_per_fact)
        candidate = np.linalg.eigh(form)[1][:, 0]
        candidate = candidate if candidate @ start > 0 else -candidate
        if candidate @ start < np.cos(ALIGNED_RAD):
            break
        up, height = candidate, -float(centre @ candidate)
    return up, height


def _wall_direction(
    samples: _Samples, up: Float[np.ndarray, "3"], expected: Float[np.ndarray, "3"]
) -> tuple[Float[np.ndarray, "3"], float]:
    """The horizontal direction that most upright surface faces, quarter turns free, and the share that agrees."""
    along = expected - (expected @ up) * up
    along /= max(float(np.linalg.norm(along)), 1e-9)
    across = np.cross(up, along)
    upright = np.abs(samples.normals @ up) < np.sin(ALIGNED_RAD)
    if upright.sum() < 30:
        return along, 0.0
    chosen = np.flatnonzero(upright)[_spread(int(upright.sum()), SETTINGS.max_voters)]
    normals, weights = samples.normals[chosen], _area_weights(samples.areas[chosen])
    headings = np.arctan2(normals @ across, normals @ along)
    trials = np.deg2rad(np.arange(-45.0, 45.0, 0.5))
    turn = (headings[:, None] - trials + np.pi / 4) % (np.pi / 2) - np.pi / 4
    best = float(trials[int((weights @ np.exp(-0.5 * (turn / np.deg2rad(4.0)) ** 2)).argmax())])
    for _ in range(3):
        off = (headings - best + np.pi / 4) % (np.pi / 2) - np.pi / 4
        w = weights * np.exp(-0.5 * (off / np.deg2rad(4.0)) ** 2)
        best += float((w * off).sum() / max(w.sum(), 1e-9))
    agree = np.abs((headings - best + np.pi / 4) % (np.pi / 2) - np.pi / 4) < LEVEL_RAD
    return np.cos(best) * along + np.sin(best) * across, float(agree.mean() * upright.mean())
