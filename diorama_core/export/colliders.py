"""What a simulator needs of a scene: rigid bodies of convex parts that start without touching each other's inside.

The parts are those that the layout keeps apart, so shelves stay open inside. What soft things, sunk feet and rounded
hulls still overlap by is cut off along the separating plane: a body that starts inside another would be shot out.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from diorama_core.export.gathering import ExportObject, ExportScene
from diorama_core.export.limbs import ExportLimb, limb_parts
from diorama_core.export.physics import Inertia, friction_of, inertia_of, plausible_mass_kg
from diorama_core.geometry.convex import ConvexPart, hull_part
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.sat import pack_parts, pair_axes, place_bodies
from diorama_core.layout.problem.parts import parts_of_shape
from diorama_core.library import taxonomy
from diorama_core.library.record import Shape, record_of
from diorama_core.scene.types import Plane, box_corners

Points = Float[np.ndarray, "v 3"]

MAX_CUT = 0.4
"""A part is cut by at most this share of its extent; what overlaps more is left to interpenetrate without contact."""
NEAR_FLOOR_M = 0.03
"""An object that nothing is said to carry stands on the floor when its bottom is this near to it."""
MIN_SLAB_M = 0.05
SKIN_M = 1e-4
"""Bodies start this far apart where they were cut."""


@dataclass(frozen=True, eq=False)
class MovingPart:
    """What one joint of an object moves."""

    limb: ExportLimb
    parts: tuple[Points, ...]
    """Corners of convex bodies in the object's rigid frame, scale applied, metres."""
    inertia: Inertia
    """In the object's rigid frame."""


@dataclass(frozen=True, eq=False)
class RigidBody:
    """One object as a simulator sees it."""

    node: ExportObject
    parts: tuple[Points, ...]
    """Corners of convex bodies in the object's rigid frame, scale applied, metres."""
    inertia: Inertia
    """In the object's rigid frame."""
    friction: float
    free: bool
    """Whether it may move; otherwise it is welded to `carrier`, or to the room."""
    carrier: str | None = None
    """Id of the object it is welded to; None for the room and for free bodies."""
    moving: tuple[MovingPart, ...] = ()
    """What its joints move; `parts` and `inertia` are then those of the rest."""

    @property
    def mass_kg(self) -> float:
        """Mass without what its joints move."""
        return self.inertia.mass_kg

    @property
    def volume_m3(self) -> float:
        """Sum of the volumes of the parts that stay."""
        return sum(hull_volume(p) for p in self.parts)


@dataclass(frozen=True, eq=False)
class StaticSlab:
    """One plane of the room as convex pieces."""

    slug: str
    plane: Plane
    pieces: tuple[Points, ...]
    """In the world."""


@dataclass(frozen=True, eq=False)
class PhysicalScene:
    """Rigid bodies, supporters first, in a static room."""

    bodies: tuple[RigidBody, ...]
    slabs: tuple[StaticSlab, ...]
    without_contact: tuple[tuple[str, str], ...]
    """Pairs of object ids that may interpenetrate: rugs with what stands over their edge, and deep overlaps."""
    notes: tuple[str, ...] = ()
    """What was decided that a reader of the file should know."""


def physical_scene(gathered: ExportScene) -> PhysicalScene:
    """Reduce a gathered scene to rigid bodies.

    Mounted, locked and unsupported objects are welded to what holds them; everything else is free, or with the option
    `bodies="welded"` nothing is.
    """
    slabs = tuple(StaticSlab(p.slug, p.plane, slab_pieces(p.plane)) for p in gathered.planes)
    bodies = {o.id: _body(gathered, o) for o in gathered.objects}
    cuts = _Cuts(gathered, bodies, slabs)
    cuts.resolve()
    notes = []
    for child, carrier in sorted(cuts.sunk.items()):
        if bodies[child].free:
            bodies[child] = _welded(bodies[child], carrier)
            notes.append(f"{child} is sunk into {carrier or 'the room'} and welded to it")
    done = tuple(replace(b, parts=cuts.parts(i), moving=cuts.moving(b)) for i, b in bodies.items())
    return PhysicalScene(done, slabs, tuple(sorted(cuts.ignored)), tuple(notes))


def hull_volume(points: Points) -> float:
    """Volume of the convex hull; 0 for flat sets."""
    try:
        return float(ConvexHull(points).volume)
    except (QhullError, ValueError):
        return 0.0


def slab_pieces(plane: Plane) -> tuple[Points, ...]:
    """A plane with its thickness as convex prisms: one where its outline is convex, one a triangle otherwise."""
    import manifold3d

    depth = -plane.normal * max(plane.thickness, MIN_SLAB_M)
    flat = plane.polygon @ np.stack(plane_axes(plane.normal), axis=1)
    if _is_convex(flat):
        return (np.vstack([plane.polygon, plane.polygon + depth]),)
    triangles = np.asarray(manifold3d.triangulate([flat]), dtype=int)
    return tuple(np.vstack([plane.polygon[t], plane.polygon[t] + depth]) for t in triangles)


def _is_convex(outline: Float[np.ndarray, "n 2"]) -> bool:
    edges = np.roll(outline, -1, axis=0) - outline
    after = np.roll(edges, -1, axis=0)
    turns = edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]
    return bool((turns >= -1e-9).all() or (turns <= 1e-9).all())


def _body(gathered: ExportScene, node: ExportObject) -> RigidBody:
    item, library = node.item, gathered.library
    shape = library.shape(item.shape_id)
    record = record_of(library, item.shape_id)
    surfaces = gathered.meshes[node.mesh].surfaces
    weights = _weights(gathered, node, record)
    moving = tuple(
        MovingPart(limb, _scaled(limb_parts(shape.id, limb.number), node), weights[limb.number]) for limb in node.limbs
    )
    if node.limbs:
        parts = _scaled(limb_parts(shape.id, None), node)
    elif _is_soft(node):
        parts = (box_corners(item.size_m),)  # soft things lie on a face, not on their rim
    else:
        parts = _scaled(parts_of_shape(library, shape), node)
    body = RigidBody(node, parts, weights[None], friction_of(surfaces), True, moving=moving)
    carrier = _carrier(gathered, node)
    return body if carrier is _STANDING else _welded(body, carrier)


def _scaled(parts: Iterable[ConvexPart], node: ExportObject) -> tuple[Points, ...]:
    return tuple(np.asarray(p.vertices) * node.scale for p in parts)


def _weights(gathered: ExportScene, node: ExportObject, record: Shape) -> dict[int | None, Inertia]:
    """Inertia of what stays (None) and of what each joint moves."""
    keys: dict[int | None, str] = {None: node.mesh, **{limb.number: limb.mesh for limb in node.limbs}}
    loose = {k: inertia_of(gathered.meshes[key].surfaces, node.scale) for k, key in keys.items()}
    total = sum(part.mass_kg for part in loose.values())
    factor = plausible_mass_kg(total, node.scale, record) / total
    return {k: part.weighing(part.mass_kg * factor) for k, part in loose.items()}


_STANDING = "standing free"


def _carrier(gathered: ExportScene, node: ExportObject) -> str | None:
    """What holds an object that cannot move: an object, None for the room; `_STANDING` when it can move."""
    support = node.support
    if gathered.options.bodies == "welded" or node.item.locked:
        return node.parent
    if support is not None:
        return node.parent if support.relation == "mounted on" else _STANDING
    floor = gathered.scene.architecture.floor
    height = 0.0 if floor is None else float(floor.centre[2])
    return _STANDING if abs(float(node.item.corners_world[:, 2].min()) - height) < NEAR_FLOOR_M else None


def _welded(body: RigidBody, carrier: str | None) -> RigidBody:
    return replace(body, free=False, carrier=carrier)


def _is_soft(node: ExportObject) -> bool:
    return taxonomy.resolve(node.item.category).category.soft


class _Cuts:
    """Takes overlaps away from convex parts, pair by pair, at the poses in which the scene starts."""

    def __init__(self, gathered: ExportScene, bodies: Mapping[str, RigidBody], slabs: Iterable[StaticSlab]) -> None:
        self._gathered = gathered
        self._bodies = bodies
        self._owners: list[str | None] = []
        self._limbs: list[int | None] = []
        self._world: list[Points] = []
        for body in bodies.values():
            T = body.node.T_world
            own = [(None, p) for p in body.parts] + [(m.limb.number, p) for m in body.moving for p in m.parts]
            for limb, part in own:
                self._owners.append(body.node.id)
                self._limbs.append(limb)
                self._world.append(part @ T[:3, :3].T + T[:3, 3])
        for slab in slabs:
            for piece in slab.pieces:
                self._owners.append(None)
                self._limbs.append(None)
                self._world.append(piece)
        self.ignored: set[tuple[str, str]] = set()
        self.sunk: dict[str, str | None] = {}

    def parts(self, object_id: str, limb: int | None = None) -> tuple[Points, ...]:
        """The parts of an object, or of one of its limbs, that are left, in the object's rigid frame."""
        T = self._bodies[object_id].node.T_world
        rows = zip(self._owners, self._limbs, self._world, strict=True)
        return tuple((w - T[:3, 3]) @ T[:3, :3] for o, k, w in rows if o == object_id and k == limb)

    def moving(self, body: RigidBody) -> tuple[MovingPart, ...]:
        """The limbs of an object with the parts that are left."""
        return tuple(replace(m, parts=self.parts(body.node.id, m.limb.number)) for m in body.moving)

    def resolve(self) -> None:
        """Cut every pair that overlaps."""
        first, second = self._near_pairs()
        if len(first) == 0:
            return
        convex = [hull_part(w) for w in self._world]
        packed = pack_parts([[part] for part in convex])
        count = len(convex)
        here = place_bodies(packed, np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3)), np.ones((count, 3)))
        for block in pair_axes(here, first, second):
            inside = block.gaps.max(axis=1) < 0.0
            for k in np.flatnonzero(inside):
                self._part(int(block.a[k]), int(block.b[k]), block.normals[k][np.isfinite(block.gaps[k])])

    def _near_pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Parts of different owners whose boxes overlap and of which at least one can move against the other."""
        low = np.array([w.min(axis=0) for w in self._world]).reshape(-1, 3)
        high = np.array([w.max(axis=0) for w in self._world]).reshape(-1, 3)
        pairs = []
        for i in range(len(low)):
            near = (low[i + 1 :] < high[i]).all(axis=1) & (high[i + 1 :] > low[i]).all(axis=1)
            pairs += [(i, i + 1 + int(j)) for j in np.flatnonzero(near) if self._collide(i, i + 1 + int(j))]
        found = np.array(pairs, dtype=int).reshape(-1, 2)
        return found[:, 0], found[:, 1]

    def _collide(self, i: int, j: int) -> bool:
        a, b = self._owners[i], self._owners[j]
        if a == b or not any(o is not None and self._bodies[o].free for o in (a, b)):
            return False
        if a is None or b is None:
            return True
        if self._yields(a, b) or self._yields(b, a):
            self.ignored.add((min(a, b), max(a, b)))
            return False
        return True

    def _yields(self, rug: str, other: str) -> bool:
        """Whether a rug lies under the other without carrying it."""
        item, node = self._bodies[rug].node.item, self._bodies[other].node
        return item.category == "rug" and item.size_m[2] < 0.06 and node.parent != rug

    def _part(self, i: int, j: int, normals: Float[np.ndarray, "k 3"]) -> None:
        """Cut the one of two parts that gives way along the direction in which they overlap least."""
        a, b = self._owners[i], self._owners[j]
        if a is not None and b is not None and (min(a, b), max(a, b)) in self.ignored:
            return
        along_i, along_j = self._world[i] @ normals.T, self._world[j] @ normals.T
        gaps = along_i.min(axis=0) - along_j.max(axis=0)
        if gaps.max() >= 0:
            return
        for k in np.argsort(-gaps, kind="stable"):
            options = [(i, normals[k], float(along_j[:, k].max())), (j, -normals[k], float(-along_i[:, k].min()))]
            for part, normal, level in sorted(options, key=lambda option: self._firmness(option[0])):
                rest = None if self._owners[part] is None else cut(self._world[part], normal, level + SKIN_M)
                if rest is not None:
                    self._world[part] = rest
                    return
        self._give_up(a, b)

    def _firmness(self, part: int) -> tuple[int, float]:
        owner = self._owners[part]
        if owner is None:
            return (2, 0.0)
        return (0 if _is_soft(self._bodies[owner].node) else 1, float(np.prod(np.ptp(self._world[part], axis=0))))

    def _give_up(self, a: str | None, b: str | None) -> None:
        """Two parts overlap too deeply to be cut: their objects do not collide, or one is welded to the other."""
        for child, carrier in itertools.permutations((a, b)):
            if child is not None and (carrier is None or self._bodies[child].node.parent == carrier):
                self.sunk[child] = carrier
        if a is not None and b is not None:
            self.ignored.add((min(a, b), max(a, b)))


def cut(points: Points, normal: Float[np.ndarray, "3"], level: float) -> Points | None:
    """The part of a convex body where `normal . p >= level`; None when too little of it would be left."""
    height = points @ normal - level
    if height.max() < (1.0 - MAX_CUT) * float(np.ptp(height)):
        return None
    above, below = points[height >= 0], points[height < 0]
    if len(below) == 0:
        return points
    t = height[height >= 0][:, None] / (height[height >= 0][:, None] - height[height < 0][None])
    crossing = above[:, None] * (1.0 - t[..., None]) + below[None] * t[..., None]
    retained = np.vstack([above, crossing.reshape(-1, 3)])
    try:
        return np.asarray(retained[ConvexHull(retained).vertices])
    except (QhullError, ValueError):
        return None
