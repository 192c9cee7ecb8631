"""Colliders for simulators: rigid bodies of convex parts that do not interpenetrate at the start.

The parts are those that the layout keeps apart, so shelves stay open inside. What soft objects, sunk feet and rounded
hulls still overlap by is cut off (`overlaps`).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import replace

import manifold3d
import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from diorama_core.export.bodies import (
    MovingPart,
    PhysicalScene,
    Points,
    RigidBody,
    StaticSlab,
    barriers,
    ground_piece,
    is_soft,
    place,
    slab_pieces,
)
from diorama_core.export.gathering import ExportObject, ExportOptions, ExportScene, gather, rigid_inverse
from diorama_core.export.limbs import ExportLimb, limb_parts
from diorama_core.export.overlaps import Cuts, cut, drape
from diorama_core.export.physics import GRAVITY, Inertia, friction_of, inertia_of, plausible_mass_kg
from diorama_core.geometry.convex import ConvexPart
from diorama_core.layout.problem.parts import parts_of_shape
from diorama_core.library.record import Shape, ShapeLibrary, record_of
from diorama_core.scene.types import Scene, box_corners

NEAR_FLOOR_M = 0.03
"""An object without support stands on the floor when its bottom is this near to it."""
MAX_SHEET_HEIGHT_M = 0.06
FOOT_M = 0.006
"""What lies this near to the lowest point of an object is its foot."""
NEAR_TOP_M = 0.012
"""Corners of a carrier this near to the level of a foot belong to the face that holds it up."""
MIN_HOLD_M2 = 1e-5
TURNING_CUTS = 3
"""Planes that take the rear of a leaf's free edge off: what is left of 5 mm is a tenth of one."""
MIN_JOINT_FRICTION = 0.5
"""Newtons or newton metres."""
HOLD = 1.5
"""Joints that stand open hold this many times the weight on them."""
BALANCE_SHARE = 0.7
"""Centres of mass lie within the foot's outline shrunk to this."""


def physical_scene(gathered: ExportScene) -> PhysicalScene:
    """Reduce a gathered scene to rigid bodies.

    Mounted, locked and unsupported objects are welded to their supporter; everything else is free, or with the option
    `bodies="welded"` nothing is. Barriers that nobody sees stand where the room has no wall.
    """
    ground = gathered.scene.architecture.floor
    slabs = tuple(
        StaticSlab(p.slug, p.plane, ground_piece(p.plane) if ground and p.id == ground.id else slab_pieces(p.plane))
        for p in gathered.planes
    )
    bodies = {o.id: _body(gathered, o) for o in gathered.objects}
    for rug in [b for b in bodies.values() if is_sheet(b.node)]:
        riders = [bodies[o.id] for o in gathered.children_of(rug.node.id)]
        bodies[rug.node.id] = replace(rug, free=False, carrier=None, parts=_foot_parts(rug, riders))
    cuts = Cuts(bodies, slabs)
    cuts.resolve()
    notes = []
    for child, carrier in sorted(cuts.sunk.items()):
        if bodies[child].free:
            bodies[child] = _weld(bodies[child], carrier)
            notes.append(f"{child} is sunk into {carrier or 'the room'} and welded to it")
    for filled in cuts.overlapping():
        if bodies[filled].free:
            bodies[filled] = _weld(bodies[filled], None)
            notes.append(f"{filled} is inside other objects and stays where it is")
    for child, body in bodies.items():
        parent = body.node.parent
        if body.free and parent is not None and _is_beside(body, bodies[parent]):
            bodies[child] = _weld(body, parent)
            notes.append(f"{child} stands beside {parent}, which is to carry it, and is welded to it")
    apart = {i: replace(b, parts=cuts.parts(i), moving=cuts.moving(b)) for i, b in bodies.items()}
    done = tuple(_resting(b, None if b.node.parent is None else apart[b.node.parent]) for b in apart.values())
    around = barriers(gathered.scene.architecture, [o.item.corners_world for o in gathered.objects])
    return PhysicalScene(done, (*slabs, *(around if ground and slabs else ())), tuple(notes))


def body_of(scene: Scene, library: ShapeLibrary, object_id: str) -> RigidBody:
    """One object of a scene as a simulator sees it, with its joints, before others cut into its parts.

    Raises:
        LibraryError: when its shape is missing.
    """
    shown = replace(scene, objects=tuple(replace(o, hidden=False) if o.id == object_id else o for o in scene.objects))
    options = ExportOptions(only=frozenset((object_id,)), joints=True, lights="none")
    gathered = gather(shown, library, options=options)
    return _body(gathered, gathered.objects[0])


def _resting(body: RigidBody, carrier: RigidBody | None) -> RigidBody:
    """The body in balance; a soft one follows what carries it, too."""
    if carrier is None or not is_soft(body.node):
        return balance(body, carrier)
    lowest, T = float(body.node.item.corners_world[:, 2].min()), rigid_inverse(body.node.T_world)
    lain = [drape(part, lowest, world_parts(carrier)) for part in world_parts(body)]
    pieces, held = ([p for some in each for p in some] for each in zip(*lain, strict=True))
    rests = replace(body, parts=(*body.parts, *(place(T, p) for p in pieces)))
    return shift_centre_over(rests, np.concatenate(held)[:, :2]) if held else balance(body, carrier)


def balance(body: RigidBody, carrier: RigidBody | None = None) -> RigidBody:
    """The body with its centre of mass above its foot, or above that part of it which its carrier holds up."""
    outline, low = _foot(body)
    if carrier is not None:
        tops = [p[np.abs(p[:, 2] - low) < NEAR_TOP_M][:, :2] for p in world_parts(carrier)]
        outline = _intersect(outline, np.concatenate([np.zeros((0, 2)), *tops]))
    return shift_centre_over(body, outline)


def _foot(body: RigidBody) -> tuple[Float[np.ndarray, "n 2"], float]:
    """What of a body lies near its lowest point, seen from above, and the height of that point."""
    feet, low = _feet(body)
    return np.concatenate([np.zeros((0, 2)), *feet]), low


def _feet(body: RigidBody) -> tuple[list[Float[np.ndarray, "_ 2"]], float]:
    parts = world_parts(body)
    low = min((float(p[:, 2].min()) for p in parts), default=0.0)
    return [p[p[:, 2] < low + FOOT_M][:, :2] for p in parts], low


def shift_centre_over(body: RigidBody, outline: Float[np.ndarray, "n 2"]) -> RigidBody:
    """The body with its centre of mass above the outline that holds it up.

    What stands in a photo is in balance; where guessed masses say otherwise, as for lamps with weighted feet, they are
    wrong. The centre moves to the nearest place well inside the outline.
    """
    total = body.mass_kg + sum(m.inertia.mass_kg for m in body.moving)
    weighed = [
        (body.inertia.mass_kg, body.inertia.centre),
        *((m.inertia.mass_kg, place(m.limb.T_object_limb, m.inertia.centre)) for m in body.moving),
    ]
    T = body.node.T_world
    centre = T[:3, :3] @ sum((m * c for m, c in weighed), np.zeros(3)) / total + T[:3, 3]
    shift = np.append(_shift_into_hull(outline, centre[:2]), 0.0)
    moved = body.inertia.centre + T[:3, :3].T @ shift * (total / body.mass_kg)
    return body if not body.free or not shift.any() else replace(body, inertia=replace(body.inertia, centre=moved))


def _is_beside(body: RigidBody, carrier: RigidBody) -> bool:
    """Whether nothing of a carrier, seen from above, is below the foot of what it is to carry: that would fall."""
    foot, low = _foot(body)
    under = np.concatenate([p[:, :2] for p in world_parts(carrier)])
    stands_lower = low < min(float(p[:, 2].min()) for p in world_parts(carrier)) + NEAR_FLOOR_M
    hulls = [manifold3d.CrossSection.hull_points(flat) for flat in (foot, under)]
    return not stands_lower and len(foot) > 2 and (hulls[0] ^ hulls[1]).area() < MIN_HOLD_M2


def is_sheet(node: ExportObject) -> bool:
    """Whether an object is a rug that lies flat: what stands over its edge stands beside it."""
    return node.item.category == "rug" and float(node.item.size_m[2]) < MAX_SHEET_HEIGHT_M


def _foot_parts(rug: RigidBody, riders: Iterable[RigidBody]) -> tuple[Points, ...]:
    """Pieces of a rug under the feet of what it carries. As a whole plate it would lift what stands over its edge, and
    a robot would push it; real ones give way under a foot and stay where they are."""
    heights, pieces = rug.node.item.corners_world[:, 2], []
    for foot in (foot for rider in riders for foot in _feet(rider)[0] if len(foot)):
        flat = np.concatenate([foot + np.array(offset) for offset in itertools.product((-FOOT_M, FOOT_M), repeat=2)])
        ends = [np.column_stack([flat, np.full(len(flat), z)]) for z in (heights.min(), heights.max())]
        pieces.append(place(rigid_inverse(rug.node.T_world), np.concatenate(ends)))
    return tuple(pieces)


def world_parts(body: RigidBody) -> list[Points]:
    """Corners of all convex bodies of an object in the world, those that its joints move as they stand."""
    T = body.node.T_world
    moving = [place(T @ m.limb.T_object_limb, q) for m in body.moving for q in m.parts]
    return [*(place(T, p) for p in body.parts), *moving]


def _intersect(foot: Float[np.ndarray, "n 2"], top: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, "m 2"]:
    """Corners of what two convex outlines have in common; those of the foot where that is next to nothing."""
    both = manifold3d.CrossSection.hull_points(foot) ^ manifold3d.CrossSection.hull_points(top)
    return foot if both.area() < MIN_HOLD_M2 else np.concatenate(both.to_polygons())


def _shift_into_hull(outline: Float[np.ndarray, "n 2"], point: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    """Shift that brings a point inside a shrunken outline's hull; zero where there is no outline."""
    try:
        hull = ConvexHull(outline)
    except (QhullError, ValueError):
        return np.zeros(2)
    middle = outline[hull.vertices].mean(axis=0)
    offsets = (hull.equations[:, :2] @ middle + hull.equations[:, 2]) * BALANCE_SHARE
    reach = hull.equations[:, :2] @ (point - middle)
    if (reach + offsets).max() <= 0:
        return np.zeros(2)
    share = float(np.min(np.where(reach > 1e-12, -offsets / np.maximum(reach, 1e-12), np.inf)))
    return (middle + share * (point - middle)) - point


def _body(gathered: ExportScene, node: ExportObject) -> RigidBody:
    item, library = node.item, gathered.library
    shape = library.shape(item.shape_id)
    record = record_of(library, item.shape_id)
    surfaces = gathered.meshes[node.mesh].surfaces
    weights = _weights(gathered, node, record)
    half = np.asarray(item.size_m) / 2
    moving = tuple(
        MovingPart(
            limb,
            _turning_clear(_scale(limb_parts(library, shape.id, limb.number), node), limb),
            weights[limb.number],
            joint_friction(limb, weights[limb.number], node.T_world),
        )
        for limb in node.limbs
    )
    if node.limbs:
        parts = tuple(_clip(p, half) for p in _scale(limb_parts(library, shape.id, None), node))
    elif is_soft(node):
        parts = (box_corners(item.size_m),)  # soft objects lie on a face, not on their rim
    else:
        parts = tuple(_clip(p, half) for p in _scale(parts_of_shape(library, shape), node))
    body = RigidBody(node, parts, weights[None], friction_of(surfaces), True, moving=moving)
    carrier = _carrier(gathered, node)
    return body if carrier is _STANDING else _weld(body, carrier)


def joint_friction(limb: ExportLimb, inertia: Inertia, T_world: Float[np.ndarray, "4 4"]) -> float:
    """What a joint resists with, newtons or newton metres: what stands open is held there against its weight."""
    if limb.opened == 0.0:
        return MIN_JOINT_FRICTION
    axis, R = T_world[:3, :3] @ limb.axis, T_world[:3, :3]
    weight = np.array([0.0, 0.0, -GRAVITY * inertia.mass_kg])
    lever = R @ (place(limb.T_object_limb, inertia.centre) - limb.origin)
    load = weight if limb.kind == "slide" else np.cross(lever, weight)
    return max(MIN_JOINT_FRICTION, HOLD * abs(float(axis @ load)))


def _turning_clear(parts: tuple[Points, ...], limb: ExportLimb) -> tuple[Points, ...]:
    """Parts of a leaf that stay within its own width while it turns, so that what is flush beside it is no obstacle.

    A leaf of width w and thickness t reaches sqrt(w^2 + t^2) from its hinge: the rear of its free edge goes, where real
    ones have a gap of that size. So does what a handle reaches over that edge.
    """
    if limb.kind != "hinge" or not parts:
        return parts
    placed = [part - limb.origin for part in parts]
    out = np.concatenate(placed).mean(axis=0)
    out -= (out @ limb.axis) * limb.axis
    out = np.where(np.abs(out) == np.abs(out).max(), np.sign(out), 0.0)  # leaves lie along an axis of their object
    ahead = np.cross(limb.axis, out)
    panel = max(placed, key=lambda part: float(np.prod(np.ptp(part, axis=0)))) @ ahead
    leaf = np.concatenate([p for p in placed if (p @ ahead).min() < panel.max() and (p @ ahead).max() > panel.min()])
    reach, rear = float((leaf @ out).max()), max(0.0, -float((leaf @ ahead).min()))
    for angle in np.linspace(0.0, np.arctan2(rear, reach), TURNING_CUTS + 1):
        normal = np.sin(angle) * ahead - np.cos(angle) * out
        level = float(normal @ limb.origin) - reach
        inside = [part for part in parts if (part @ normal).max() > level]
        parts = tuple(part if (rest := cut(part, normal, level, np.inf)) is None else rest for part in inside)
    return parts


def _scale(parts: Iterable[ConvexPart], node: ExportObject) -> tuple[Points, ...]:
    return tuple(np.asarray(p.vertices) * node.scale for p in parts)


def _clip(points: Points, half: Float[np.ndarray, "3"]) -> Points:
    """A part without what its simplified form reaches beyond the shape's box by, so that feet are level."""
    for axis, sign in itertools.product(np.eye(3), (1.0, -1.0)):
        rest = cut(points, -sign * axis, -float(half @ axis), np.inf)
        points = points if rest is None else rest
    return points


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
    standing = abs(float(node.item.corners_world[:, 2].min()) - gathered.floor_m) < NEAR_FLOOR_M
    return _STANDING if standing else None


def _weld(body: RigidBody, carrier: str | None) -> RigidBody:
    return replace(body, free=False, carrier=carrier)
