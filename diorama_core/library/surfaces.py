"""Where objects can stand on a shape: its flat upward faces, with the free height above them.

Planar regions are grown over a lattice of vertical rays instead of over triangles, so that a top made of planks or of
solids that run into each other is still one surface, and a face buried inside another solid is none. Clearance and the
interior flag come from the same rays (after the reference's recipe: `>= 0.05 m2` for large furniture, blocked regions
dropped, 10th percentile of the free height).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import shapely
import trimesh
from jaxtyping import Bool, Float, Int
from scipy.ndimage import distance_transform_edt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

from diorama_core.geometry.planes import signed_area
from diorama_core.geometry.ray_scene import RayScene
from diorama_core.library.record import SupportSurface

SURFACES_VERSION = 5
"""Raise it when other surfaces are found on the same shape, so that those on disk are measured again."""
MINIMUM_UP = 0.9
"""Cosine of the steepest slope that still carries objects."""
STEP_M = 0.008
"""Neighbouring samples of one surface differ in height by no more than this (a seam, a plank's edge)."""
REACH_M = 0.03
"""Gaps narrower than this (between slats and planks) do not part a surface."""
WALL_M = 0.025
"""What rises this far above a shelf between two places on it parts them."""
MINIMUM_FILL = 0.55
"""A region that fills less of its convex outline than this is a rim or a frame, not a surface."""

HOLE_M = 0.1
"""Into a wider hole in a surface things fall, and through a wider notch in its side."""
LEDGE_M = 0.05
"""A narrower strip beside a hole carries nothing."""

SEAM_STEP_M = 0.05
"""Open surfaces whose heights differ by less may be joined."""
SEAM_FILL = 0.9
"""Joined surfaces fill at least this share of their common outline."""


Places = TypeVar("Places", int, np.ndarray)


@dataclass(frozen=True)
class _Spots:
    """Upward hits of the rays that have free space above them."""

    origin: Float[np.ndarray, "2"]
    """Corner of cell (0, 0)."""
    cell_m: float
    cell: Int[np.ndarray, "s 2"]
    z: Float[np.ndarray, "s"]
    clearance: Float[np.ndarray, "s"]


def support_surfaces(mesh: trimesh.Trimesh, lattice: int = 72, *, carries: bool = False) -> tuple[SupportSurface, ...]:
    """Support surfaces of a shape in its canonical frame, highest first.

    Args:
        mesh: Closed solids, possibly overlapping, metres, +Z up.
        lattice: Rays along the longer horizontal side.
        carries: Whether people put hard things on it rather than sit on it. Then a top with a hole or a notch is
            several surfaces round that, and what is sunk into it is none: a basin.
    """
    low, high = mesh.bounds
    extent = high - low
    cell_m = float(max(extent[0], extent[1])) / lattice
    caster = RayScene(np.asarray(mesh.vertices), np.asarray(mesh.faces))
    spots = _spots(mesh, caster, cell_m)
    if len(spots.z) == 0:
        return ()
    blocked_below = float(np.clip(0.1 * extent[2], 0.02, 0.08))
    minimum_area = float(np.clip(0.12 * extent[0] * extent[1], 0.003, 0.05))
    narrowest = 0.1 if max(extent[:2]) > 0.5 else 0.03
    foot = float(low[2]) + (0.04 if extent[2] > 0.3 else 0.0)
    half_footprint = 0.5 * extent[0] * extent[1]
    low_area = float((spots.z < foot).sum()) * cell_m**2
    surfaces: list[SupportSurface] = []
    ledges: list[SupportSurface] = []
    for region in _regions(spots, caster):
        if np.median(spots.z[region]) < foot and low_area < half_footprint:
            continue  # a base plate, not a surface
        clearance = spots.clearance[region]
        if np.median(clearance) < blocked_below or len(region) * cell_m**2 < minimum_area:
            continue
        if carries and (pieces := _round_a_hole(spots, region)):
            ledges += [_surface(spots, piece, _outline(spots, piece)) for piece in pieces]
            continue
        outline = _outline(spots, region)
        if len(region) * cell_m**2 < MINIMUM_FILL * abs(signed_area(outline)) or _breadth(outline) < narrowest:
            continue
        surface = _surface(spots, region, outline)
        if not _is_enclosed(surface, caster):
            surfaces.append(surface)
    if ledges:
        surfaces = [s for s in surfaces if s.interior or not _is_walled_in(s, caster, SEAM_STEP_M)]
    surfaces = _join(surfaces) + ledges
    return tuple(sorted(surfaces, key=lambda s: (-round(s.height_m, 3), *np.round(s.polygon.mean(axis=0)[:2], 3))))


def _spots(mesh: trimesh.Trimesh, caster: RayScene, cell: float) -> _Spots:
    """Shoot rays down through the shape and keep the upward faces that lie in free space."""
    low, high = mesh.bounds
    extent = high - low
    counts = np.maximum(np.floor(extent[:2] / cell + 1e-6).astype(int), 1)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(counts[0]), np.arange(counts[1]), indexing="ij"))
    origin = low[:2] + (extent[:2] - counts * cell) / 2
    nudge = 0.013 * cell  # off the mesh's own symmetry lines, where rays would graze edges
    x = origin[0] + (i + 0.5) * cell + nudge
    y = origin[1] + (j + 0.5) * cell + 1.7 * nudge
    ray, z, up = _hits(mesh, caster, x, y, float(high[2]) + 1.0)
    depth, above = _depth_and_gap(ray, z, up)
    free = (up >= MINIMUM_UP) & (depth == 0)
    return _Spots(origin, cell, np.stack([i[ray], j[ray]], axis=1)[free], z[free], above[free])


def _hits(
    mesh: trimesh.Trimesh, caster: RayScene, x: Float[np.ndarray, "r"], y: Float[np.ndarray, "r"], top: float
) -> tuple[Int[np.ndarray, "h"], Float[np.ndarray, "h"], Float[np.ndarray, "h"]]:
    """Every hit of downward rays: ray number, height, and the face normal's z; sorted by ray, then downward."""
    rays = np.zeros((len(x), 6), dtype=np.float32)
    rays[:, 0], rays[:, 1], rays[:, 2], rays[:, 5] = x, y, top, -1.0
    ray, t, triangle = caster.all_hits(rays)
    up = mesh.face_normals[triangle][:, 2]
    order = np.lexsort((t, ray))
    return ray[order], top - t[order], up[order]


def _depth_and_gap(
    ray: Int[np.ndarray, "h"], z: Float[np.ndarray, "h"], up: Float[np.ndarray, "h"]
) -> tuple[Int[np.ndarray, "h"], Float[np.ndarray, "h"]]:
    """How many solids lie round each hit from above (0: free air), and the free height above it."""
    entering = np.where(up > 0, 1, -1)
    running = np.cumsum(entering)
    first = np.concatenate([[True], ray[1:] != ray[:-1]]) if len(ray) else np.zeros(0, dtype=bool)
    base = (running - entering)[first][np.cumsum(first) - 1] if len(ray) else running
    depth = running - entering - base
    above = np.full(len(z), np.inf)
    if len(z) > 1:
        above[1:] = np.where(first[1:], np.inf, z[:-1] - z[1:])
    return np.maximum(depth, 0), above


def _regions(spots: _Spots, caster: RayScene) -> list[Int[np.ndarray, "_"]]:
    """Spots grown together over neighbouring cells of nearly equal height, as far as nothing stands between them."""
    n = len(spots.z)
    bins = np.round(spots.z / STEP_M).astype(np.int64)
    key = _cell_key(spots.cell[:, 0], spots.cell[:, 1], bins)
    order = np.argsort(key, kind="stable")
    in_order = key[order]
    reach = int(np.clip(round(REACH_M / spots.cell_m), 2, 5))
    steps = [(k * di, k * dj) for k in range(1, reach + 1) for di, dj in ((1, 0), (0, 1), (1, 1), (1, -1))]
    pairs = []
    for (di, dj), dz in ((step, dz) for step in steps for dz in (-1, 0, 1)):
        wanted = in_order + _cell_key(di, dj, dz)  # in order, too, which takes a fraction of the time
        at = np.minimum(np.searchsorted(in_order, wanted), n - 1)
        rows = np.flatnonzero(in_order[at] == wanted)
        pairs.append((order[rows], order[at[rows]]))
    a, b = (np.concatenate(side) for side in zip(*pairs, strict=True))
    passable = ~_is_walled_off(spots, caster, a, b)
    a, b = a[passable], b[passable]
    graph = coo_matrix((np.ones(len(a)), (a, b)), shape=(n, n))
    count, label = connected_components(graph, directed=False)
    return [_flat_core(spots, np.flatnonzero(label == k)) for k in range(count)]


def _is_walled_off(
    spots: _Spots, caster: RayScene, a: Int[np.ndarray, "p"], b: Int[np.ndarray, "p"]
) -> Bool[np.ndarray, "p"]:
    """Whether something stands between two spots under a roof: the upright between two compartments of a shelf.

    Only neighbours under one roof are asked: objects in the open may reach over what parts them.
    """
    walled = np.zeros(len(a), dtype=bool)
    roofed = np.flatnonzero(np.isfinite(spots.clearance[a]) & np.isfinite(spots.clearance[b]))
    if len(roofed) == 0:
        return walled
    start, end = (
        np.column_stack([spots.origin + (spots.cell[k] + 0.5) * spots.cell_m, spots.z[k]])
        for k in (a[roofed], b[roofed])
    )
    level = np.maximum(start[:, 2], end[:, 2]) + WALL_M
    start[:, 2] = end[:, 2] = level
    rays = np.hstack([start, end - start]).astype(np.float32)
    walled[roofed] = caster.is_occluded(rays, far=1.0)
    return walled


def _cell_key(i: Places, j: Places, level: Places) -> Places:
    """A number that orders places by cell and level; that of a sum of places is the sum of theirs."""
    return (i * 100_000 + j) * 100_000 + level


def _flat_core(spots: _Spots, region: Int[np.ndarray, "k"]) -> Int[np.ndarray, "core"]:
    """The part of a region at its most common level: the slopes of a cushion's rim and a shell's sides fall away."""
    z = spots.z[region]
    tolerance = float(np.clip(0.02 * np.sqrt(len(region)) * spots.cell_m, 0.003, 0.03))
    levels = np.sort(z)
    within = np.searchsorted(levels, levels + tolerance, "right") - np.searchsorted(levels, levels - tolerance)
    return region[np.abs(z - levels[within.argmax()]) <= tolerance]


def _outline(spots: _Spots, region: Int[np.ndarray, "k"]) -> Float[np.ndarray, "n 2"]:
    """Convex outline of the cells of a region, counter-clockwise."""
    cells = spots.cell[region]
    corners = np.concatenate([cells + np.array(c) for c in ((0, 0), (0, 1), (1, 0), (1, 1))])
    return corners[ConvexHull(corners).vertices] * spots.cell_m + spots.origin


def _round_a_hole(spots: _Spots, region: Int[np.ndarray, "k"]) -> list[Int[np.ndarray, "_"]]:
    """The open strips round the hole of a region, largest first; none where it has no hole or nothing wide round it."""
    cells = spots.cell[region] - spots.cell[region].min(axis=0)
    left = np.zeros(cells.max(axis=0) + 1, dtype=bool)
    left[tuple(cells.T)] = True
    outline = shapely.convex_hull(shapely.multipoints(cells))
    inside = shapely.contains_xy(outline, *np.indices(left.shape))
    if 2.0 * float(distance_transform_edt(np.pad(inside & ~left, 1)).max()) * spots.cell_m < HOLE_M:
        return []
    pieces: list[Int[np.ndarray, "_"]] = []
    while True:
        low, high = _largest_rectangle(left)
        if (high - low).min() * spots.cell_m < LEDGE_M:
            return pieces
        left[low[0] : high[0], low[1] : high[1]] = False
        piece = region[((cells >= low) & (cells < high)).all(axis=1)]
        if np.isinf(np.median(spots.clearance[piece])):
            pieces.append(piece)


def _largest_rectangle(full: Bool[np.ndarray, "i j"]) -> tuple[Int[np.ndarray, "2"], Int[np.ndarray, "2"]]:
    """The first cell of the largest rectangle of true cells, and the one past its last; both 0 where all are false."""
    best, low, high = 0, np.zeros(2, dtype=int), np.zeros(2, dtype=int)
    above = np.zeros(full.shape[1], dtype=int)
    for i, row in enumerate(full):
        above = np.where(row, above + 1, 0)
        for height in np.unique(above[above > 0]):
            ends = np.flatnonzero(np.diff(np.concatenate([[0], above >= height, [0]])))
            start, end = max(ends.reshape(-1, 2).tolist(), key=lambda run: run[1] - run[0])
            if height * (end - start) > best:
                best = height * (end - start)
                low, high = np.array([i + 1 - height, start]), np.array([i + 1, end])
    return low, high


def _breadth(outline: Float[np.ndarray, "n 2"]) -> float:
    """Smallest distance between parallel lines that hold a convex outline."""
    edges = np.roll(outline, -1, axis=0) - outline
    normals = np.stack([-edges[:, 1], edges[:, 0]], axis=1) / np.linalg.norm(edges, axis=1, keepdims=True)
    return float(np.ptp(outline @ normals.T, axis=0).min())


def _join(surfaces: list[SupportSurface]) -> list[SupportSurface]:
    """Open surfaces at about one height with only a seam between them become one: the cushions of a seat, a made bed.

    What lies on them does not mind the seam, and rests on the higher one. Joined only where the common outline holds
    little else.
    """
    surfaces = list(surfaces)
    for i in range(len(surfaces)):
        for j in range(i + 1, len(surfaces)):
            common = _common_outline(surfaces[i], surfaces[j])
            if common is not None:
                rest = [s for k, s in enumerate(surfaces) if k not in (i, j)]
                return _join([*rest, common])
    return surfaces


def _common_outline(a: SupportSurface, b: SupportSurface) -> SupportSurface | None:
    if a.interior or b.interior or abs(a.height_m - b.height_m) > SEAM_STEP_M:
        return None
    points = np.vstack([a.polygon, b.polygon])[:, :2]
    outline = points[ConvexHull(points).vertices]
    parts = [abs(signed_area(s.polygon[:, :2])) for s in (a, b)]
    if sum(parts) < SEAM_FILL * abs(signed_area(outline)):
        return None
    height = max(a.height_m, b.height_m)
    return SupportSurface(np.column_stack([outline, np.full(len(outline), height)]), float("inf"), False)


def _surface(spots: _Spots, region: Int[np.ndarray, "k"], outline: Float[np.ndarray, "n 2"]) -> SupportSurface:
    """Outline, level and free height of one region."""
    clearance = spots.clearance[region]
    polygon = np.column_stack([outline, np.full(len(outline), float(np.median(spots.z[region])))])
    # Under the open sky objects fit beside what overhangs a part of the surface (a throw, a headboard's edge).
    interior = bool(np.isfinite(clearance).mean() > 0.5)
    lowest = float(np.percentile(clearance, 10, method="lower")) if interior else float("inf")
    return SupportSurface(polygon, lowest, interior)


def _is_enclosed(surface: SupportSurface, caster: RayScene) -> bool:
    """Whether a surface has a ceiling and walls on all four sides: nobody puts things into a closed cupboard."""
    halfway_m = 0.5 * surface.clearance_m
    return bool(np.isfinite(halfway_m)) and _is_walled_in(surface, caster, halfway_m)


def _is_walled_in(surface: SupportSurface, caster: RayScene, above_m: float) -> bool:
    """Whether there are walls on all four sides so far above a surface."""
    middle = [*surface.polygon[:, :2].mean(axis=0), surface.height_m + above_m]
    ahead = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
    return bool(caster.is_occluded(np.column_stack([np.tile(middle, (4, 1)), ahead]).astype(np.float32)).all())
