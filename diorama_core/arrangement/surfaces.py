"""Supports for the layout: surfaces of supporters, contact faces, and edges missing in the graph."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.vectors import cross
from diorama_core.library import taxonomy
from diorama_core.library.record import Shape, SupportSurface
from diorama_core.scene.frames import FACE_NORMALS_OBJECT
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject, Support, box_corners

BOTTOM_FAVOURED = float(np.cos(np.deg2rad(55.0)))
"""The bottom face touches when it faces the support within this angle, even if another face does better."""
SMALLEST_SHARE = 0.35
"""A supporter narrower than this share of what it should hold cannot be meant."""
SMALLEST_CLEARANCE = 0.75
"""A place with less than this share of an object's height above it is chosen only where there is no other."""
OUT_OF_REACH_M = 0.12
"""What was measured farther from its place than this does not rest there: sizes do not differ by so much."""
BESIDE_M, BESIDE_SHARE = 0.06, 0.25
"""What was measured with its middle farther beside a place than this, and than this share of its width, does not rest
there either."""
_ON_OBJECT_M = 0.15
"""Added to the gap to another object, of things that people put on others: the floor is surer."""
NEAR_SURFACE_M = 0.1
"""What misses a surface by more does not rest on it."""
FLAT = 0.7
"""A surface counts as upward when its normal's z is at least this."""


@dataclass(frozen=True, eq=False)
class RestingSurface:
    """A flat convex place to rest on, in its owner's frame (the world for planes)."""

    polygon: Float[np.ndarray, "k 3"]
    """Counter-clockwise about `normal`; at scale 1 where the owner is an object."""
    normal: Float[np.ndarray, "3"]
    """Unit, out of the supporter."""
    outward: Float[np.ndarray, "s 3"]
    """Unit in-plane normals of its sides."""
    offset: Float[np.ndarray, " s"]
    """Inside is where outward . x <= offset."""
    level: float
    """The surface lies where normal . x = level."""
    clearance_m: float
    """Free depth along the normal at scale 1."""
    of_plane: bool

    @classmethod
    def of(cls, polygon: np.ndarray, normal: np.ndarray, clearance_m: float, *, of_plane: bool) -> RestingSurface:
        """A surface from its convex outline.

        Args:
            polygon: convex, (n, 3), counter-clockwise about the normal (m).
            normal: unit, out of the surface.
            clearance_m: free depth along the normal, at scale 1.
            of_plane: whether it belongs to the room and so does not move with an object.
        """
        sides = np.roll(polygon, -1, axis=0) - polygon
        lengths = np.linalg.norm(sides, axis=1)
        long = lengths > 1e-9
        outward = cross(sides[long] / lengths[long, None], normal)
        offset = (outward * polygon[long]).sum(axis=1)
        return cls(polygon, normal, outward, offset, float(normal @ polygon.mean(axis=0)), clearance_m, of_plane)

    def to_world(self, pose: Pose | None) -> RestingSurface:
        """The surface at its owner's pose."""
        return self if pose is None else self.transform(pose.R_world_object, pose.position, pose.scale)

    def transform(
        self, R: Float[np.ndarray, "3 3"], p: Float[np.ndarray, "3"], scale: Float[np.ndarray, "3"]
    ) -> RestingSurface:
        """The surface, in the world, of an owner with this rotation to it, this centre and this scale.

        Args:
            R: rotation (3, 3) from the owner's frame to the world.
            p: the owner's centre in the world (m).
            scale: per axis of the owner.
        """
        if self.of_plane:
            return self
        axis = int(np.abs(self.normal).argmax())
        normal = R @ self.normal
        outward = self.outward / scale
        length = np.sqrt((outward * outward).sum(axis=1))
        outward = (outward / length[:, None]) @ R.T
        return RestingSurface(
            polygon=(self.polygon * scale) @ R.T + p,
            normal=normal,
            outward=outward,
            offset=self.offset / length + outward @ p,
            level=self.level * float(scale[axis]) + float(normal @ p),
            clearance_m=self.clearance_m * float(scale[axis]),
            of_plane=False,
        )


def is_soft(item: SceneObject) -> bool:
    """Whether an object is soft: it sinks into its neighbours and leans over edges."""
    return taxonomy.resolve(item.category).category.soft


def is_wall_like(surface: RestingSurface | None) -> bool:
    """Whether objects are mounted on a surface rather than placed on it."""
    return surface is not None and surface.of_plane and abs(float(surface.normal[2])) < FLAT


@lru_cache(maxsize=256)
def plane_surface(plane: Plane) -> RestingSurface:
    """A plane of the room as a place to rest on (its convex hull)."""
    return RestingSurface.of(convex_outline(plane.polygon, plane.normal), plane.normal, float("inf"), of_plane=True)


def convex_outline(polygon: Float[np.ndarray, "n 3"], normal: Float[np.ndarray, "3"]) -> Float[np.ndarray, "k 3"]:
    """The convex hull of a planar polygon, counter-clockwise about its normal."""
    u, v = plane_axes(normal)
    flat = np.column_stack([polygon @ u, polygon @ v])
    # Corners of one upright side differ by rounding; ordered by that, the chain would leave out the side's end.
    keys = flat.round(9)
    ordered = flat[np.lexsort((keys[:, 1], keys[:, 0]))]
    chains = []
    for run in (ordered, ordered[::-1]):
        chain: list[np.ndarray] = []
        for point in run:
            while len(chain) > 1 and _cross(chain[-1] - chain[-2], point - chain[-1]) <= 1e-12:
                chain.pop()
            chain.append(point)
        chains += chain[:-1]
    hull = np.array(chains)
    return hull[:, :1] * u + hull[:, 1:] * v + (normal @ polygon.mean(axis=0)) * normal


def _cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def object_surfaces(shape: Shape, item: SceneObject) -> tuple[RestingSurface, ...]:
    """Upward places of an object, in its frame; the top of its box when the shape has none."""
    return tuple(_shape_surface(s) for s in shape.surfaces) or (_box_face(item.shape_size_m, 2, 1.0),)


@lru_cache(maxsize=4096)
def _shape_surface(surface: SupportSurface) -> RestingSurface:
    return RestingSurface.of(
        np.asarray(surface.polygon), np.array([0.0, 0.0, 1.0]), surface.clearance_m, of_plane=False
    )


@lru_cache(maxsize=1024)
def _box_face(size: tuple[float, float, float], axis: int, sign: float) -> RestingSurface:
    normal = np.zeros(3)
    normal[axis] = sign
    corners = box_corners(size)
    face = corners[corners[:, axis] * sign > 0]
    return RestingSurface.of(convex_outline(face, normal), normal, float("inf"), of_plane=False)


def choose_surface(scene: Scene, item: SceneObject, edge: Support, supporter: Shape | None) -> RestingSurface:
    """The surface on which the child of an edge rests, as observed.

    Args:
        scene, item, edge, supporter: as of `possible_surfaces`.
    """
    options = possible_surfaces(scene, item, edge, supporter)
    if len(options) == 1:
        return options[0]
    pose = scene.object(edge.parent).pose
    return min(options, key=lambda s: misfit(item, s.to_world(pose)))


def possible_surfaces(
    scene: Scene, item: SceneObject, edge: Support, supporter: Shape | None
) -> tuple[RestingSurface, ...]:
    """The surfaces on which the child of an edge may rest: several where a supporter has several levels.

    Args:
        scene: with the object and its supporter.
        item: the child, as observed.
        edge: what it rests on.
        supporter: shape of the parent; None where the parent is a plane of the room.
    """
    if supporter is None:
        return (plane_surface(scene.plane(edge.parent)),)
    parent = scene.object(edge.parent)
    if edge.relation == "mounted on":
        return (_nearest_side(item, parent),)
    options = object_surfaces(supporter, parent)
    if edge.parent_surface is not None and 0 <= edge.parent_surface < len(options):
        return (options[edge.parent_surface],)
    return (_spread(options),) if is_soft(item) else options


def _spread(options: Sequence[RestingSurface]) -> RestingSurface:
    """The largest place, widened over all others at its height: where pillows lie, those of the shape give way."""
    largest = max(options, key=lambda s: float(np.prod(np.ptp(s.polygon, axis=0)[:2])))
    points = np.vstack([s.polygon for s in options])
    points[:, 2] = largest.level
    outline = convex_outline(points, largest.normal)
    return RestingSurface.of(outline, largest.normal, largest.clearance_m, of_plane=False)


def _nearest_side(item: SceneObject, parent: SceneObject) -> RestingSurface:
    sides = [_box_face(parent.shape_size_m, axis, sign) for axis in (0, 1) for sign in (1.0, -1.0)]

    def gap(side: RestingSurface) -> float:
        world = side.to_world(parent.pose)
        return overhang_m(world, item.pose.position) + abs(float(world.normal @ item.pose.position) - world.level)

    return min(sides, key=gap)


def misfit(item: SceneObject, surface: RestingSurface) -> float:
    """How badly an object's observed pose agrees with resting on a surface (world): metres, lower is better."""
    return box_misfit(item.corners_world, item.size_m, surface)


def box_misfit(corners: Float[np.ndarray, "8 3"], size: Float[np.ndarray, "3"], surface: RestingSurface) -> float:
    """How badly a box with these corners (world) and extents agrees with resting on a surface, metres."""
    along = corners @ surface.normal
    low, height = float(along.min()), float(np.ptp(along))
    gap = abs(low - surface.level)
    over = max(height - surface.clearance_m, 0.0)
    squeezed = 1.0 if surface.clearance_m < SMALLEST_CLEARANCE * height else 0.0
    return gap + overhang_m(surface, corners.mean(axis=0)) + 0.5 * over + squeezed + 0.5 * _too_wide(size, surface)


def reaches(item: SceneObject, surface: RestingSurface) -> bool:
    """Whether an object was measured so near to a surface (world) that it may rest there."""
    corners = item.corners_world
    gap = abs(float((corners @ surface.normal).min()) - surface.level)
    wide = max(float(np.ptp(corners @ axis)) for axis in plane_axes(surface.normal))
    beside = overhang_m(surface, item.pose.position) / max(BESIDE_M, BESIDE_SHARE * wide)
    return float(np.hypot(gap / OUT_OF_REACH_M, beside)) <= 1.0


def _too_wide(size: Float[np.ndarray, "3"], surface: RestingSurface) -> float:
    """How much a box exceeds the surface in the narrower direction, metres."""
    widths = sorted(size)[1:]
    u, v = plane_axes(surface.normal)
    room = sorted([float(np.ptp(surface.polygon @ u)), float(np.ptp(surface.polygon @ v))])
    return max(min(widths) - room[0], 0.0) + max(max(widths) - room[1], 0.0)


def overhang_m(surface: RestingSurface, point: Float[np.ndarray, "3"]) -> float:
    """Distance (in the plane) by which a point's projection misses the surface; 0 inside."""
    return max(float((surface.outward @ point - surface.offset).max()), 0.0)


def choose_contact(
    scene: Scene, item: SceneObject, edge: Support | None, surface: RestingSurface | None
) -> Float[np.ndarray, "3"]:
    """Outward normal of the face that touches the supporter, in the object frame.

    Args:
        scene, item: with the object and its supporter; the object.
        edge: what it rests on; its bottom touches where there is none.
        surface: of the supporter, in the supporter's object frame; that of a plane in the world.
    """
    if edge is None or surface is None:
        return np.array(FACE_NORMALS_OBJECT["bottom"])
    if edge.child_face is not None:
        return np.array(FACE_NORMALS_OBJECT[edge.child_face])
    supporter = scene.object(edge.parent).pose if scene.has_object(edge.parent) else None
    normal = surface.normal if supporter is None else supporter.R_world_object @ surface.normal
    if abs(float(normal[2])) < FLAT and taxonomy.resolve(item.category).category.mount == "wall":
        return np.array(FACE_NORMALS_OBJECT["back"])
    down = -(item.pose.R_world_object.T @ normal)
    if -down[2] >= BOTTOM_FAVOURED:
        return np.array(FACE_NORMALS_OBJECT["bottom"])
    face = np.zeros(3)
    axis = int(np.abs(down).argmax())
    face[axis] = np.sign(down[axis])
    return face


def wall_faces(
    R: Float[np.ndarray, "n 3 3"], p: Float[np.ndarray, "n 3"], sizes: Float[np.ndarray, "n 3"], wall: Plane
) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """How objects stand to a wall: the face that looks at it, its gap in metres (inf beside it), how parallel it is.

    Args:
        R: rotations from the objects' frames to the world.
        p: centres in the world (m).
        sizes: depth, width and height of the objects (m).
        wall: a plane of the room.
    """
    toward = -(wall.normal @ R)
    axis = np.abs(toward[:, :2]).argmax(axis=1)
    rows = np.arange(len(R))
    faces = np.zeros((len(R), 3))
    faces[rows, axis] = np.sign(toward[rows, axis])
    # The back goes to the wall unless another face looks at it much more plainly.
    faces[toward[:, 0] <= -0.7] = FACE_NORMALS_OBJECT["back"]
    centre = p + np.matmul(R, (faces * sizes / 2)[..., None])[..., 0]
    surface = plane_surface(wall)
    beside = (centre @ surface.outward.T - surface.offset).max(axis=1)
    gap = np.abs(centre @ wall.normal - wall.offset)
    return faces, np.where(beside < 0.5, gap, np.inf), (toward * faces).sum(axis=1)


def is_wide_enough(item: SceneObject, edge: Support, supporter: SceneObject, shape: Shape) -> bool:
    """Whether some surface of a supporter is at least `SMALLEST_SHARE` as wide as the object on it.

    Args:
        item, edge: the object, and what it rests on.
        supporter, shape: the parent and its shape.
    """
    if edge.relation == "mounted on":
        return True
    widths = sorted(np.sort(item.size_m)[1:] if edge.child_face else item.size_m[:2])
    for surface in object_surfaces(shape, supporter):
        spans = sorted(np.ptp(surface.polygon, axis=0)[:2] * supporter.pose.scale[:2])
        if spans[0] >= SMALLEST_SHARE * widths[0] and spans[1] >= SMALLEST_SHARE * widths[1]:
            return True
    return False


def complete_edges(
    scene: Scene, objects: Sequence[SceneObject], shapes: Sequence[Shape]
) -> tuple[list[Support | None], tuple[str, ...]]:
    """One support edge per object where there is anything to rest on: the graph's own, or the most plausible one.

    Edges that close a cycle or lead nowhere are replaced. The reasons list the assumptions.
    """
    reasons: list[str] = []
    edges: dict[str, Support | None] = {}
    by_id = {o.id: s for o, s in zip(objects, shapes)}
    for item in objects:
        edge = scene.support_of(item.id)
        if edge is not None and not (scene.has_object(edge.parent) or scene.has_plane(edge.parent)):
            edge = None
        if edge is not None and closes_cycle(edges, item.id, edge.parent):
            reasons.append(
                f"cycle: {item.label} and {label_of(scene, edge.parent)} support each other; one edge was left out"
            )
            edge = None
        if edge is not None and scene.has_object(edge.parent):
            supporter = scene.object(edge.parent)
            if not is_wide_enough(item, edge, supporter, by_id[edge.parent]):
                reasons.append(f"larger than its support: {item.label} cannot stand on {supporter.label}")
                edge = None
        edges[item.id] = edge
    for k, item in enumerate(objects):
        if edges[item.id] is None:
            edges[item.id] = _most_plausible(scene, item, objects, shapes, edges)
            known_edge = edges[item.id]
            on = (
                f"taken to rest on {label_of(scene, known_edge.parent)}"
                if known_edge is not None
                else "left at its height"
            )
            reasons.append(f"no support edge: {objects[k].label} was {on}")
    return [edges[o.id] for o in objects], tuple(reasons)


def label_of(scene: Scene, any_id: str) -> str:
    """What people call an object or a plane, with its number where there are several of its role."""
    if scene.has_object(any_id):
        return scene.object(any_id).label
    plane = scene.plane(any_id)
    number = scene.architecture.number_of(plane)
    return f"the {plane.role}" if number is None else f"{plane.role} {number}"


def closes_cycle(edges: Mapping[str, Support | None], child: str, parent: str) -> bool:
    """Whether a child would hold up itself if it stood on this parent."""
    above: str | None = parent
    while above is not None:
        if above == child:
            return True
        edge = edges.get(above)
        above = edge.parent if edge is not None else None
    return False


def _most_plausible(
    scene: Scene,
    item: SceneObject,
    objects: Sequence[SceneObject],
    shapes: Sequence[Shape],
    edges: dict[str, Support | None],
) -> Support | None:
    """The supporter whose surface agrees best with the observed pose; None when there is none.

    What was seen in a photo clearly away from all of them is held by something that is not marked.
    """
    kind = taxonomy.resolve(item.category).category
    mount, lies = kind.mount, taxonomy.lies_on_furniture(kind.name)
    seen_loose = item.box_px is not None and lies
    options: list[tuple[float, str, Support]] = []
    for plane in scene.architecture.planes:
        usual = {"floor": "floor", "surface": "floor", "wall": "wall", "ceiling": "ceiling"}[mount]
        if plane.role != usual and not (plane.role == "floor" and mount != "ceiling"):
            continue
        edge = Support(item.id, plane.id, "placed on" if plane.role == "floor" else "mounted on")
        cost = resting_cost(scene, item, edge, plane_surface(plane))
        if not seen_loose or cost <= OUT_OF_REACH_M:
            options.append((cost + (0.0 if plane.role == usual else 0.3), plane.id, edge))
    for other, shape in zip(objects, shapes):
        if mount == "ceiling" or closes_cycle(edges, item.id, other.id):
            continue
        for world in surfaces_below(item, other, shape):
            if not seen_loose or reaches(item, world):
                cost = misfit(item, world) + (_ON_OBJECT_M if lies else 0.4)
                options.append((cost, other.id, Support(item.id, other.id)))
    return min(options, key=lambda o: o[:2])[2] if options else None


def surfaces_below(item: SceneObject, other: SceneObject, shape: Shape) -> list[RestingSurface]:
    """Surfaces of another object, in the world, that lie below an object.

    Args:
        item: what may rest on them.
        other: whose they are.
        shape: the other's.
    """
    if other.id == item.id:
        return []
    candidates = (surface.to_world(other.pose) for surface in object_surfaces(shape, other))
    centre = item.pose.position
    return [w for w in candidates if w.level < float(w.normal @ centre) and overhang_m(w, centre) < NEAR_SURFACE_M]


def resting_cost(scene: Scene, item: SceneObject, edge: Support, surface: RestingSurface) -> float:
    """Distance in metres of an object's touching face from a surface (world), and by which it misses it.

    Args:
        scene, item, edge: with the object and its supporter; the object, and what it rests on.
        surface: in the world.
    """
    contact = choose_contact(scene, item, edge, surface)
    centre = item.pose.position + item.pose.R_world_object @ (contact * item.size_m / 2)
    return abs(float(surface.normal @ centre) - surface.level) + overhang_m(surface, item.pose.position)
