"""The carpenter's toolkit: smooth closed solids with normals and texture coordinates.

Everything is built standing on its own origin in metres, +X front, +Y left, +Z up. Texture coordinates are in metres
along the surface; a material divides them by the size of its tile. Grain runs along a solid's longest side.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np
from jaxtyping import Float, Int
from scipy.interpolate import PchipInterpolator

Vec = Sequence[float] | Float[np.ndarray, "3"]
Profile = tuple[tuple[float, float], ...]
"""(radius, height) pairs from the foot upward."""
CREASE_RAD = np.deg2rad(38.0)
"""Neighbouring faces that meet at more than this keep a visible edge."""
_SURELY = 1e-6
"""Margin of cosines, far above what rounding costs."""


@dataclass(frozen=True, eq=False)
class Solid:
    """A triangle mesh with a normal and a texture coordinate at every vertex."""

    vertices: Float[np.ndarray, "v 3"]
    faces: Int[np.ndarray, "f 3"]
    normals: Float[np.ndarray, "v 3"]
    uv: Float[np.ndarray, "v 2"]

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Solid:
        """Shifted by (x, y, z)."""
        return replace(self, vertices=self.vertices + np.array([x, y, z]))

    def turned(self, axis: str, angle_deg: float) -> Solid:
        """Turned about a coordinate axis through the origin, right-handed."""
        R = axis_rotation(axis, angle_deg)
        return replace(self, vertices=self.vertices @ R.T, normals=self.normals @ R.T)

    def scaled(self, x: float = 1.0, y: float = 1.0, z: float = 1.0) -> Solid:
        """Stretched about the origin by positive factors."""
        factors = np.array([x, y, z])
        return replace(self, vertices=self.vertices * factors, normals=unit(self.normals / factors))

    def mirrored(self, axis: int = 1) -> Solid:
        """Reflected in the plane through the origin normal to a coordinate axis (y by default)."""
        signs = np.ones(3)
        signs[axis] = -1.0
        return replace(
            self, vertices=self.vertices * signs, normals=self.normals * signs, faces=self.faces[:, ::-1].copy()
        )

    def pictured(self) -> Solid:
        """With texture coordinates that spread one whole picture over the face toward +X."""
        y, z = self.vertices[:, 1], self.vertices[:, 2]
        u = (y - y.min()) / max(float(np.ptp(y)), 1e-9)
        v = (z - z.min()) / max(float(np.ptp(z)), 1e-9)
        return replace(self, uv=np.stack([u, v], axis=1))


def unit(v: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    """Vectors scaled to length one; zero stays zero."""
    return np.asarray(v / np.maximum(length(v), 1e-12)[..., None])


def length(v: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n"]:
    """Lengths of vectors; column by column, which takes a fraction of the time of `numpy.linalg.norm`."""
    return np.asarray(np.sqrt(v[..., 0] * v[..., 0] + v[..., 1] * v[..., 1] + v[..., 2] * v[..., 2]))


def cross(a: Float[np.ndarray, "*#n 3"], b: Float[np.ndarray, "*#n 3"]) -> Float[np.ndarray, "*_ 3"]:
    """a x b, broadcasting; `numpy.cross` spends most of its time on finding out which axes are meant."""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def axis_rotation(axis: str, angle_deg: float) -> Float[np.ndarray, "3 3"]:
    """Rotation about "x", "y" or "z"."""
    i = "xyz".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    c, s = np.cos(np.deg2rad(angle_deg)), np.sin(np.deg2rad(angle_deg))
    R = np.eye(3)
    R[j, j], R[j, k], R[k, j], R[k, k] = c, -s, s, c
    return R


def finish(
    vertices: Float[np.ndarray, "v 3"],
    faces: Int[np.ndarray, "f 3"],
    uv_corners: Float[np.ndarray, "f 3 2"] | None = None,
    crease_rad: float = CREASE_RAD,
) -> Solid:
    """A welded mesh made ready: degenerate faces dropped, creased normals, texture coordinates, split vertices."""
    a, b, c = (vertices.take(faces[:, k], axis=0) for k in range(3))
    doubled_area = cross(b - a, c - a)
    keep = length(doubled_area) > 1e-12
    faces, doubled_area = faces[keep], doubled_area[keep]
    normals = _corner_normals(faces, doubled_area, crease_rad, len(vertices))
    uv = _box_uv(vertices, faces, unit(doubled_area)) if uv_corners is None else uv_corners[keep].reshape(-1, 2)
    return _split(vertices, faces, normals, uv)


def _corner_normals(
    faces: Int[np.ndarray, "f 3"], doubled_area: Float[np.ndarray, "f 3"], crease_rad: float, count: int
) -> Float[np.ndarray, "c 3"]:
    """Area-weighted normals at every face corner, over the faces round the vertex within the crease angle.

    Weighting by area keeps large flat faces flat beside their bevels. Faces that lie within half the angle of their
    vertex's mean lie within it of each other, so that only at other vertices faces are compared pair by pair.
    """
    vertex, face = faces.ravel(), np.repeat(np.arange(len(faces)), 3)
    n = unit(doubled_area)
    mean = _sums(vertex, doubled_area.take(face, axis=0), count)
    off = _dot(n.take(face, axis=0), unit(mean).take(vertex, axis=0)) <= np.cos(crease_rad / 2) + _SURELY
    creased = np.zeros(count, dtype=bool)
    creased[vertex[off]] = True
    total, rest = mean.take(vertex, axis=0), np.flatnonzero(creased.take(vertex))
    a, b = _pairs_of_equal(vertex[rest], count)
    first, second = face[rest[a]], face[rest[b]]
    close = _dot(n.take(first, axis=0), n.take(second, axis=0)) > np.cos(crease_rad)
    total[rest] = _sums(a[close], doubled_area.take(second[close], axis=0), len(rest))
    return unit(total)


def _dot(a: Float[np.ndarray, "n 3"], b: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n"]:
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2])


def _sums(label: Int[np.ndarray, "n"], vectors: Float[np.ndarray, "n 3"], count: int) -> Float[np.ndarray, "k 3"]:
    """Sum of the vectors of each label below `count`."""
    found = np.empty((count, 3))
    for k in range(3):
        found[:, k] = np.bincount(label, vectors[:, k], count)
    return found


def _pairs_of_equal(label: Int[np.ndarray, "n"], count: int) -> tuple[Int[np.ndarray, "p"], Int[np.ndarray, "p"]]:
    """All ordered pairs of places with equal labels below `count`, each place with itself included, in order."""
    order = np.argsort(label, kind="stable")
    size = np.bincount(label, minlength=count)
    start, per_place = np.cumsum(size) - size, size[label]
    a = np.repeat(np.arange(len(label)), per_place)
    step = np.arange(len(a)) - np.repeat(np.cumsum(per_place) - per_place, per_place)
    return a, order[start[label[a]] + step]


def _box_uv(
    vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"], normals: Float[np.ndarray, "f 3"]
) -> Float[np.ndarray, "c 2"]:
    """Box projection: each face along its dominant axis, the first coordinate along the solid's longest side."""
    extents = np.ptp(vertices, axis=0)
    by_length = np.argsort(-extents, kind="stable")
    dominant = np.abs(normals).argmax(axis=1)
    points = vertices[faces]
    uv = np.empty((len(faces), 3, 2))
    for axis in range(3):
        first, second = (a for a in by_length if a != axis)
        chosen = dominant == axis
        uv[chosen] = points[chosen][:, :, [first, second]]
    return uv.reshape(-1, 2)


def _split(
    vertices: Float[np.ndarray, "v 3"],
    faces: Int[np.ndarray, "f 3"],
    normals: Float[np.ndarray, "c 3"],
    uv: Float[np.ndarray, "c 2"],
) -> Solid:
    """One vertex for every distinct (position, normal, texture coordinate) among the corners."""
    index = faces.ravel().astype(np.int64)
    key = index.copy()
    for column in (*np.round(normals * 200).T, *np.round(uv * 5000).T):
        key = key * np.int64(1000003) + column.astype(np.int64)  # wraps round: a hash, not an address
    _, first, inverse = np.unique(key, return_index=True, return_inverse=True)
    return Solid(vertices[index[first]], inverse.reshape(-1, 3), normals[first], uv[first])


@cache
def _cube_grid(n: int) -> tuple[Int[np.ndarray, "v 3"], Int[np.ndarray, "f 3"]]:
    """Surface of an n x n x n grid: integer points 0..n, outward triangles."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, n):
            corners = np.zeros((n * n, 4, 3), dtype=np.int64)
            for c, (di, dj) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
                corners[:, c, axis] = side
                corners[:, c, u], corners[:, c, v] = i + di, j + dj
            quads.append(corners if side else corners[:, ::-1])
    flat = np.concatenate(quads).reshape(-1, 3)
    keys = flat @ np.array([(n + 1) ** 2, n + 1, 1])
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    q = inverse.reshape(-1, 4)
    return flat[first], np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])


def box(size: Vec, radius: float = 0.004, segments: int = 1) -> Solid:
    """A box with rounded edges, standing on z = 0, centred in x and y."""
    x, y, z = (float(s) for s in size)
    return _box((x, y, z), radius, segments)


@lru_cache(maxsize=1024)
def _box(size: tuple[float, float, float], radius: float, segments: int) -> Solid:
    half = np.asarray(size) / 2
    r = min(radius, float(half.min()) * 0.999)
    points, faces = _cube_grid(2 * segments + 1)
    high = points > segments
    t = np.where(high, points - segments - 1, points - segments) / segments
    vertices = np.where(high, 1.0, -1.0) * (half - r) + r * unit(np.tan(t * np.pi / 4))
    return finish(vertices + np.array([0.0, 0.0, half[2]]), faces, crease_rad=np.deg2rad(60))


def cushion(size: Vec, square: float = 5.0, puff: float = 2.6, grid: int = 10) -> Solid:
    """A stuffed cushion (superellipsoid), standing on z = 0, centred in x and y.

    `square` is how squarish it looks from above (2 is round), `puff` how squarish from the side (2 is a lens).
    """
    half = np.asarray(size, dtype=np.float64) / 2
    points, faces = _cube_grid(grid)
    q = np.tan((points / grid * 2.0 - 1.0) * np.pi / 4)
    plan = (np.abs(q[:, 0]) ** square + np.abs(q[:, 1]) ** square) ** (1 / square)
    reach = (plan**puff + np.abs(q[:, 2]) ** puff) ** (-1 / puff)
    vertices = q * reach[:, None] * half + np.array([0.0, 0.0, half[2]])
    return finish(vertices, faces, crease_rad=np.pi)


def ball(diameter: float, grid: int = 6) -> Solid:
    """A sphere standing on z = 0."""
    return cushion((diameter,) * 3, 2.0, 2.0, grid)


def pillow(size: Vec, grid: int = 12, pinch: float = 0.05) -> Solid:
    """A scatter cushion lying flat on z = 0: pointed corners, sides drawn in, thick in the middle."""
    a = np.sin(np.linspace(-1, 1, grid + 1) * np.pi / 2)
    u, v = np.meshgrid(a, a, indexing="ij")
    x, y = u * (1 - pinch * (1 - v**2) * np.abs(u)), v * (1 - pinch * (1 - u**2) * np.abs(v))
    z = ((1 - u**4) * (1 - v**4)) ** 0.45
    half = np.asarray(size, dtype=np.float64) / 2
    top = np.stack([x, y, z], axis=-1) * half
    return shell(top, top * np.array([1, 1, -1]), crease_rad=np.pi).moved(z=half[2])


def shell(top: Float[np.ndarray, "m n 3"], bottom: Float[np.ndarray, "m n 3"], crease_rad: float = CREASE_RAD) -> Solid:
    """The closed solid between two grids of points; rows x columns seen counter-clockwise from the top side."""
    m, n = top.shape[:2]
    index = np.arange(m * n).reshape(m, n)
    quads = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], axis=-1).reshape(-1, 4)
    rim = np.concatenate([index[:-1, 0], index[-1, :-1], index[:0:-1, -1], index[0, :0:-1]])
    nxt = np.roll(rim, -1)
    under = m * n
    sides = np.stack([nxt, rim, rim + under, nxt + under], axis=-1)
    q = np.concatenate([quads, quads[:, ::-1] + under, sides])
    vertices, faces = _weld(
        np.concatenate([top.reshape(-1, 3), bottom.reshape(-1, 3)]), np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])
    )
    return finish(vertices, faces, crease_rad=crease_rad)


def _weld(
    vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]
) -> tuple[Float[np.ndarray, "w 3"], Int[np.ndarray, "f 3"]]:
    """Vertices closer than a hundredth of a millimetre made one."""
    first, number = places(vertices)
    return vertices[first], number[faces]


def places(vertices: Float[np.ndarray, "v 3"]) -> tuple[Int[np.ndarray, "w"], Int[np.ndarray, "v"]]:
    """Places that differ by a hundredth of a millimetre or more, in order of x, y, z.

    Returns:
        Index of the first vertex at each place, and for every vertex the number of its place.
    """
    keys = np.round(vertices * 1e5).astype(np.int64)
    keys -= keys.min(axis=0)
    _, many_y, many_z = (int(n) + 1 for n in keys.max(axis=0))
    if math.prod(int(n) + 1 for n in keys.max(axis=0)) < 2**62:  # so that one number tells a place
        keys = (keys[:, 0] * many_y + keys[:, 1]) * many_z + keys[:, 2]
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return first, inverse.reshape(-1)


def slab(surface: Float[np.ndarray, "m n 3"], thickness: float) -> Solid:
    """A bent sheet given a thickness along its normals (half to each side)."""
    du, dv = np.gradient(surface, axis=0), np.gradient(surface, axis=1)
    offset = unit(cross(du, dv)) * thickness / 2
    return shell(surface + offset, surface - offset)


def loft(
    rings: Float[np.ndarray, "m n 3"], capped: bool = True, closed: bool = False, crease_rad: float = CREASE_RAD
) -> Solid:
    """Skin through rings of points, each counter-clockwise seen from the last ring's side.

    Ends are closed by fans about their middle (outlines must be star-shaped); `closed` joins the last ring to the
    first instead.
    """
    m, n = rings.shape[:2]
    i, j, skin = _loft_faces(m, n, closed)
    faces = [skin]
    uv = _loft_uv(rings, i, j)
    vertices = rings.reshape(-1, 3)
    if capped and not closed:
        for row, flip in ((0, True), (m - 1, False)):
            ring, centre = row * n + np.arange(n), len(vertices)
            vertices = np.concatenate([vertices, rings[row].mean(axis=0, keepdims=True)])
            fan = np.stack([ring, np.roll(ring, -1), np.full(n, centre)], axis=1)
            fan = fan[:, ::-1] if flip else fan
            faces.append(fan)
            uv = np.concatenate([uv, _flat_uv(vertices[fan])])
    vertices, welded = _weld(vertices, np.concatenate(faces))
    return finish(vertices, welded, uv, crease_rad)


@lru_cache(maxsize=256)
def _loft_faces(m: int, n: int, closed: bool) -> tuple[Int[np.ndarray, "q"], Int[np.ndarray, "q"], np.ndarray]:
    """Ring and place in it where each quad begins, and the triangles of all quads, through m rings of n points."""
    rows = m if closed else m - 1
    i, j = (a.ravel() for a in np.meshgrid(np.arange(rows), np.arange(n), indexing="ij"))
    quad = np.stack([i * n + j, i * n + (j + 1) % n, ((i + 1) % m) * n + (j + 1) % n, ((i + 1) % m) * n + j], axis=1)
    return i, j, np.concatenate([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]])


def _loft_uv(rings: Float[np.ndarray, "m n 3"], i: Int[np.ndarray, "q"], j: Int[np.ndarray, "q"]) -> np.ndarray:
    """Texture coordinates per triangle corner: along the rings' path first, then round them."""
    step = length(np.roll(rings, -1, axis=0) - rings).mean(axis=1)
    along = np.concatenate([[0.0], np.cumsum(step)])
    turn = length(np.roll(rings, -1, axis=1) - rings).mean(axis=0)
    around = np.concatenate([[0.0], np.cumsum(turn)])
    at = np.stack([along[i], along[i], along[i + 1], along[i + 1]], axis=1)
    across = np.stack([around[j], around[j + 1], around[j + 1], around[j]], axis=1)
    corners = np.stack([at, across], axis=-1)
    return np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])


def _flat_uv(points: Float[np.ndarray, "f 3 3"]) -> Float[np.ndarray, "f 3 2"]:
    """Coordinates of flat caps, by dropping their thinnest axis."""
    axis = int(np.ptp(points.reshape(-1, 3), axis=0).argmin())
    return points[:, :, [a for a in range(3) if a != axis]]


def smooth_profile(profile: Profile, samples: int = 3) -> Profile:
    """More points between the given ones, without bulging past them (monotone cubics)."""
    p = np.asarray(profile, dtype=np.float64)
    knots = np.arange(len(p))
    dense = PchipInterpolator(knots, p, axis=0)(np.linspace(0, len(p) - 1, samples * (len(p) - 1) + 1))
    return tuple((float(r), float(z)) for r, z in dense)


def lathe(profile: Sequence[tuple[float, float]], segments: int = 24, crease_rad: float = CREASE_RAD) -> Solid:
    """A turned solid from (radius, height) pairs, bottom to top (and back down inside for a hollow)."""
    p = np.asarray(profile, dtype=np.float64)
    closed = bool(np.allclose(p[0], p[-1]))  # a ring with a hole through it, as a lampshade
    p = p[:-1] if closed else p
    angle = np.arange(segments) * 2 * np.pi / segments
    rings = np.stack(
        [p[:, :1] * np.cos(angle), p[:, :1] * np.sin(angle), np.broadcast_to(p[:, 1:], (len(p), segments))], axis=-1
    )
    return loft(rings, closed=closed, crease_rad=crease_rad)


def cylinder(radius: float, height: float, bevel: float = 0.003, segments: int = 24, top: float | None = None) -> Solid:
    """An upright round bar with eased edges on z = 0; `top` is another radius at the top."""
    t = radius if top is None else top
    b = min(bevel, 0.45 * min(radius, t), 0.45 * height)
    return lathe([(radius - b, 0), (radius, b), (t, height - b), (t - b, height)], segments, np.deg2rad(50))


def tube(
    path: Float[np.ndarray, "m 3"] | Sequence[Vec],
    radius: float | Sequence[float] | Float[np.ndarray, "m"],
    segments: int = 8,
    closed: bool = False,
) -> Solid:
    """A round bar along a path, with one radius or one per point."""
    p = np.asarray(path, dtype=np.float64)
    radii = np.broadcast_to(np.asarray(radius, dtype=np.float64), (len(p),))
    steps = np.roll(p, -1, axis=0) - np.roll(p, 1, axis=0) if closed else np.gradient(p, axis=0)
    tangents = unit(steps)
    start = np.eye(3)[np.abs(tangents[0]).argmin()]
    side, sides = unit(cross(tangents[0], start)), np.empty_like(tangents)
    for k, tangent in enumerate(tangents):
        side = unit(side - tangent * (side @ tangent))  # parallel transport: no twist
        sides[k] = side
    angle = np.arange(segments) * 2 * np.pi / segments
    cos, sin, others = np.cos(angle)[:, None], np.sin(angle)[:, None], cross(tangents, sides)
    rings = p[:, None] + radii[:, None, None] * (cos * sides[:, None] + sin * others[:, None])
    return loft(rings, closed=closed, crease_rad=np.deg2rad(70))


def rod(start: Vec, end: Vec, radius: float, end_radius: float | None = None, segments: int = 10) -> Solid:
    """A straight round bar, tapered when `end_radius` is given."""
    return tube([start, end], [radius, radius if end_radius is None else end_radius], segments)


def beam(start: Vec, end: Vec, width: float, thickness: float, radius: float = 0.003) -> Solid:
    """A rounded bar of rectangular section between two points; `width` is the more horizontal side."""
    a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    along = unit(b - a)
    hint = np.array([0.0, 0.0, 1.0]) if abs(along[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    across = unit(cross(hint, along))
    bar = box((float(np.linalg.norm(b - a)), width, thickness), radius).moved(z=-thickness / 2)
    R = np.stack([along, across, cross(along, across)], axis=1)
    return replace(bar, vertices=bar.vertices @ R.T + (a + b) / 2, normals=bar.normals @ R.T)


def taper(bottom: Vec, top: Vec, bottom_width: float, top_width: float, radius: float = 0.004) -> Solid:
    """A square leg from its foot to its head, widths differing, edges eased."""
    sides = []
    for centre, width in ((bottom, bottom_width), (top, top_width)):
        r, h = min(radius, width / 3), width / 2
        ring = [(h, -h + r), (h, h - r), (h - r, h), (-h + r, h), (-h, h - r), (-h, -h + r), (-h + r, -h), (h - r, -h)]
        sides.append(np.array([(*xy, 0.0) for xy in ring]) + np.asarray(centre, dtype=np.float64))
    return loft(np.array(sides), crease_rad=np.deg2rad(50))


def prism(
    outline: Float[np.ndarray, "n 2"] | Sequence[tuple[float, float]], height: float, bevel: float = 0.004
) -> Solid:
    """A plate of any star-shaped outline (counter-clockwise in x, y) with eased edges, standing on z = 0."""
    p = np.asarray(outline, dtype=np.float64)
    b = min(bevel, 0.45 * height)
    inset = _inset(p, b)
    layers = [(inset, 0.0), (p, b), (p, height - b), (inset, height)]
    rings = np.array([np.column_stack([xy, np.full(len(p), z)]) for xy, z in layers])
    return loft(rings, crease_rad=np.deg2rad(50))


def _inset(outline: Float[np.ndarray, "n 2"], distance: float) -> Float[np.ndarray, "n 2"]:
    tangent = np.roll(outline, -1, axis=0) - np.roll(outline, 1, axis=0)
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-12)
    return outline + distance * np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)


def superellipse(depth: float, width: float, square: float = 2.0, points: int = 40) -> Float[np.ndarray, "n 2"]:
    """Outline of a rounded plate: 2 is an ellipse, 5 and more a rounded rectangle."""
    t = np.arange(points) * 2 * np.pi / points
    c, s = np.cos(t), np.sin(t)
    reach = (np.abs(c) ** square + np.abs(s) ** square) ** (-1 / square)
    return np.stack([c * reach * depth / 2, s * reach * width / 2], axis=1)


def rounded_rectangle(depth: float, width: float, radius: float, arc: int = 5) -> Float[np.ndarray, "n 2"]:
    """Outline of a rectangle with round corners, counter-clockwise."""
    r = min(radius, depth / 2.001, width / 2.001)
    t = np.linspace(0, np.pi / 2, arc + 1)
    quarter = np.stack([np.cos(t), np.sin(t)], axis=1) * r
    centres = (
        (depth / 2 - r, width / 2 - r),
        (-depth / 2 + r, width / 2 - r),
        (-depth / 2 + r, -width / 2 + r),
        (depth / 2 - r, -width / 2 + r),
    )
    corners = []
    for k, centre in enumerate(centres):
        R = axis_rotation("z", 90.0 * k)[:2, :2]
        corners.append(quarter @ R.T + np.array(centre))
    return np.concatenate(corners)


def bend(points: Sequence[Vec] | Float[np.ndarray, "k 3"], samples: int = 12) -> Float[np.ndarray, "m 3"]:
    """A smooth path through points (Catmull-Rom), for tubes."""
    p = np.asarray(points, dtype=np.float64)
    padded = np.concatenate([[2 * p[0] - p[1]], p, [2 * p[-1] - p[-2]]])
    out = []
    for k in range(len(p) - 1):
        a, b, c, d = padded[k : k + 4]
        t = np.linspace(0, 1, samples, endpoint=False)[:, None]
        out.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3))
    return np.concatenate([*out, p[-1:]])


def ring_path(outline: Float[np.ndarray, "n 2"], z: float = 0.0) -> Float[np.ndarray, "n 3"]:
    """A flat outline as a closed path at height z."""
    return np.column_stack([outline, np.full(len(outline), z)])
