"""The profile of a body of revolution, measured from its outline.

Every level of an upright body of revolution is a circle, whose picture lies within the body's. So at every height the
widest circle about the axis that lies within the outline says how wide the body can be there, and where that height
makes the outline, how wide it is. One side is enough: what hides the other one, or the picture's border, says nothing.
(Shape from the silhouette of a surface of revolution; here without its contour generator, so that any view will do.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Bool, Float

from diorama_core.geometry.projection import NEAR_M
from diorama_core.geometry.silhouette import ShapeCaster
from diorama_core.library.furniture.measures import can_be_made, can_be_turned, made_id
from diorama_core.library.furniture.reshaping import GIRTH, KNOTS, MAX_PERCENT, MIN_PERCENT
from diorama_core.library.record import BUILT_IN, ShapeLibrary, record_of
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.outline_fit import fit_pose, resizing_cost
from diorama_core.pose.settings import SETTINGS, PoseSettings, ShapeFitSettings
from diorama_core.scene.types import Pose

RADII = np.linspace(0.02, 1.6, 80)
"""Tried, as shares of the body's largest so far."""
ANGLES = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)


def profile_m(mesh: trimesh.Trimesh, heights_m: Float[np.ndarray, " k"]) -> Float[np.ndarray, " k"]:
    """The largest distance from the vertical axis at some heights of a shape's own frame; 0 where there is nothing."""
    ends = np.asarray(mesh.vertices)[mesh.edges_unique]
    return np.array([_reach(_section(ends, float(height))) for height in heights_m])


def is_revolution(mesh: trimesh.Trimesh, settings: ShapeFitSettings = SETTINGS.shapes) -> bool:
    """Whether most sections of a shape reach equally far all around: those of a plant or a basket's handle do not."""
    ends = np.asarray(mesh.vertices)[mesh.edges_unique]
    low, high = mesh.bounds[:, 2]
    even = []
    for share in np.linspace(settings.inset, 1.0 - settings.inset, KNOTS):
        section = _section(ends, low + float(share) * (high - low))
        sector = ((np.arctan2(section[:, 1], section[:, 0]) / (2.0 * np.pi) + 0.5) * settings.sectors).astype(
            int
        ) % settings.sectors
        reach = np.array([_reach(section[sector == k]) for k in range(settings.sectors)])
        if reach.any():
            even.append(float(np.ptp(reach)) <= settings.max_uneven * float(reach.max()))
    return bool(even) and float(np.mean(even)) >= settings.min_even


def _section(ends: Float[np.ndarray, "e 2 3"], height: float) -> Float[np.ndarray, "p 2"]:
    """Where edges cross a height."""
    z = ends[..., 2]
    a, b = np.moveaxis(ends[(z.min(axis=1) <= height) & (z.max(axis=1) >= height)], 1, 0)
    rise = b[:, 2] - a[:, 2]
    share = np.clip((height - a[:, 2]) / np.where(np.abs(rise) < 1e-9, 1.0, rise), 0.0, 1.0)
    return np.asarray((a + share[:, None] * (b - a))[:, :2])


def _reach(points_xy: Float[np.ndarray, "p 2"]) -> float:
    return float(np.hypot(*points_xy.T).max()) if len(points_xy) else 0.0


def _look_up(
    evidence: Evidence, points_world: Float[np.ndarray, "*n 3"], settings: ShapeFitSettings
) -> tuple[Bool[np.ndarray, "*n"], Bool[np.ndarray, "*n"]]:
    """Which points lie within an object's outline, and of which that is known at all, also between cells' centres."""
    flat, seen = points_world.reshape(-1, 3), evidence.seen
    pixels, in_front = evidence.camera.project(flat), evidence.camera.to_camera(flat)[:, 2] > NEAR_M
    x1, y1, x2, y2 = seen.window.bounds_px
    cells = seen.window.cells
    place = (pixels - (x1, y1)) / ((x2 - x1) / cells, (y2 - y1) / cells) - 0.5
    covered, known = (_bilinear(v.reshape(cells, cells), place) for v in (seen.covered, seen.weight))
    inside = in_front & (covered >= settings.covered)
    shape = points_world.shape[:-1]
    return inside.reshape(shape), (in_front & (known >= settings.known) | inside).reshape(shape)


def measure_girth(
    evidence: Evidence, mesh: trimesh.Trimesh, pose: Pose, settings: ShapeFitSettings
) -> tuple[int, ...] | None:
    """How much wider the body is than a shape at every knot of its height, percent; None where nothing is to be seen.

    Args:
        evidence: Of the object in the photo.
        mesh: The shape, a body of revolution.
        pose: Where it stands, upright, as high as the body and as wide at most as it may be.
    """
    low, high = mesh.bounds[:, 2]
    shares = np.clip(np.linspace(0.0, 1.0, KNOTS), settings.inset, 1.0 - settings.inset)
    heights = low + shares * (high - low)
    width = float(pose.scale[:2].mean())
    widths = np.maximum(width * profile_m(mesh, heights), 1e-4)
    tried = RADII * float(widths.max())
    circle = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)
    points = np.empty((KNOTS, len(tried), len(ANGLES), 3))
    points[..., :2] = pose.position[:2] + tried[None, :, None, None] * circle
    points[..., 2] = (pose.position[2] + pose.scale[2] * heights)[:, None, None]
    inside, known = _look_up(evidence, points, settings)
    fits = (known & ~inside).mean(axis=2) <= settings.max_outside
    widest = np.where(fits.all(axis=1), len(tried), np.argmin(fits, axis=1))
    limited = widest < len(tried)
    last = np.clip(widest, 1, len(tried)) - 1
    limited &= (widest == 0) | (
        np.take_along_axis(inside.mean(axis=2), last[:, None], axis=1)[:, 0] >= settings.min_known
    )
    if not limited.any():
        return None
    knots = np.arange(KNOTS)
    factors = np.interp(knots, knots[limited], (tried[last] / widths)[limited])
    if np.count_nonzero(factors < MIN_PERCENT / 100.0) > settings.max_narrow:
        return None
    return tuple(int(v) for v in np.clip(np.rint(100.0 * factors), MIN_PERCENT, MAX_PERCENT))


@dataclass(frozen=True, eq=False)
class Turned:
    """A design with another profile, and how well it agrees with the picture."""

    shape_id: str
    size_m: Float[np.ndarray, "3"]
    """At scale 1."""
    poses: tuple[Pose, ...]
    """Poses of the objects that it was measured for."""
    error: float
    """Mean disagreement, 0 to 1."""


def fit_profile(
    library: ShapeLibrary,
    shape_id: str,
    evidence: Sequence[Evidence],
    poses: Sequence[Pose],
    error: float,
    settings: PoseSettings = SETTINGS,
) -> Turned | None:
    """A design with the profile that the picture shows; None where it is none, or agrees hardly better.

    Args:
        library: Where it is.
        shape_id: A listed design.
        evidence: Of the objects that have this shape, alike.
        poses: Where they stand, all of one scale.
        error: How much the design as it is disagrees, in the mean.
    """
    if not can_be_turned(shape_id) or record_of(library, shape_id).source != BUILT_IN:
        return None
    mesh = library.mesh(shape_id)
    if len(mesh.faces) > settings.shapes.max_faces or not is_revolution(mesh, settings.shapes):
        return None
    profiles = [measure_girth(e, mesh, p, settings.shapes) for e, p in zip(evidence, poses, strict=True)]
    known_profiles = [g for g in profiles if g is not None]
    if not known_profiles:
        return None
    girth = tuple(int(v) for v in np.rint(np.median(known_profiles, axis=0)))
    size = _size_with_girth(mesh, np.ptp(mesh.bounds, axis=0) * poses[0].scale, girth, settings.shapes)
    if not can_be_made(shape_id, size):
        return None
    made = made_id(shape_id, size, {GIRTH: girth})
    caster = ShapeCaster(library.mesh(made))
    alone = len(poses) == 1
    fitted = [
        fit_pose(
            e, caster, Pose(p.R_world_object, p.position, np.ones(3)), size, resize=alone, settings=settings.shapes
        )
        for e, p in zip(evidence, poses, strict=True)
    ]
    errors = [e.error(caster, p) for e, p in zip(evidence, fitted, strict=True)]
    now = float(np.mean(errors))
    whole = np.round(size * fitted[0].scale, 3)
    grown = whole / (np.ptp(mesh.bounds, axis=0) * poses[0].scale)
    cost = float(np.mean([resizing_cost(e.seen, grown[None], settings.shapes)[0] for e in evidence]))
    if np.log(now + settings.evidence.noise_floor) + cost > np.log(
        settings.shapes.much_better * (error + settings.evidence.noise_floor)
    ):
        return None
    if not can_be_made(shape_id, whole):
        return None
    at_scale = tuple(Pose(p.R_world_object, p.position, np.ones(3)) for p in fitted)
    return Turned(made_id(shape_id, whole, {GIRTH: girth}), whole, at_scale, now)


def _size_with_girth(
    mesh: trimesh.Trimesh, size_m: Float[np.ndarray, "3"], girth: tuple[int, ...], settings: ShapeFitSettings
) -> Float[np.ndarray, "3"]:
    """The size with this girth of a shape that has a size without it, whole millimetres."""
    low, high = mesh.bounds[:, 2]
    radii = profile_m(
        mesh, low + np.clip(np.linspace(0.0, 1.0, KNOTS), settings.inset, 1.0 - settings.inset) * (high - low)
    )
    growth = float((radii * girth).max() / (100.0 * max(float(radii.max()), 1e-6)))
    width = float(size_m[:2].mean()) * growth
    return np.maximum(np.round([width, width, size_m[2]], 3), 1e-3)


def _bilinear(grid: Float[np.ndarray, "r c"], place: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, " n"]:
    """A grid's values between its cells' centres; beyond them nothing is covered and nothing known."""
    rows, columns = grid.shape
    padded = np.pad(grid, 1)
    x, y = np.clip(place[:, 0] + 1.0, 0.0, columns + 0.999), np.clip(place[:, 1] + 1.0, 0.0, rows + 0.999)
    i, j = y.astype(int), x.astype(int)
    u, v = y - i, x - j
    top = padded[i, j] * (1 - v) + padded[i, j + 1] * v
    return np.asarray(top * (1 - u) + (padded[i + 1, j] * (1 - v) + padded[i + 1, j + 1] * v) * u)
