"""Ceilings in measured points: the flat one, and slopes of attics and gables."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.architecture.walls.surface import MeasuredSurface
from diorama_core.architecture.walls.wall_candidates import tolerance_m

FLAT_COSINE = float(np.cos(np.deg2rad(13.0)))
STEEP_COSINE = float(np.cos(np.deg2rad(75.0)))
"""Slopes steeper than this are walls that lean."""
GROWTH_COSINE = float(np.cos(np.deg2rad(12.0)))
SNAP_RAD = np.deg2rad(4.0)


@dataclass(frozen=True)
class CeilingsSettings:
    """When measured points are a ceiling."""

    min_flat_share: float = 0.004
    """A ceiling counts as seen when this share of the measured points lies on it."""
    level_cosine: float = 0.9
    """A level ceiling's own normals scatter more than slopes are told apart from it."""
    min_slope_area_m2: float = 0.5
    min_slope_points: int = 200
    max_seen_through: float = 0.08
    """A slope through which a larger share of its points' number is seen is no ceiling."""
    lowest_slope_m: float = 1.2
    """Slopes whose middle is lower than this belong to furniture."""
    max_slopes: int = 4
    alike_m: float = 0.25
    """Slopes of about one direction nearer than this are one slope."""


SETTINGS = CeilingsSettings()


@dataclass(frozen=True, eq=False)
class CeilingPiece:
    """A plane that bounds the room from above: the room is where `normal . p >= offset`."""

    normal: Float[np.ndarray, "3"]
    """Unit, downward into the room."""
    offset: float
    area_m2: float

    @property
    def is_flat(self) -> bool:
        """Whether it is level."""
        return bool(self.normal[2] < -1.0 + 1e-9)


def find_ceilings(surface: MeasuredSurface) -> tuple[CeilingPiece, ...]:
    """The flat ceiling where one is seen, then slopes, largest first."""
    slopes = _slopes(surface)
    height = ceiling_height(surface, without=_is_on_piece(surface, slopes))
    flat = () if height is None else (CeilingPiece(np.array([0.0, 0.0, -1.0]), -height, np.inf),)
    return (*flat, *slopes)


def ceiling_height(surface: MeasuredSurface, without: Bool[np.ndarray, "n"] | None = None) -> float | None:
    """Height of the highest large level surface that faces down; none where there is none above the camera."""
    down = (surface.normals[:, 2] < -SETTINGS.level_cosine) & ~surface.is_object
    down &= surface.points[:, 2] > max(1.7, surface.camera_position[2] + 0.2)
    down &= ~without if without is not None else True
    if down.sum() < SETTINGS.min_flat_share * len(down) or len(down) == 0:
        return None
    heights, areas = surface.points[down, 2], surface.area_m2[down]
    index = (heights / 0.05).astype(int)
    histogram = np.convolve(np.bincount(index, weights=areas), np.ones(3), mode="same")
    strong = np.flatnonzero(histogram > 0.4 * histogram.max())
    centre = (strong.max() + 0.5) * 0.05
    core = np.abs(heights - centre) < 0.1
    return float(np.average(heights[core], weights=areas[core])) if core.any() else None


def _slopes(surface: MeasuredSurface) -> tuple[CeilingPiece, ...]:
    """Tilted planes overhead: the commonest direction first, its points removed, and again."""
    nz = surface.normals[:, 2]
    free = (nz < -STEEP_COSINE) & (nz > -FLAT_COSINE) & ~surface.is_object & (surface.points[:, 2] > 0.8)
    slopes: list[CeilingPiece] = []
    for _ in range(2 * SETTINGS.max_slopes):
        if free.sum() < SETTINGS.min_slope_points or len(slopes) == SETTINGS.max_slopes:
            break
        member = free & (surface.normals @ _commonest(surface, free) > GROWTH_COSINE)
        piece, taken = _fit_slope(surface, member)
        free &= ~(taken | member)
        if piece is not None and not any(_alike(piece, other) for other in slopes):
            slopes.append(piece)
    return tuple(sorted(slopes, key=lambda p: -p.area_m2))


def _alike(a: CeilingPiece, b: CeilingPiece) -> bool:
    return bool(a.normal @ b.normal > GROWTH_COSINE and abs(a.offset - b.offset) < SETTINGS.alike_m)


def _commonest(surface: MeasuredSurface, free: Bool[np.ndarray, "n"]) -> Float[np.ndarray, "3"]:
    """The direction that most of the surface shares, from a coarse grid of normals."""
    cells = np.round(surface.normals[free] / 0.15).astype(int)
    _, label = np.unique(cells, axis=0, return_inverse=True)
    label = label.ravel()
    fullest = int(np.bincount(label, weights=surface.area_m2[free]).argmax())
    mean = surface.normals[free][label == fullest].mean(axis=0)
    return np.asarray(mean / np.linalg.norm(mean))


def _fit_slope(
    surface: MeasuredSurface, member: Bool[np.ndarray, "n"]
) -> tuple[CeilingPiece | None, Bool[np.ndarray, "n"]]:
    """The plane through most of the members, if it can be a ceiling, and the points it explains."""
    nothing = np.zeros(len(member), dtype=bool)
    if member.sum() < SETTINGS.min_slope_points:
        return None, nothing
    mean = surface.normals[member].mean(axis=0)
    offsets = surface.points @ (mean / np.linalg.norm(mean))
    inliers = member & (np.abs(offsets - np.median(offsets[member])) < 0.25)
    for _ in range(4):
        if inliers.sum() < SETTINGS.min_slope_points:
            return None, nothing
        normal, offset = surface.world_plane(inliers)
        near = np.abs(surface.points @ normal - offset) < tolerance_m(surface.depth_m)
        inliers = near & (surface.normals @ normal > GROWTH_COSINE) & ~surface.is_object
    normal, offset = _snap_slope(surface, inliers, normal, offset)
    beyond = surface.points @ normal < offset - 0.1 - 2.0 * tolerance_m(surface.depth_m)
    area = float(surface.area_m2[inliers].sum())
    possible = (
        area >= SETTINGS.min_slope_area_m2
        and beyond.sum() <= SETTINGS.max_seen_through * inliers.sum()
        and float(surface.points[inliers, 2].mean()) > SETTINGS.lowest_slope_m
        and float(surface.camera_position @ normal) > offset + 0.1
        and -FLAT_COSINE < normal[2] < -STEEP_COSINE
    )
    return (CeilingPiece(normal, offset, area) if possible else None), inliers


def _snap_slope(
    surface: MeasuredSurface, inliers: Bool[np.ndarray, "n"], normal: Float[np.ndarray, "3"], offset: float
) -> tuple[Float[np.ndarray, "3"], float]:
    """The slope turned to fall along a room axis, where nearly all its points still lie on it."""
    heading = float(np.arctan2(normal[1], normal[0]))
    axis = round(heading / (np.pi / 2)) * (np.pi / 2)
    if inliers.sum() == 0 or abs(np.arctan2(np.sin(heading - axis), np.cos(heading - axis))) > SNAP_RAD:
        return normal, offset
    run = float(np.hypot(normal[0], normal[1]))
    straight = np.array([*(run * np.round([np.cos(axis), np.sin(axis)])), normal[2]])
    moved = float(np.median(surface.points[inliers] @ straight))
    tight = 0.012 + surface.noise
    agree, at_axis = (
        (np.abs(surface.points[inliers] @ n - o) < tight).sum() for n, o in ((normal, offset), (straight, moved))
    )
    return (straight, moved) if at_axis > 0.85 * agree else (normal, offset)


def _is_on_piece(surface: MeasuredSurface, pieces: tuple[CeilingPiece, ...]) -> Bool[np.ndarray, "n"]:
    on = np.zeros(len(surface.points), dtype=bool)
    for piece in pieces:
        on |= np.abs(surface.points @ piece.normal - piece.offset) < tolerance_m(surface.depth_m)
    return on
