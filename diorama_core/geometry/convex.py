"""Convex parts of shapes: what collides with what, exactly enough and fast.

Furniture is assembled from boxes, prisms and turned pieces, so the hulls of a mesh's connected components already
are a good convex decomposition. Each hull is then replaced by a simpler convex body that contains it (box, prism,
discrete-orientation polytope) where that costs little volume, so that separating-axis tests stay short. Parts always
contain the mesh: two shapes whose parts are apart do not touch. None reaches below it: shapes stand on their feet.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Float, Int
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from diorama_core.geometry.vectors import unique_rows
from diorama_core.scene.values import ArrayValue, read_only_array

TIGHT = 0.88
"""A simpler body is taken when the hull fills at least this share of it."""
MERGE = 0.93
"""Two parts become one when together they fill at least this share of their common hull."""
MAX_PARTS = 16
SMALL_SHARE = 0.006
"""Components with less than this share of the shape's box keep their hull, whatever they look like."""
MAX_PIECES = 40
"""Components beyond this many are joined with their neighbours before anything else."""
MAX_VERTICES = 24
THINNEST_M = 1e-3
_LEVEL_M = 1e-5
"""Parts reach this far below and above the mesh at most, but for what gives flat things a thickness."""
_ROUGH = np.array(
    [d for d in itertools.product((-2, -1, 0, 1, 2), repeat=3) if max(map(abs, d)) == 2], dtype=np.float64
)
"""Directions in which the extreme points of large clouds are taken to estimate volumes."""
_SAME_DIRECTION = 1.0 - 1e-5


@dataclass(frozen=True, eq=False)
class ConvexPart(ArrayValue):
    """One convex body in a shape's canonical frame, with the directions its separating axes come from."""

    vertices: Float[np.ndarray, "v 3"]
    normals: Float[np.ndarray, "f 3"]
    """Unit face normals up to sign."""
    edges: Float[np.ndarray, "e 3"]
    """Unit edge directions up to sign."""

    def __post_init__(self) -> None:
        for name in ("vertices", "normals", "edges"):
            object.__setattr__(self, name, read_only_array(getattr(self, name), (-1, 3)))


def box_part(lower: object, upper: object) -> ConvexPart:
    """The axis-aligned box between two corners."""
    low, high = np.asarray(lower, dtype=np.float64), np.asarray(upper, dtype=np.float64)
    signs = np.array([[(i >> axis) & 1 for axis in range(3)] for i in range(8)])
    return ConvexPart(np.where(signs == 1, high, low), np.eye(3), np.eye(3))


def prism_part(polygon: Float[np.ndarray, "k 3"], extrusion: Float[np.ndarray, "3"]) -> ConvexPart:
    """A convex planar polygon swept along `extrusion`."""
    sides = np.roll(polygon, -1, axis=0) - polygon
    sides = sides[np.linalg.norm(sides, axis=1) > 1e-9]
    caps = np.cross(sides, extrusion)
    normals = np.vstack([np.cross(sides[0], np.roll(sides, -1, axis=0)[0])[None], caps])
    edges = np.vstack([sides, np.asarray(extrusion)[None]])
    return ConvexPart(np.vstack([polygon, polygon + extrusion]), _directions(normals), _directions(edges))


def hull_part(points: Float[np.ndarray, "n 3"]) -> ConvexPart:
    """The exact convex hull of points; flat or empty sets become thin boxes."""
    hull = _hull(points)
    if hull is None:
        return _thick_box(points)
    return ConvexPart(points[hull.vertices], _directions(hull.equations[:, :3]), _hull_edges(hull))


def convex_parts(mesh: trimesh.Trimesh) -> tuple[ConvexPart, ...]:
    """Decompose a mesh into few convex bodies that contain it, largest first.

    Connected components that are convex enough keep their hull; others are cut by planes where that removes most
    empty volume. Neighbours that together are nearly convex are merged, contained parts dropped.
    """
    vertices, faces = np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces)
    if len(faces) == 0:
        raise ValueError("a shape without faces has no convex parts")
    clouds: list[np.ndarray] = []
    small = SMALL_SHARE * float(np.prod(np.ptp(vertices, axis=0)))
    for component in _components(vertices, faces):
        clouds.extend(_split(vertices[component], small, 0))
    clouds = _merge(_gather([_hull_points(c) for c in clouds]))
    clouds = _drop_contained(sorted(clouds, key=_volume, reverse=True))
    low, high = float(vertices[:, 2].min()), float(vertices[:, 2].max())
    return tuple(_level(simplest_part(c), c, low, high) for c in clouds)


def _level(part: ConvexPart, points: np.ndarray, low: float, high: float) -> ConvexPart:
    """The part about some points without what of it is below or above two heights, so that feet and tops are level."""
    z = part.vertices[:, 2]
    thin = bool((np.ptp(points, axis=0) < THINNEST_M).any())
    if thin or (z.min() >= low - _LEVEL_M and z.max() <= high + _LEVEL_M):
        return part
    ends = [[0.0, 0.0, 1.0, -high], [0.0, 0.0, -1.0, low]]
    try:
        planes = np.unique(np.round(np.vstack([ConvexHull(part.vertices).equations, ends]), 9), axis=0)
        corners = HalfspaceIntersection(planes, points.mean(axis=0)).intersections
    except QhullError:
        return part  # the points are too flat to have an inside
    return hull_part(np.unique(np.round(corners, 9), axis=0))


def simplest_part(points: Float[np.ndarray, "n 3"]) -> ConvexPart:
    """The simplest body (fewest axes) that contains the points and is filled by their hull to at least `TIGHT`."""
    low, high = points.min(axis=0), points.max(axis=0)
    volume = _volume(points)
    if volume < 1e-12 or (high - low).min() < THINNEST_M or volume >= TIGHT * float(np.prod(high - low)):
        return _thick_box(points)
    for axis in (2, 0, 1):
        prism = _prism_about(points, axis, volume)
        if prism is not None and volume >= TIGHT * _volume(np.asarray(prism.vertices)):
            return prism
    to_box, extents = _oriented_box(points)
    if volume >= TIGHT * float(np.prod(extents)):
        return _turn_box(to_box, extents)
    return hull_part(points) if len(_hull_points(points)) <= MAX_VERTICES else _polytope(points)


def _hull(points: np.ndarray) -> ConvexHull | None:
    """The convex hull; None for points that span no volume, or no area."""
    try:
        return ConvexHull(points)
    except (QhullError, ValueError):
        return None


def _thick_box(points: Float[np.ndarray, "n 3"]) -> ConvexPart:
    """The box around points, nowhere thinner than `THINNEST_M`."""
    low, high = points.min(axis=0), points.max(axis=0)
    pad = np.maximum(0.5 * (THINNEST_M - (high - low)), 0.0)
    return box_part(low - pad, high + pad)


def _directions(vectors: np.ndarray) -> Float[np.ndarray, "k 3"]:
    """Unit vectors, parallel and opposite ones once; in a fixed order."""
    lengths = np.linalg.norm(vectors, axis=1)
    units = vectors[lengths > 1e-12] / lengths[lengths > 1e-12, None]
    same = np.abs(units @ units.T) >= _SAME_DIRECTION
    # Each direction is kept unless an earlier one is the same.
    distinct = units[~np.tril(same, -1).any(axis=1)]
    return distinct if len(distinct) else np.eye(3)


def _hull_edges(hull: ConvexHull) -> Float[np.ndarray, "e 3"]:
    """Directions of the edges between faces that are not parallel."""
    a = np.repeat(np.arange(len(hull.simplices)), 3)
    b = hull.neighbors.reshape(-1)
    turn = (hull.equations[a, :3] * hull.equations[b, :3]).sum(axis=1)
    shared = np.sort(hull.simplices[:, [[1, 2], [0, 2], [0, 1]]].reshape(-1, 2), axis=1)  # a neighbour lacks one corner
    both = (shared[:, :, None] == hull.simplices[b][:, None, :]).any(axis=2).all(axis=1)
    other = (hull.simplices.reshape(-1, 1) == hull.simplices[b]).any(axis=1)
    first, second = shared[(b > a) & (turn < _SAME_DIRECTION) & both & ~other].T
    return _directions(hull.points[second] - hull.points[first])


def _components(vertices: np.ndarray, faces: Int[np.ndarray, "f 3"]) -> list[np.ndarray]:
    """Triangles (f 3) of each body: faces that share an edge, by index or as the only two at that place.

    Bodies that merely touch along an edge stay apart; seams within one body, where indices differ, do not cut it.
    """
    _, merged = unique_rows(np.round(vertices, 6))
    by_place, by_index = _edge_numbers(merged[faces]), _edge_numbers(faces)
    of_face = np.repeat(np.arange(len(faces)), 3)
    manifold = np.bincount(by_place)[by_place] == 2
    hubs = np.concatenate([by_place[manifold], int(by_place.max()) + 1 + by_index])
    rows = np.concatenate([of_face[manifold], of_face])
    size = len(faces) + int(hubs.max()) + 1
    link = coo_matrix((np.ones(len(hubs)), (rows, len(faces) + hubs)), shape=(size, size))
    label = connected_components(link, directed=False)[1][: len(faces)]
    return [faces[label == k] for k in np.unique(label)]


def _edge_numbers(corners: Int[np.ndarray, "f 3"]) -> Int[np.ndarray, " e"]:
    """A number for each of the three sides of each face, the same for the same pair of corners."""
    edges = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return np.unique(edges[:, 0] * (int(corners.max()) + 1) + edges[:, 1], return_inverse=True)[1].reshape(-1)


def _hull_points(points: np.ndarray) -> np.ndarray:
    flat = points.reshape(-1, 3)
    hull = _hull(flat)
    return flat if hull is None else flat[hull.vertices]


def _volume(points: np.ndarray) -> float:
    """Volume of the convex hull; of a rough one when there are many points."""
    flat = points.reshape(-1, 3)
    if len(flat) > 2 * len(_ROUGH):
        flat = flat[np.unique((flat @ _ROUGH.T).argmax(axis=0))]
    hull = _hull(flat)
    return 0.0 if hull is None else float(hull.volume)


def _solid_volume(triangles: Float[np.ndarray, "t 3 3"]) -> float:
    """Signed volume enclosed by triangles; meaningful when they are closed and wound alike."""
    return abs(float(np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum()) / 6.0)


def _split(triangles: Float[np.ndarray, "t 3 3"], small: float, depth: int) -> list[np.ndarray]:
    """Cut a surface by axis planes while that removes a good share of its hull's volume."""
    whole = _volume(triangles)
    if depth >= 3 or whole <= small or (depth == 0 and _solid_volume(triangles) >= TIGHT * whole):
        return [triangles]
    low, high = triangles.reshape(-1, 3).min(axis=0), triangles.reshape(-1, 3).max(axis=0)
    best: tuple[float, int, float] | None = None
    for axis, share in itertools.product(range(3), (0.12, 0.3, 0.5, 0.7, 0.88)):
        at = float(low[axis] + share * (high[axis] - low[axis]))
        most = 0.9 * whole if best is None else best[0]
        above = _volume(_one_side(triangles, axis, at, 1.0))
        total = above if above >= most else above + _volume(_one_side(triangles, axis, at, -1.0))
        if total < most:
            best = (total, axis, at)
    if best is None:
        return _split_blindly(triangles, whole, small, depth)
    halves = [_cut(triangles, best[1], best[2], sign) for sign in (1.0, -1.0)]
    return [piece for half in halves for piece in _split(half, small, depth + 1)]


def _split_blindly(triangles: np.ndarray, whole: float, small: float, depth: int) -> list[np.ndarray]:
    """Rings gain nothing from one cut but much from two: halve along the longest side and see."""
    if depth > 1:
        return [triangles]
    low, high = triangles.reshape(-1, 3).min(axis=0), triangles.reshape(-1, 3).max(axis=0)
    axis = int((high - low).argmax())
    halves = [_cut(triangles, axis, float(low[axis] + high[axis]) / 2, sign) for sign in (1.0, -1.0)]
    pieces = [piece for half in halves if len(half) for piece in _split(half, small, depth + 1)]
    return pieces if sum(_volume(piece) for piece in pieces) < 0.85 * whole else [triangles]


def _one_side(triangles: np.ndarray, axis: int, at: float, sign: float) -> Float[np.ndarray, "n 3"]:
    """Corners of the part of a surface on one side of the plane x[axis] = at."""
    height = sign * (triangles[:, :, axis] - at)
    points = [triangles[height >= 0]]
    for k in range(3):
        a, b = height[:, k], height[:, (k + 1) % 3]
        crossing = a * b < 0
        t = (a[crossing] / (a[crossing] - b[crossing]))[:, None]
        points.append(triangles[crossing, k] * (1 - t) + triangles[crossing, (k + 1) % 3] * t)
    return np.vstack(points)


def _cut(triangles: np.ndarray, axis: int, at: float, sign: float) -> Float[np.ndarray, "t 3 3"]:
    """One side of a surface cut by the plane x[axis] = at, as triangles."""
    normal, origin = np.zeros(3), np.zeros(3)
    normal[axis], origin[axis] = sign, at
    vertices, faces, _ = trimesh.intersections.slice_faces_plane(
        triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), normal, origin
    )
    return np.asarray(vertices)[np.asarray(faces)]


def _gather(clouds: list[np.ndarray]) -> list[np.ndarray]:
    """At most `MAX_PIECES` clouds: many small ones (leaves, slats) are joined with their neighbours."""
    if len(clouds) <= MAX_PIECES:
        return clouds
    centres = np.array([0.5 * (c.min(axis=0) + c.max(axis=0)) for c in clouds])
    group = fcluster(linkage(centres, "ward"), MAX_PIECES, "maxclust")
    return [_hull_points(np.vstack([c for c, g in zip(clouds, group) if g == k])) for k in np.unique(group)]


def _merge(clouds: list[np.ndarray]) -> list[np.ndarray]:
    """Join parts while the union stays nearly convex; beyond `MAX_PARTS`, those that add least empty space."""
    parts = {k: _Cloud.of(c) for k, c in enumerate(clouds)}
    added = {pair: _empty_volume(parts[pair[0]], parts[pair[1]]) for pair in itertools.combinations(parts, 2)}
    while added:
        pair = min(added, key=added.__getitem__)
        filled = parts[pair[0]].volume + parts[pair[1]].volume
        if added[pair] > (1.0 / MERGE - 1.0) * filled + 1e-7 and len(parts) <= MAX_PARTS:
            break
        joined = _hull_points(np.vstack([parts[pair[0]].points, parts[pair[1]].points]))
        for k in pair:
            del parts[k]
        added = {p: v for p, v in added.items() if not set(p) & set(pair)}
        new = max([*parts, *pair]) + 1
        parts[new] = _Cloud.of(joined)
        added.update({(k, new): _empty_volume(parts[k], parts[new]) for k in parts if k != new})
    return [cloud.points for cloud in parts.values()]


@dataclass(frozen=True, eq=False)
class _Cloud:
    """Points with the volume of their hull and their box, which are asked for with every other cloud."""

    points: Float[np.ndarray, "n 3"]
    volume: float
    lower: tuple[float, ...]
    upper: tuple[float, ...]

    @classmethod
    def of(cls, points: Float[np.ndarray, "n 3"]) -> _Cloud:
        """The cloud of some points."""
        return cls(points, _volume(points), tuple(points.min(axis=0).tolist()), tuple(points.max(axis=0).tolist()))


def _empty_volume(a: _Cloud, b: _Cloud) -> float:
    """Empty volume that the common hull of two parts would enclose, m3; estimated from boxes for distant parts."""
    apart = max(max(p - q, r - s) for p, q, r, s in zip(a.lower, b.upper, b.lower, a.upper, strict=True))
    if apart > 0.01:
        sides = (max(p, q) - min(r, s) for p, q, r, s in zip(a.upper, b.upper, a.lower, b.lower, strict=True))
        return 0.5 * math.prod(sides) + apart
    return max(_volume(np.vstack([a.points, b.points])) - a.volume - b.volume, 0.0)


def _drop_contained(clouds: list[np.ndarray]) -> list[np.ndarray]:
    """Without the parts that lie inside a larger one (largest first)."""
    outer: list[np.ndarray] = []
    planes: list[np.ndarray] = []
    for cloud in clouds:
        if any((cloud @ p[:, :3].T + p[:, 3] <= 1e-5).all() for p in planes):
            continue
        outer.append(cloud)
        if (hull := _hull(cloud)) is not None:
            planes.append(hull.equations)
    return outer


def _prism_about(points: np.ndarray, axis: int, volume: float) -> ConvexPart | None:
    """A prism along one axis whose outline has at most eight sides and contains the points' outline.

    None where it cannot be tight about a hull of this volume.
    """
    u, v = [(1, 2), (2, 0), (0, 1)][axis]
    flat = _hull(points[:, [u, v]])
    if flat is None or volume < TIGHT * float(flat.volume) * float(np.ptp(points[:, axis])):
        return None  # an outline of fewer sides only encloses more
    outline = outer_polygon(points[:, [u, v]][flat.vertices], 8)
    ring = np.zeros((len(outline), 3))
    ring[:, u], ring[:, v] = outline[:, 0], outline[:, 1]
    ring[:, axis] = points[:, axis].min()
    sweep = np.zeros(3)
    sweep[axis] = np.ptp(points[:, axis])
    return prism_part(ring, sweep)


def outer_polygon(polygon: Float[np.ndarray, "n 2"], most: int) -> Float[np.ndarray, "m 2"]:
    """A convex polygon with at most `most` sides around a convex counter-clockwise one, adding little area."""
    corners = [np.asarray(p, dtype=np.float64) for p in polygon]
    while len(corners) > most:
        options = [(_tip(corners, k), k) for k in range(len(corners))]
        valid = [(area, k, tip) for (area, tip), k in options if tip is not None]
        if not valid:
            break
        _, k, tip = min(valid, key=lambda option: option[0])
        after = (k + 1) % len(corners)
        corners[k] = tip
        del corners[after]
    return np.array(corners)


def _tip(corners: list[np.ndarray], k: int) -> tuple[float, np.ndarray | None]:
    """Where the neighbours of side k meet when it is removed, and the area that adds."""
    n = len(corners)
    before, a, b, after = corners[k - 1], corners[k], corners[(k + 1) % n], corners[(k + 2) % n]
    da, db = a - before, b - after
    cross = da[0] * db[1] - da[1] * db[0]
    if abs(cross) < 1e-12:
        return np.inf, None
    gap = b - a
    t = (gap[0] * db[1] - gap[1] * db[0]) / cross
    s = (gap[0] * da[1] - gap[1] * da[0]) / cross
    if t < 0 or s < 0:
        return np.inf, None
    tip = a + t * da
    return 0.5 * abs(float(t * (da[0] * gap[1] - da[1] * gap[0]))), tip


def _oriented_box(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A tight box along the points' principal axis, as (homogeneous transform into the box's frame, extents)."""
    centred = points - points.mean(axis=0)
    axis = np.linalg.svd(centred, full_matrices=False)[2][0]
    helper = np.eye(3)[int(np.abs(axis).argmin())]
    u = np.cross(axis, helper)
    u /= np.linalg.norm(u)
    v = np.cross(axis, u)
    angles = np.arange(18) * (np.pi / 36)
    turned = np.cos(angles)[:, None] * u + np.sin(angles)[:, None] * v
    across = np.cross(axis, turned)
    areas = np.ptp(points @ turned.T, axis=0) * np.ptp(points @ across.T, axis=0)
    k = int(areas.argmin())
    R = np.stack([axis, turned[k], across[k]])
    local = points @ R.T
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, -(local.min(axis=0) + local.max(axis=0)) / 2
    return T, np.ptp(local, axis=0)


def _turn_box(to_box: np.ndarray, extents: np.ndarray) -> ConvexPart:
    local = box_part(-extents / 2, extents / 2)
    T = np.linalg.inv(to_box)
    R = T[:3, :3]
    return ConvexPart(local.vertices @ R.T + T[:3, 3], R.T, R.T)


def _polytope(points: np.ndarray) -> ConvexPart:
    """The discrete-orientation polytope over the axes and their diagonals around the points."""
    raw = [d for d in itertools.product((-1, 0, 1), repeat=3) if d > (0, 0, 0) and np.abs(d).sum() <= 2]
    directions = np.array(raw, dtype=np.float64)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    reach = points @ directions.T
    halfspaces = np.vstack(
        [np.column_stack([directions, -reach.max(axis=0)]), np.column_stack([-directions, reach.min(axis=0)])]
    )
    corners = HalfspaceIntersection(halfspaces, points.mean(axis=0)).intersections
    return hull_part(np.unique(np.round(corners, 9), axis=0))
