"""What the layout optimisers solve: a scene and its shapes, reduced to arrays.

Objects are sorted by id, so that no result depends on the order in which a scene lists them.

Objects touch what holds them up with the points of their shape near its contact face. A round table stands within a
floor that the corners of its box overhang; a lamp stands on its base, not on its shade.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.arrangement.surfaces import (
    RestingSurface,
    box_misfit,
    choose_contact,
    choose_surface,
    complete_edges,
    is_soft,
    is_wall_like,
    plane_surface,
    possible_surfaces,
    wall_faces,
)
from diorama_core.geometry.convex import ConvexPart
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.geometry.sat import PaddedParts, pack_parts
from diorama_core.geometry.vectors import unique_rows
from diorama_core.layout.problem.parts import parts_of_shape
from diorama_core.layout.settings import LAYOUT, LayoutSettings
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject, Support, box_corners

_BOX_GRID = np.stack(np.meshgrid(*3 * [np.linspace(-0.5, 0.5, 5)]), axis=-1).reshape(-1, 3)
"""Points of a box of extents 1."""
CONTACT_SHARE = 0.03
"""What is within this share of a shape's depth from its contact face touches what holds it up."""


@dataclass(frozen=True, eq=False)
class Problem:
    """Everything an optimiser needs, indexed by object (sorted by id)."""

    ids: tuple[str, ...]
    labels: tuple[str, ...]
    R: Float[np.ndarray, "n 3 3"]
    """Observed rotations, world from object."""
    p: Float[np.ndarray, "n 3"]
    """Observed centres in the world, metres."""
    scale: Float[np.ndarray, "n 3"]
    """Observed scales."""
    shape_size: Float[np.ndarray, "n 3"]
    """Extents at scale 1, metres."""
    firm: Float[np.ndarray, " n"]
    """Rigid share of the extents: 1, less for soft objects."""
    certainty: Float[np.ndarray, " n"]
    """How far the evidence supports each observed pose, 0 to 1."""
    parent: Int[np.ndarray, " n"]
    """Index of the supporting object, or -1."""
    on_plane: tuple[str | None, ...]
    """Id of the supporting plane, where one supports."""
    surface: tuple[RestingSurface | None, ...]
    """Support of each object; None without one."""
    levels: tuple[tuple[RestingSurface, ...], ...]
    """Where each object may rest on its supporter; which of these it is depends on where the supporter ends."""
    contact: Float[np.ndarray, "n 3"]
    """Outward normal of the touching face, in the object frame."""
    footing: tuple[Float[np.ndarray, "_ 3"], ...]
    """Points of each object at scale 1, in its frame, that touch its supporter, flattened onto the contact face."""
    box_px: Float[np.ndarray, "n 4"]
    """Where the photo shows each object: x1, y1, x2, y2; NaN where nothing says so."""
    free: Bool[np.ndarray, " n"]
    """False for constants: locked, or outside the selection."""
    adheres: tuple[tuple[int, int, Float[np.ndarray, "3"]], ...]
    """(object, wall, outward normal of the object's face against that wall, in the object frame)."""
    grounded: Bool[np.ndarray, " n"]
    """Doors: they hang on a wall and reach down to the floor."""
    floor_m: float
    """Height of the floor; 0 without one."""
    floor_outline: Float[np.ndarray, "k 2"]
    """The floor's outline in plan, empty without one; with walls that stand into the room it is not convex."""
    walls: tuple[Plane, ...]
    relations: Int[np.ndarray, "m 2"]
    """Pairs that are near each other and should stay so."""
    kin: Bool[np.ndarray, "n n"]
    """Pairs that never collide: an object and its direct or indirect supporters, and `yielding` ones."""
    yielding: Bool[np.ndarray, "n n"]
    """Pairs of which one is a rug: objects stand over its edge."""
    parts: tuple[tuple[ConvexPart, ...], ...]
    packed: PaddedParts
    """The parts, ready to be posed."""
    reasons: tuple[str, ...] = ()
    settings: LayoutSettings = LAYOUT

    @property
    def count(self) -> int:
        """Number of objects."""
        return len(self.ids)

    @cached_property
    def top_down(self) -> tuple[int, ...]:
        """Object indices, supporters before what they support."""
        depth = [len(self.chain(i)) for i in range(self.count)]
        return tuple(sorted(range(self.count), key=lambda i: (depth[i], i)))

    def chain(self, index: int) -> list[int]:
        """The object and its supporting objects, nearest first."""
        chain = [index]
        while self.parent[chain[-1]] >= 0:
            chain.append(int(self.parent[chain[-1]]))
        return chain

    @cached_property
    def _riders(self) -> tuple[tuple[int, ...], ...]:
        riders: list[list[int]] = [[] for _ in range(self.count)]
        for k in range(self.count):
            for i in self.chain(k):
                riders[i].append(k)
        return tuple((i, *(k for k in r if k != i)) for i, r in enumerate(riders))

    def rides(self, index: int) -> list[int]:
        """The object, first, and all objects it supports, directly or indirectly."""
        return list(self._riders[index])

    def walls_near(self, index: int) -> tuple[Plane, ...]:
        """The seen walls that an object could reach, beyond their ends too, and before which it was observed.

        The one it is on is left out, and those whose ends it passes.
        """
        walls = []
        radius = 0.5 * float(np.linalg.norm(self.shape_size[index] * self.scale[index]))
        for wall in self.walls:
            surface = plane_surface(wall)
            beside = float((surface.outward @ self.p[index] - surface.offset).max())
            ahead = float(wall.normal @ self.p[index]) - wall.offset
            near = beside <= radius and 0.0 <= ahead <= radius
            if wall.is_seen and self.on_plane[index] != wall.id and near and not self.passes(wall, index):
                walls.append(wall)
        return tuple(walls)

    def passes(self, wall: Plane, index: int) -> bool:
        """Whether an object is beside the end of a wall that stands into the room.

        What of it is behind the wall's plane is in the room then, round the corner.
        """
        points = self.p[index] + (_BOX_GRID * self.shape_size[index] * self.scale[index]) @ self.R[index].T
        behind = points[points @ wall.normal < wall.offset - self.settings.behind_m]
        surface = plane_surface(wall)
        beside = (behind @ surface.outward.T - surface.offset).max(axis=1) > -self.settings.behind_m
        return len(behind) > 0 and bool((beside & is_in_polygon(behind[:, :2], self.floor_outline)).all())

    def with_poses(
        self, R: Float[np.ndarray, "n 3 3"], p: Float[np.ndarray, "n 3"], scale: Float[np.ndarray, "n 3"]
    ) -> Problem:
        """This problem with its objects in other poses."""
        return replace(self, R=R, p=p, scale=scale)

    def with_poses_of(self, scene: Scene) -> Problem:
        """This problem with its objects in the poses that they have in a scene."""
        poses = [scene.object(name).pose for name in self.ids]
        return self.with_poses(
            np.array([pose.R_world_object for pose in poses]).reshape(-1, 3, 3),
            np.array([pose.position for pose in poses]).reshape(-1, 3),
            np.array([pose.scale for pose in poses]).reshape(-1, 3),
        )

    def to_world(self, index: int, place: RestingSurface) -> RestingSurface:
        """A place on an object's supporter where the supporter is; a plane is in the world as it is."""
        j = int(self.parent[index])
        return place if j < 0 else place.transform(self.R[j], self.p[j], self.scale[j])

    def place_of(self, index: int, observed: Problem) -> RestingSurface | None:
        """The place on an object's supporter, as this stands, that agrees best with where the object was observed."""
        if len(self.levels[index]) < 2:
            return self.surface[index]
        size = observed.shape_size[index] * observed.scale[index]
        corners = observed.p[index] + box_corners(size) @ observed.R[index].T
        return min(self.levels[index], key=lambda s: box_misfit(corners, size, self.to_world(index, s)))

    @property
    def free_poses(self) -> dict[str, Pose]:
        """Poses of the objects that are free to move."""
        return {self.ids[i]: Pose(self.R[i], self.p[i], self.scale[i]) for i in np.flatnonzero(self.free)}


def build_problem(
    scene: Scene,
    library: ShapeLibrary,
    *,
    only: frozenset[str] | None = None,
    adherence_m: float = 0.1,
    settings: LayoutSettings = LAYOUT,
) -> Problem:
    """Reduce a scene to arrays.

    Args:
        scene: with any support graph: missing edges are completed from geometry, cycles are cut, with a reason.
        library: where shapes come from.
        only: ids free to move, with what they hold up; all when None.
        adherence_m: faces parallel to a wall and nearer than this are taken to stand against it.
        settings: numbers that steer how it is solved.
    """
    objects = sorted(scene.objects, key=lambda o: o.id)
    shapes = [library.shape(o.shape_id) for o in objects]
    edges, reasons = complete_edges(scene, objects, shapes)
    index = {o.id: k for k, o in enumerate(objects)}
    free = _free(scene, objects, only)
    parent = np.array([-1 if e is None else index.get(e.parent, -1) for e in edges], dtype=int)
    supporters = [shapes[k] if k >= 0 else None for k in parent]
    surfaces = [None if e is None else choose_surface(scene, o, e, s) for o, e, s in zip(objects, edges, supporters)]
    levels = [() if e is None else possible_surfaces(scene, o, e, s) for o, e, s in zip(objects, edges, supporters)]
    contacts = [choose_contact(scene, o, e, s) for o, e, s in zip(objects, edges, surfaces)]
    walls = tuple(sorted(scene.architecture.by_role("wall"), key=lambda w: w.id))
    floor = scene.architecture.floor
    yielding = _yielding_pairs(objects)
    firm = np.array([settings.firm_share if is_soft(o) else 1.0 for o in objects]).reshape(-1)
    parts = tuple(
        _firm_parts(parts_of_shape(library, s), share, face * np.asarray(o.shape_size_m) / 2)
        for o, s, share, face in zip(objects, shapes, firm, contacts)
    )
    on_plane = tuple(e.parent if e is not None and e.parent not in index else None for e in edges)
    p = np.array([o.pose.position for o in objects]).reshape(-1, 3)
    R = np.array([o.pose.R_world_object for o in objects]).reshape(-1, 3, 3)
    sizes = np.array([o.size_m for o in objects]).reshape(-1, 3)
    return Problem(
        ids=tuple(o.id for o in objects),
        labels=tuple(o.label for o in objects),
        R=R,
        p=p,
        scale=np.array([o.pose.scale for o in objects]).reshape(-1, 3),
        shape_size=np.array([o.shape_size_m for o in objects]).reshape(-1, 3),
        firm=firm,
        certainty=np.array([o.confidence for o in objects]).reshape(-1),
        parent=parent,
        on_plane=on_plane,
        surface=tuple(surfaces),
        levels=tuple(levels),
        contact=np.array(contacts, dtype=np.float64).reshape(-1, 3),
        footing=tuple(
            footing_of(object_parts, face) if share == 1.0 else box_footing(share * np.asarray(o.shape_size_m), face)
            for o, object_parts, share, face in zip(objects, parts, firm, contacts)
        ),
        box_px=np.array([o.box_px or (np.nan,) * 4 for o in objects], dtype=np.float64).reshape(-1, 4),
        free=free,
        adheres=_adherences(R, p, sizes, edges, surfaces, walls, adherence_m),
        grounded=np.array([o.category == "door" for o in objects], dtype=bool),
        floor_m=0.0 if floor is None else float(floor.centre[2]),
        floor_outline=np.zeros((0, 2)) if floor is None else floor.polygon[:, :2],
        walls=walls,
        relations=_relations(parent, on_plane, p, sizes),
        kin=_kin(parent, yielding),
        yielding=yielding,
        parts=parts,
        packed=pack_parts(parts),
        reasons=reasons,
        settings=settings,
    )


def _firm_parts(parts: tuple[ConvexPart, ...], share: float, contact: Float[np.ndarray, "3"]) -> tuple[ConvexPart, ...]:
    """Parts reduced about the centre of their contact face: what is soft still rests on what holds it up."""
    if share == 1.0:
        return parts
    return tuple(replace(part, vertices=contact + share * (part.vertices - contact)) for part in parts)


def _free(scene: Scene, objects: Sequence[SceneObject], only: frozenset[str] | None) -> Bool[np.ndarray, " n"]:
    chosen = None if only is None else set(only).union(*(descendants(scene, i) for i in only if scene.has_object(i)))
    return np.array([not o.locked and (chosen is None or o.id in chosen) for o in objects], dtype=bool)


def _adherences(
    R: np.ndarray,
    p: np.ndarray,
    sizes: np.ndarray,
    edges: Sequence[Support | None],
    surfaces: Sequence[RestingSurface | None],
    walls: tuple[Plane, ...],
    within_m: float,
) -> tuple[tuple[int, int, np.ndarray], ...]:
    """Stated adherences, and faces that already are parallel to a wall and near it."""
    adherences = []
    for w, wall in enumerate(walls):
        faces, gap, facing = wall_faces(R, p, sizes, wall)
        for k, edge in enumerate(edges):
            surface = surfaces[k]
            if edge is None or surface is None or is_wall_like(surface):
                continue
            near = gap[k] < within_m and facing[k] > 0.97 and surface.of_plane
            if near or wall.id in edge.adheres_to:
                adherences.append((k, w, faces[k]))
    return tuple(sorted(adherences, key=lambda a: a[:2]))


def _relations(
    parent: np.ndarray, on_plane: Sequence[str | None], p: np.ndarray, sizes: np.ndarray
) -> Int[np.ndarray, "m 2"]:
    """Support edges between objects, and each object with its nearest three siblings closer than a metre."""
    pairs = {(k, int(j)) for k, j in enumerate(parent) if j >= 0}
    names = {name: -2 - k for k, name in enumerate(sorted({n for n in on_plane if n is not None}))}
    supporter = np.where(parent >= 0, parent, [names[n] if n is not None else -1 for n in on_plane])
    radius = 0.5 * np.linalg.norm(sizes, axis=1)
    gap = np.linalg.norm(p[:, None] - p[None], axis=2) - radius[:, None] - radius[None]
    gap[(supporter[:, None] != supporter[None]) | np.eye(len(parent), dtype=bool) | (gap > 1.0)] = np.inf
    for k, order in enumerate(np.argsort(gap, axis=1, kind="stable")[:, :3]):
        pairs |= {(max(k, int(j)), min(k, int(j))) for j in order if np.isfinite(gap[k, j])}
    return np.array(sorted(pairs), dtype=int).reshape(-1, 2)


def _kin(parent: np.ndarray, yielding: Bool[np.ndarray, "n n"]) -> Bool[np.ndarray, "n n"]:
    kin = np.eye(len(parent), dtype=bool) | yielding
    for k in range(len(parent)):
        above = int(parent[k])
        while above >= 0:
            kin[k, above] = kin[above, k] = True
            above = int(parent[above])
    return kin


def _yielding_pairs(objects: Sequence[SceneObject]) -> Bool[np.ndarray, "n n"]:
    rugs = np.array([o.category == "rug" and o.size_m[2] < 0.06 for o in objects], dtype=bool).reshape(-1)
    return rugs[:, None] | rugs[None]


def footing_of(parts: Sequence[ConvexPart], contact: Float[np.ndarray, "3"]) -> Float[np.ndarray, "k 3"]:
    """Points of convex parts (object frame) near the face with outward normal `contact`, flattened onto its plane."""
    points = np.concatenate([part.vertices for part in parts])
    along = points @ contact
    near = along >= along.max() - CONTACT_SHARE * np.ptp(along)
    return _distinct(points[near] * (1.0 - np.abs(contact)))


def box_footing(size_m: Float[np.ndarray, "3"], contact: Float[np.ndarray, "3"]) -> Float[np.ndarray, "k 3"]:
    """The corners of a box's contact face, flattened onto its plane."""
    return _distinct(box_corners(size_m) * (1.0 - np.abs(contact)))


def _distinct(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "k 3"]:
    return points[unique_rows(points)[0]]


def reach_of(
    footing: Float[np.ndarray, "k 3"],
    R: Float[np.ndarray, "3 3"],
    scale: Float[np.ndarray, "3"],
    outward: Float[np.ndarray, "s 3"],
) -> Float[np.ndarray, " s"]:
    """How far a footing reaches from the centre of the contact face along each outward direction (world), metres.

    Args:
        footing: points at scale 1, object frame.
        R: rotation of the object.
        scale: along its axes.
        outward: unit directions, world.
    """
    return (outward @ (R @ (footing * scale).T)).max(axis=1)
