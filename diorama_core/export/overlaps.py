"""Bodies start apart: what convex parts overlap by is cut off, because what starts inside another is shot out."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from diorama_core.export.bodies import MovingPart, Points, RigidBody, StaticSlab, hull_volume, is_soft, place
from diorama_core.geometry.convex import hull_part
from diorama_core.geometry.sat import pack_parts, pair_axes, place_bodies
from diorama_core.scene.frames import UP_WORLD

MAX_CUT = 0.4
"""A part is cut level by at most this share of its extent; of what overlaps more it loses only what both fill."""
MIN_LEFT = 0.2
"""An object that others fill so that less than this share of its volume is left stays where it is."""
MIN_PIECE_M, MAX_PIECES = 0.005, 12
"""Pieces of a part that are thinner than this are left out, and of many the smallest: engines push thin ones about."""
MAX_SOFT_DIP = 0.25
"""Soft objects are cut level where they sink into their supporter by at most this share of their height."""
MAX_RIGID_CUT_M = 0.02
"""Parts of objects that do not give way are cut by at most this."""
SOFT_CELLS = 4
"""Soft objects follow what they lie on in so many cells along each side."""
SKIN_M, GAP_M = 1e-4, 0.0025
"""How far apart bodies start that were cut: what lies on another, and what is beside it. Bullet rounds each convex body
by a millimetre, and neighbours that it finds 2 mm inside each other slide apart by centimetres."""
UPRIGHT = 0.7
"""A face whose normal rises by more than this carries what is above it."""


class Cuts:
    """Takes overlaps away from convex parts, pair by pair, at the poses in which the scene starts."""

    def __init__(self, bodies: Mapping[str, RigidBody], slabs: Iterable[StaticSlab]) -> None:
        self._bodies = bodies
        self._owners: list[str | None] = []
        self._limbs: list[int | None] = []
        self._world: list[Points] = []
        self._frames: dict[tuple[str, int | None], Float[np.ndarray, "4 4"]] = {}
        self._rows: dict[tuple[str | None, int | None], list[int]] = {}
        for body in bodies.values():
            rest = (None, body.node.T_world, body.parts)
            moving = [(m.limb.number, body.node.T_world @ m.limb.T_object_limb, m.parts) for m in body.moving]
            for limb, T, parts in (rest, *moving):
                self._frames[body.node.id, limb] = T
                for part in parts:
                    self._add(body.node.id, limb, place(T, part))
        for piece in (piece for slab in slabs for piece in slab.pieces):
            self._add(None, None, piece)
        self._deep: list[tuple[int, int]] = []
        self._pieces: dict[int, list[Points]] = {}
        self.sunk: dict[str, str | None] = {}

    def _add(self, owner: str | None, limb: int | None, part: Points) -> None:
        self._rows.setdefault((owner, limb), []).append(len(self._world))
        self._owners.append(owner)
        self._limbs.append(limb)
        self._world.append(part)

    def parts(self, object_id: str, limb: int | None = None) -> tuple[Points, ...]:
        """The parts of an object, or of one of its limbs, that are left, in the frame of either."""
        T = self._frames[object_id, limb]
        rows = self._rows.get((object_id, limb), ())
        return tuple((piece - T[:3, 3]) @ T[:3, :3] for row in rows for piece in self._rest(row))

    def moving(self, body: RigidBody) -> tuple[MovingPart, ...]:
        """The limbs of an object with the parts that are left."""
        return tuple(replace(m, parts=self.parts(body.node.id, m.limb.number)) for m in body.moving)

    def resolve(self) -> None:
        """Cut every pair that overlaps; what is too deep to be cut level loses what both fill."""
        first, second = self._candidate_pairs()
        if len(first) == 0:
            return
        near, place = np.unique(np.concatenate([first, second]), return_inverse=True)
        packed = pack_parts([[hull_part(self._world[k])] for k in near])
        count = len(near)
        here = place_bodies(packed, np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3)), np.ones((count, 3)))
        for block in pair_axes(here, *np.split(place.reshape(-1), 2)):
            for k in np.flatnonzero(block.gaps.max(axis=1) < 0.0):
                pair = int(near[block.a[k]]), int(near[block.b[k]])
                self._part(*pair, block.normals[k][np.isfinite(block.gaps[k])])
        for pair in self._deep:
            self._hollow_out(*pair)

    def _candidate_pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Parts whose boxes overlap and of which at least one can move against the other: those of different objects,
        and those of an object that its joints move."""
        low = np.array([w.min(axis=0) for w in self._world]).reshape(-1, 3)
        high = np.array([w.max(axis=0) for w in self._world]).reshape(-1, 3)
        rows_owners = list(zip(self._owners, self._limbs, strict=True))
        numbers = {body: k for k, body in enumerate(dict.fromkeys(rows_owners))}
        owner = np.array([numbers[body] for body in rows_owners])
        moves = np.array([limb is not None or self._free(name) for name, limb in rows_owners])
        pairs = []
        for i in range(len(low)):
            later = slice(i + 1, None)
            near = (low[later, 0] < high[i, 0]) & (high[later, 0] > low[i, 0]) & (owner[later] != owner[i])
            rows = i + 1 + np.flatnonzero(near & (moves[later] | moves[i]))
            rows = rows[((low[rows] < high[i]) & (high[rows] > low[i])).all(axis=1)]
            pairs += [(i, int(j)) for j in rows]
        found = np.array(pairs, dtype=int).reshape(-1, 2)
        return found[:, 0], found[:, 1]

    def _free(self, owner: str | None) -> bool:
        return owner is not None and self._bodies[owner].free

    def _part(self, i: int, j: int, normals: Float[np.ndarray, "k 3"]) -> None:
        """Part two bodies: a rider from what carries it upward, others along the direction of least overlap."""
        a, b = self._owners[i], self._owners[j]
        along_i, along_j = self._world[i] @ normals.T, self._world[j] @ normals.T
        gaps = along_i.min(axis=0) - along_j.max(axis=0)
        is_same = a is not None and a == b
        if gaps.max() >= 0 or (not is_same and (self._lift(i, j) or self._lift(j, i))):
            return
        for k in np.argsort(-gaps, kind="stable"):
            options = [(i, j, normals[k], float(along_j[:, k].max())), (j, i, -normals[k], float(-along_i[:, k].min()))]
            for part, other, normal, level in sorted(options, key=lambda option: self._firmness(option[0])):
                gap = SKIN_M if normal[2] > UPRIGHT else GAP_M
                if (is_same or not self._rides(other, part)) and self._cut(part, normal, level + gap):
                    return
        if is_same or not self._sink(a, b):
            self._deep.append((i, j))

    def _lift(self, rider: int, carrier: int) -> bool:
        """Cut a rider's part level above its carrier's, where it only dips into it; soft ones sink in deeper."""
        top, low = float(self._world[carrier][:, 2].max()), float(self._world[rider][:, 2].min())
        owner = self._owners[rider]
        sinks = owner is not None and is_soft(self._bodies[owner].node) and self._lies_on(rider, carrier)
        dips = top - low < (MAX_SOFT_DIP * float(np.ptp(self._world[rider][:, 2])) if sinks else MAX_RIGID_CUT_M)
        return dips and self._rides(rider, carrier) and self._cut(rider, UP_WORLD, top + SKIN_M)

    def _lies_on(self, rider: int, carrier: int) -> bool:
        """Whether most of a part lies over another, seen from above."""
        a, b = self._world[rider][:, :2], self._world[carrier][:, :2]
        shared = np.minimum(a.max(axis=0), b.max(axis=0)) - np.maximum(a.min(axis=0), b.min(axis=0))
        return float(np.prod(np.maximum(shared, 0.0))) > 0.5 * float(np.prod(np.ptp(a, axis=0)))

    def _rides(self, rider: int, carrier: int) -> bool:
        """Whether one part's object is carried by the other's, directly or not; all ride on the room."""
        a, b = self._owners[rider], self._owners[carrier]
        if a is None or b is None:
            return a is not None
        while a is not None and a != b:
            a = self._bodies[a].node.parent
        return a == b

    def _cut(self, part: int, normal: Float[np.ndarray, "3"], level: float) -> bool:
        owner = self._owners[part]
        if owner is None:
            return False
        depth = MAX_CUT * float(np.ptp(self._world[part] @ normal))
        if not is_soft(self._bodies[owner].node):
            depth = min(depth, MAX_RIGID_CUT_M)
        rest = cut(self._world[part], normal, level, depth)
        if rest is not None:
            self._world[part] = rest
        return rest is not None

    def _firmness(self, part: int) -> tuple[int, float]:
        owner = self._owners[part]
        if owner is None:
            return (2, 0.0)
        return (0 if is_soft(self._bodies[owner].node) else 1, float(np.prod(np.ptp(self._world[part], axis=0))))

    def _sink(self, a: str | None, b: str | None) -> bool:
        """Weld one of two objects that overlap too deeply to be cut to the other, where that carries it."""
        pairs = [(c, d) for c, d in ((a, b), (b, a)) if c is not None]
        sunk = [(c, d) for c, d in pairs if d is None or self._bodies[c].node.parent == d]
        self.sunk.update(sunk)
        return bool(sunk)

    def _rest(self, row: int) -> list[Points]:
        return self._pieces.get(row, [self._world[row]])

    def _hollow_out(self, i: int, j: int) -> None:
        """Take away from the softer or smaller of two parts what both fill."""
        part, other = sorted((i, j), key=self._firmness)
        if self._owners[part] is None:
            return
        left = self._rest(part)
        for hole in self._rest(other):
            left = [rest for piece in left for rest in subtract_convex(piece, hole)]
        self._pieces[part] = left

    def overlapping(self) -> list[str]:
        """Objects that share nearly all of their room with others: what is left of them would not stand."""
        hollowed = dict.fromkeys(owner for row in self._pieces if (owner := self._owners[row]) is not None)
        return [name for name in hollowed if self._share_left(name) < MIN_LEFT]

    def _share_left(self, owner: str) -> float:
        rows = self._rows.get((owner, None), ())
        whole = sum(hull_volume(self._world[row]) for row in rows)
        return sum(hull_volume(p) for row in rows for p in self._rest(row)) / whole if whole else 1.0


def subtract_convex(part: Points, hole: Points) -> list[Points]:
    """Subtract a convex body from another; gives the rest as convex pieces without slivers.

    Args:
        part: corners of the body, metres.
        hole: corners of the other; flat ones take nothing away.
    """
    try:
        planes = np.unique(np.round(ConvexHull(hole).equations, 6), axis=0)
    except (QhullError, ValueError):
        return [part]
    pieces: list[Points] = []
    rest: Points | None = part
    for normal, level in sorted(((p[:3], -p[3]) for p in planes), key=lambda p: float(p[1] - (part @ p[0]).max())):
        if rest is None or (rest @ normal).max() <= level + GAP_M:
            continue
        beyond = cut(rest, normal, level + GAP_M, np.inf)
        pieces += [] if beyond is None or np.ptp(beyond @ normal) < MIN_PIECE_M else [beyond]
        rest = cut(rest, -normal, -level, np.inf)
    return [part] if rest is None else sorted(pieces, key=lambda piece: -hull_volume(piece))[:MAX_PIECES]


def drape(part: Points, lowest: float, below: Iterable[Points]) -> tuple[list[Points], list[Points]]:
    """How a soft part lies: pieces that reach down where what carries it is lower than what it was cut off above, and
    the points that it then lies on. Cut level it would lie on the highest place alone and tip; cloth follows.

    Args:
        part: corners in the world, cut level.
        lowest: level that no piece goes below, metres: that of the object before it was cut.
        below: parts of what carries it, in the world.
    """
    below, level, pieces, held = list(below), float(part[:, 2].min()), [], []
    edges = np.linspace(part[:, :2].min(axis=0), part[:, :2].max(axis=0), SOFT_CELLS + 1)
    for column, row in itertools.product(range(SOFT_CELLS), repeat=2):
        bounds = np.array([edges[column, 0], edges[row, 1]]), np.array([edges[column + 1, 0], edges[row + 1, 1]])
        cell = _clip_to_column(part, *bounds)
        foot = np.zeros((0, 3)) if cell is None else cell[cell[:, 2] < level + SKIN_M]
        carriers = [p for q in below if (p := _clip_to_column(q, *bounds)) is not None and p[:, 2].max() < level]
        bottom = max((float(p[:, 2].max()) + SKIN_M for p in carriers), default=-np.inf)
        if len(foot) < 3 or bottom < lowest:
            continue
        held += [p[p[:, 2] > bottom - 2 * SKIN_M] for p in carriers]
        if bottom < level - SKIN_M:
            pieces.append(np.concatenate([foot, np.column_stack([foot[:, :2], np.full(len(foot), bottom)])]))
    return pieces, held


def _clip_to_column(points: Points, lower: Float[np.ndarray, "2"], upper: Float[np.ndarray, "2"]) -> Points | None:
    """A convex body inside an upright column."""
    rest: Points | None = points
    for axis in (0, 1):
        for sign, bound in ((1.0, lower[axis]), (-1.0, -upper[axis])):
            rest = None if rest is None else cut(rest, sign * np.eye(3)[axis], bound, np.inf)
    return rest


def cut(points: Points, normal: Float[np.ndarray, "3"], level: float, depth: float) -> Points | None:
    """The part of a convex body where `normal . p >= level`; None when more than `depth` would go, or all.

    Args:
        points: corners of the body, metres.
        normal: unit.
        level: of the plane, metres.
        depth: most that may go, metres.
    """
    height = points @ normal - level
    above, below = points[height >= 0], points[height < 0]
    if len(below) == 0:
        return points
    if len(above) == 0 or height.min() < -depth:
        return None
    t = height[height >= 0][:, None] / (height[height >= 0][:, None] - height[height < 0][None])
    crossing = above[:, None] * (1.0 - t[..., None]) + below[None] * t[..., None]
    corners = np.vstack([above, crossing.reshape(-1, 3)])
    try:
        return np.asarray(corners[ConvexHull(corners).vertices])
    except (QhullError, ValueError):
        return None
