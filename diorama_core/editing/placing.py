"""Placement of objects: the surface under a ray, resting on a support, against a wall, a free spot.

Pure geometry over the scene; what is dragged, clicked in or dropped asks here.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.surfaces import RestingSurface, convex_outline, object_surfaces, overhang_m, plane_surface
from diorama_core.geometry.openings import DOOR
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject, Support, yaw_rotation

UPWARD = 0.7
"""A surface is a place to stand on when its normal's z is at least this."""
FITS_SHARE = 0.5
"""At least this share of a footprint's corners must be over a surface for an object to be put there."""

HANGING_HEIGHT_M = 1.5
"""Height above the floor of the middle of what is hung on a wall."""
TALLER_M = 0.01
WALL_MAGNET_M = 0.09
WALL_MAGNET_RAD = float(np.radians(12.0))


@dataclass(frozen=True, eq=False)
class SupportTarget:
    """A surface in the world, and the edge's parent for what stands on or hangs at it."""

    surface: RestingSurface
    parent: str
    of_object: bool
    index: int | None = None
    """Number of the surface among its owner's."""

    @property
    def upward(self) -> bool:
        """Whether objects stand on it."""
        return float(self.surface.normal[2]) >= UPWARD

    def edge(self, child: str) -> Support:
        """The support edge of something put here."""
        return Support(child, self.parent, "placed on" if self.upward else "mounted on", parent_surface=self.index)


@dataclass(frozen=True, eq=False)
class Hit:
    """Where a ray meets a place."""

    place: SupportTarget
    point: Float[np.ndarray, "3"]
    distance: float


def places_of(scene: Scene, library: ShapeLibrary, without: Iterable[str] = ()) -> tuple[SupportTarget, ...]:
    """Every surface of the room and of its visible objects, apart from some objects' own."""
    gone = frozenset(without)
    places = [SupportTarget(plane_surface(p), p.id, of_object=False) for p in scene.architecture.planes]
    for item in scene.objects:
        if item.id in gone or item.hidden:
            continue
        shape = library.shape(item.shape_id)
        if not shape.surfaces:
            continue
        for index, surface in enumerate(object_surfaces(shape, item)):
            places.append(SupportTarget(surface.to_world(item.pose), item.id, of_object=True, index=index))
    return tuple(places)


def hits_along(
    origin: Float[np.ndarray, "3"],
    direction: Float[np.ndarray, "3"],
    places: Iterable[SupportTarget],
    *,
    lift_m: float = 0.0,
    slack_m: float = 1e-6,
) -> list[Hit]:
    """Places that a ray meets from their visible side, nearest first.

    `lift_m` raises every surface along its normal: the plane in which the grabbed point of an object that stands on it
    would move.

    Args:
        origin: of the ray, world, metres.
        direction: of the ray.
        places: surfaces to meet.
        lift_m: by which each is raised along its normal.
        slack_m: by which its edge may be missed.
    """
    hits = []
    for place in places:
        surface = place.surface
        slope = float(surface.normal @ direction)
        if slope > -1e-6:
            continue
        distance = (surface.level + lift_m - float(surface.normal @ origin)) / slope
        if distance <= 0:
            continue
        point = origin + distance * direction - lift_m * surface.normal
        if overhang_m(surface, point) <= slack_m:
            hits.append(Hit(place, point, distance))
    return sorted(hits, key=lambda hit: hit.distance)


def fits(place: SupportTarget, size_m: Float[np.ndarray, "3"], base: Float[np.ndarray, "3"], R: np.ndarray) -> bool:
    """Whether an object of this size with its base here may stand on an object's surface.

    Args:
        place: the surface.
        size_m: of the object.
        base: middle of its foot, world, metres.
        R: rotation of the object.
    """
    if not place.of_object:
        return True
    if not place.upward or size_m[2] > place.surface.clearance_m + TALLER_M:
        return False
    corners = np.array([[sx * size_m[0] / 2, sy * size_m[1] / 2, 0.0] for sx in (-1, 1) for sy in (-1, 1)]) @ R.T + base
    over = np.mean([overhang_m(place.surface, c) <= 0.02 for c in corners])
    return bool(over >= FITS_SHARE)


def seat(scene: Scene, library: ShapeLibrary, object_id: str) -> Scene:
    """The object on the surface of its supporter that is nearest to where it is, its load along with it."""
    edge = scene.support_of(object_id)
    if edge is None:
        return scene
    item = scene.object(object_id)
    moved_ids = {object_id, *descendants(scene, object_id)}
    options = [p for p in places_of(scene, library, moved_ids) if p.parent == edge.parent]
    if scene.has_object(edge.parent):
        options = [p for p in options if p.upward] or [_box_top(scene.object(edge.parent))]
    if not options:
        return scene
    if scene.has_plane(edge.parent) and not options[0].upward:
        return edits.move(scene, object_id, _hang(item, options[0].surface))
    base = item.pose.position - item.pose.R_world_object[:, 2] * item.size_m[2] / 2

    def far(place: SupportTarget) -> tuple[bool, float]:
        tight = bool(item.size_m[2] > place.surface.clearance_m + TALLER_M)
        return tight, overhang_m(place.surface, base) + abs(place.surface.level - float(base[2]))

    place = min(options, key=far)
    target = nearest_point(place.surface, base)
    target = target + (place.surface.level - float(place.surface.normal @ target)) * place.surface.normal
    return edits.move(scene, object_id, item.pose.move(target - base))


def _box_top(item: SceneObject) -> SupportTarget:
    corners = item.corners_world
    top = corners[corners[:, 2] > corners[:, 2].max() - 0.01]
    up = np.array([0.0, 0.0, 1.0])
    outline = convex_outline(np.column_stack([top[:, :2], np.full(len(top), corners[:, 2].max())]), up)
    return SupportTarget(RestingSurface.of(outline, up, float("inf"), of_plane=False), item.id, of_object=True)


def nearest_point(surface: RestingSurface, point: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """The point of a surface nearest to a point above or beside it (a few projections: outlines are convex)."""
    place = np.array(point, dtype=np.float64)
    for _ in range(12):
        over = surface.outward @ place - surface.offset
        worst = int(np.argmax(over))
        if over[worst] <= 0:
            break
        place = place - (over[worst] + 1e-6) * surface.outward[worst]
    return place


def _hang(item: SceneObject, surface: RestingSurface) -> Pose:
    """An object flat against a wall (its back to it) or below a ceiling, as near as possible."""
    n = surface.normal
    if abs(float(n[2])) > UPWARD:
        R, reach = item.pose.R_world_object, float(item.size_m[2]) / 2
    else:
        R, reach = yaw_rotation(float(np.arctan2(n[1], n[0]))), float(item.size_m[0]) / 2
    position = nearest_point(surface, item.pose.position)
    position = position + (surface.level + reach - float(n @ position)) * n
    return Pose(R, position, item.pose.scale)


def against_wall(scene: Scene, object_id: str, wall: Plane) -> Scene:
    """The object turned with its back to a wall and pushed against it, its load along with it."""
    return edits.move(scene, object_id, wall_pose(scene.object(object_id), plane_surface(wall)))


def wall_pose(item: SceneObject, wall: RestingSurface) -> Pose:
    """The pose with its back flat against a wall, at the same height."""
    n = wall.normal
    R = yaw_rotation(float(np.arctan2(n[1], n[0])))
    gap = float(n @ item.pose.position) - wall.level - item.size_m[0] / 2
    flat = n * (1.0, 1.0, 0.0)
    return Pose(R, item.pose.position - gap * flat / max(float(flat @ n), 1e-6), item.pose.scale)


def to_wall(item: SceneObject, walls: Iterable[RestingSurface]) -> Pose:
    """The pose pulled flush to a wall right behind it; unchanged when there is none."""
    for wall in walls:
        n = wall.normal
        turn = item.pose.yaw_rad - np.arctan2(n[1], n[0])
        if abs(np.arctan2(np.sin(turn), np.cos(turn))) > WALL_MAGNET_RAD:
            continue
        gap = float(n @ item.pose.position) - wall.level - item.size_m[0] / 2
        if abs(gap) <= WALL_MAGNET_M and overhang_m(wall, item.pose.position) <= 0.0:
            return wall_pose(item, wall)
    return item.pose


def insertion(scene: Scene, shape: Shape, object_id: str, hit: Hit, yaw_rad: float) -> tuple[SceneObject, Support]:
    """A shape put where a ray met a place: standing on it, or hung with its back to it.

    Args:
        scene: as it is.
        shape: of the library.
        object_id: of the new object.
        hit: where the ray met a place.
        yaw_rad: heading, 0 along +X.
    """
    n = hit.place.surface.normal
    item = SceneObject(
        object_id, shape.category, shape.category, shape.id, shape.size_m, Pose.upright(hit.point, yaw_rad)
    )
    if hit.place.upward:
        pose = Pose.upright(hit.point + np.array([0.0, 0.0, shape.size_m[2] / 2]), yaw_rad)
    else:
        pose = _hang(replace(item, pose=Pose.upright(hit.point + n * 0.01, yaw_rad)), hit.place.surface)
        if scene.has_plane(hit.place.parent):
            pose = clamp_to_wall(replace(item, pose=pose), scene.plane(hit.place.parent))
    return replace(item, pose=pose), hit.place.edge(object_id)


def clamp_to_wall(item: SceneObject, wall: Plane) -> Pose:
    """The pose of what hangs on a wall, inside the wall's height; doors stand at its foot. Ceilings change nothing."""
    if abs(float(wall.normal[2])) > UPWARD:
        return item.pose
    low, high = (float(e) for e in (wall.polygon[:, 2].min(), wall.polygon[:, 2].max()))
    half, z = float(item.size_m[2]) / 2, float(item.pose.position[2])
    level = low + half if item.category == DOOR or high - low < 2 * half else float(np.clip(z, low + half, high - half))
    return item.pose.move((0.0, 0.0, level - z))


def spot_in_view(
    scene: Scene, shape: Shape, eye: Float[np.ndarray, "3"], ahead: Float[np.ndarray, "3"], *, on_ceiling: bool
) -> Hit | None:
    """Where something that hangs is meant when only a view is given: the wall or ceiling in the middle of it.

    Things on walls hang at eye height. Where the view meets no such plane, the widest one that faces the eye is taken.

    Args:
        scene: the room.
        shape: what is hung.
        eye: where one looks from.
        ahead: direction of the view.
        on_ceiling: whether it hangs from the ceiling rather than on a wall.
    """
    all_planes = scene.architecture.by_role("ceiling" if on_ceiling else "wall")
    planes = [p for p in all_planes if float(p.normal @ ahead) < 0] or list(all_planes)
    if not planes:
        return None
    places = [SupportTarget(plane_surface(p), p.id, of_object=False) for p in planes]
    hits = hits_along(eye, ahead, places)
    if hits:
        place, point = hits[0].place, hits[0].point
    else:
        place = max(zip(places, planes, strict=True), key=lambda pair: _width(pair[1]))[0]
        point = scene.plane(place.parent).centre
    if not on_ceiling:
        foot = float(scene.plane(place.parent).polygon[:, 2].min())
        point = np.array([point[0], point[1], foot + max(HANGING_HEIGHT_M, shape.size_m[2] / 2)])
    return Hit(place, nearest_point(place.surface, point), float(np.linalg.norm(point - eye)))


def _width(plane: Plane) -> float:
    return float(np.ptp(plane.polygon[:, :2], axis=0).max())


FARTHEST_M = 5.0
"""A free place is looked for so far around the place in view."""


def free_spot(scene: Scene, shape: Shape, target_point: Float[np.ndarray, "3"] | None) -> tuple[float, float]:
    """The place on the floor nearest to where the person looks that no other footprint covers."""
    floor = scene.architecture.floor
    middle = np.zeros(2) if floor is None else floor.centre[:2]
    wanted = middle if target_point is None else np.asarray(target_point[:2], dtype=np.float64)
    radius = max(shape.size_m[:2]) / 2
    low, high = np.full(2, -np.inf), np.full(2, np.inf)
    if floor is not None:
        low, high = floor.polygon[:, :2].min(axis=0) + radius, floor.polygon[:, :2].max(axis=0) - radius
        wanted = np.where(low < high, np.clip(wanted, low, high), middle)
    taken = [(o.pose.position[:2], float(max(o.size_m[:2])) / 2) for o in scene.objects if o.category != "rug"]
    for reach in np.arange(0.0, FARTHEST_M, 0.25):
        for angle in np.arange(0.0, 2 * np.pi, np.pi / 6):
            spot = wanted + reach * np.array([np.cos(angle), np.sin(angle)])
            inside = reach == 0.0 or bool(((spot >= low) & (spot <= high)).all())
            if inside and all(np.linalg.norm(spot - place) > radius + other for place, other in taken):
                return float(spot[0]), float(spot[1])
    return float(wanted[0]), float(wanted[1])


def facing(scene: Scene, x: float, y: float) -> float:
    """A heading toward the photo's camera, in quarter turns."""
    if scene.camera is None:
        return -np.pi / 2
    toward = scene.camera.position[:2] - (x, y)
    return float(np.round(np.arctan2(toward[1], toward[0]) / (np.pi / 2)) * np.pi / 2)
