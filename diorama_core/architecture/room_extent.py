"""Extends unseen floor and walls to contain the observed objects.

The extent of a floor or an unseen wall is assumed; the place of an object is observed. So assumptions yield to
objects, not objects to assumptions. Observed walls do not move; with measured depth, what has something behind it was
no observed wall.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import manifold3d
import numpy as np
from jaxtyping import Float

from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import DOOR
from diorama_core.geometry.planes import clip_polygon, is_in_polygon, signed_area
from diorama_core.library import taxonomy
from diorama_core.scene.room_edits import ceiling_height, move_plane, set_ceiling_height
from diorama_core.scene.types import Architecture, Plane, Scene, SceneObject, Support


@dataclass(frozen=True)
class RoomExtentSettings:
    """How far floor and walls are extended."""

    margin_m: float = 0.01
    """Left around what stands on the floor."""
    hold: float = 0.5
    """How much a wall's own place counts beside that of an object against it."""
    foot_hidden: float = 0.3
    """How much less certain the place of an object is whose foot the photo does not show."""
    longest_cord: float = 1.3
    """A lamp's cord makes it at most so many times as high as it was seen."""
    min_area_m2: float = 1e-4
    joined_m: float = 0.02
    behind_share: float = 0.1
    """What stands behind a wall with a smaller share of its footprint only touches it."""
    clearly_m: float = 0.05
    """What is measured so far behind a wall is behind it."""
    doubted: float = 0.3
    """Confidence of a wall behind which something was measured: it was not seen (`scene.types.SEEN_CONFIDENCE`)."""
    far_m: float = 100.0
    """Farther behind a wall than any room reaches."""


SETTINGS = RoomExtentSettings()


def containing_room(
    scene: Scene,
    *,
    objects_measured: bool = True,
    walls_reasoned: bool = False,
    feet_seen: Collection[str] | None = None,
) -> Scene:
    """The scene with unseen walls moved behind what stands on the floor, the floor drawn out under it, and a ceiling
    above what hangs.

    Args:
        scene: as observed.
        objects_measured: whether places of objects were measured: a wall before a measured one was not seen.
        walls_reasoned: whether walls were reasoned from a photo alone: they come to what stands against them.
        feet_seen: ids of the objects whose lower ends the photo shows; of all when None.
    """
    floor = scene.architecture.floor
    if floor is None:
        return scene
    if walls_reasoned:
        scene = _fit_walls_to_backs(scene, feet_seen, objects_measured)
        if objects_measured:
            scene = _without_far_adherence(scene)
    standing = [o for o in scene.objects if (edge := scene.support_of(o.id)) is not None and edge.parent == floor.id]
    if objects_measured:
        scene = _lower_wall_confidence(scene, standing)
    for wall in scene.architecture.by_role("wall"):
        if not wall.is_seen:
            against = _standing_against(scene, wall.id) if objects_measured else []
            scene = _move_wall_behind_objects(scene, wall.id, standing, against)
        scene = _lengthen_wall(scene, wall.id)
    prints = [p for o in standing if len(p := _footprint(scene, o)) >= 3]
    return _with_ceiling(_with_floor_under(scene, prints))


def without_floor_behind_walls(scene: Scene, known: Plane) -> Scene:
    """The scene without the floor that was drawn out behind seen walls under objects that are before them now.

    Args:
        scene: after its layout.
        known: the floor before it was drawn out.
    """
    floor = scene.architecture.floor
    if floor is None:
        return scene
    standing = [_box_footprint(o) for o in scene.objects if (s := scene.support_of(o.id)) and s.parent == floor.id]
    here = _section(floor.polygon[:, :2])
    added = here - _section(known.polygon[:, :2])
    trimmed = here
    for wall in scene.architecture.by_role("wall"):
        drawn = added ^ _area_behind_wall(wall)
        if wall.is_seen and not any((drawn ^ _section(p)).area() > SETTINGS.behind_share * _area(p) for p in standing):
            trimmed = trimmed - drawn
    if here.area() - trimmed.area() < SETTINGS.min_area_m2:
        return scene
    outline = max(trimmed.simplify(SETTINGS.margin_m).to_polygons(), key=signed_area)
    return _with_floor_outline(scene, floor, outline)


def _area_behind_wall(wall: Plane) -> manifold3d.CrossSection:
    """Part of the plan that a wall hides."""
    level = np.cross([0.0, 0.0, 1.0], wall.normal)
    along = wall.polygon @ level
    ends = [wall.offset * wall.normal + reach * level for reach in (float(along.min()), float(along.max()))]
    far = [end - SETTINGS.far_m * wall.normal for end in ends]
    corners = np.array([*ends, far[1], far[0]])[:, :2]
    return _section(corners if signed_area(corners) > 0.0 else corners[::-1])


def _with_ceiling(scene: Scene) -> Scene:
    """A ceiling that was not seen is where lamps hang from it: at the walls' top as far as the lamps reach there."""
    hanging = [o for o in scene.objects if taxonomy.resolve(o.category).category.mount == "ceiling"]
    floor, top_m = scene.architecture.floor, ceiling_height(scene)
    if not hanging or floor is None or top_m is None or scene.architecture.by_role("ceiling"):
        return scene
    ends = [(float(o.corners_world[:, 2].min()), float(o.corners_world[:, 2].max())) for o in hanging]
    ground = float(floor.centre[2])
    reached = min(low + SETTINGS.longest_cord * (high - low) for low, high in ends)
    level = max(min(ground + top_m, reached), max(high for _, high in ends))
    try:
        scene = replace(set_ceiling_height(scene, level - ground), objects=scene.objects)
    except EditRefused:
        return scene
    outline = floor.polygon[:, :2]
    corners = np.vstack([o.corners_world[:, :2] for o in hanging])
    if not is_in_polygon(corners, outline).all():
        points = manifold3d.CrossSection.hull_points(np.vstack([outline, corners]))
        outline = points.to_polygons()[0]
    polygon = np.column_stack([outline[::-1], np.full(len(outline), level)])
    ceiling = Plane("ceiling", "ceiling", polygon, confidence=0.0)
    edges = {o.id: Support(o.id, ceiling.id, "mounted on") for o in hanging}
    supports = (*(s for s in scene.supports if s.child not in edges), *edges.values())
    return replace(scene, architecture=Architecture((*scene.architecture.planes, ceiling)), supports=supports)


def _fit_walls_to_backs(scene: Scene, feet_seen: Collection[str] | None, objects_measured: bool) -> Scene:
    """Move walls to what stands against them: seen in a photo alone, walls are as uncertain as objects.

    Doors count, too: their feet, which were seen on the floor, are the wall's. What stands before a wall without
    touching it resists a wall that would come past its back. Each counts as much as its place is certain. What hangs on
    walls and what lies on furniture counts where its place was measured: otherwise it follows from walls and furniture.
    """
    floor = scene.architecture.floor
    walls = {p.id for p in scene.architecture.planes if p.role != "floor"}
    edges = [
        s
        for s in scene.supports
        if floor is not None and (s.parent not in walls if objects_measured else s.parent == floor.id)
    ]
    for wall in scene.architecture.by_role("wall"):
        against = [scene.object(s.child) for s in edges if wall.id in s.adheres_to]
        against += [o for o in _hanging(scene, wall.id) if objects_measured or o.category == DOOR]
        others = [scene.object(s.child) for s in edges if wall.id not in s.adheres_to]
        others = [item for item in others if _wall_gap_m(item, wall, np.inf) < np.inf]
        backs, certainty = _backs(against, wall, feet_seen)
        before, before_certainty = _backs(others, wall, feet_seen)
        tried = np.concatenate([[0.0], backs, before]) if objects_measured else np.concatenate([[0.0], backs])
        inward = _best_inward_shift(tried, backs, certainty, before, before_certainty)
        if abs(inward) < SETTINGS.margin_m:
            continue
        scene = _move_wall(scene, wall.id, SETTINGS.margin_m - inward)
    return scene


def _move_wall(scene: Scene, wall_id: str, outward_m: float) -> Scene:
    """The scene with a wall moved as far as that may be, and with objects where they were."""
    try:
        return replace(move_plane(scene, wall_id, outward_m), objects=scene.objects)
    except EditRefused:
        return scene


def _without_far_adherence(scene: Scene) -> Scene:
    """The scene without "against the wall" where an object was measured away from a wall that the photo shows."""

    def contact_walls(edge: Support) -> tuple[str, ...]:
        item = scene.object(edge.child)
        return tuple(w for w in edge.adheres_to if abs(_back(item, scene.plane(w))) < SETTINGS.clearly_m)

    return replace(scene, supports=tuple(replace(s, adheres_to=contact_walls(s)) for s in scene.supports))


def _backs(
    items: Sequence[SceneObject], wall: Plane, feet_seen: Collection[str] | None
) -> tuple[Float[np.ndarray, " a"], Float[np.ndarray, " a"]]:
    """Heights of objects' hindmost corners before a wall, and how certain the objects' places are."""
    hidden = [feet_seen is not None and o.id not in feet_seen for o in items]
    certainty = [o.confidence * (SETTINGS.foot_hidden if h else 1.0) for o, h in zip(items, hidden, strict=True)]
    return np.array([_back(o, wall) for o in items]), np.array(certainty)


def _back(item: SceneObject, wall: Plane) -> float:
    """Height of an object's hindmost corner before a wall."""
    return float((item.corners_world @ wall.normal).min()) - wall.offset


def _best_inward_shift(
    tried: Float[np.ndarray, " t"],
    backs: Float[np.ndarray, " a"],
    certainty: Float[np.ndarray, " a"],
    others: Float[np.ndarray, " b"],
    others_certainty: Float[np.ndarray, " b"],
) -> float:
    """How far inward, of what is tried, a wall agrees best with the backs of what stands against it and before it."""
    apart = np.abs(tried[:, None] - backs) @ certainty
    past = np.maximum(tried[:, None] - others, 0.0) @ others_certainty
    return float(tried[np.argmin(apart + past + SETTINGS.hold * np.abs(tried))])


def _lower_wall_confidence(scene: Scene, standing: Sequence[SceneObject]) -> Scene:
    """The scene with walls as guesses behind which the middle of something that stands on the floor was measured.

    The front of furniture that nobody marked was taken for such a wall, or it ends before the object.
    """
    for wall in scene.architecture.by_role("wall"):
        behind = [o for o in standing if float(o.pose.position @ wall.normal) - wall.offset < -SETTINGS.clearly_m]
        if wall.is_seen and any(_is_between_ends(o, wall) for o in behind):
            scene = _with_plane(scene, replace(wall, confidence=SETTINGS.doubted))
    return scene


def _with_plane(scene: Scene, plane: Plane) -> Scene:
    """The scene with another plane in place of the one of its id."""
    planes = tuple(plane if p.id == plane.id else p for p in scene.architecture.planes)
    return replace(scene, architecture=Architecture(planes))


def _is_between_ends(item: SceneObject, wall: Plane) -> bool:
    """Whether an object's middle is before or behind a wall, rather than beside it."""
    along = np.cross([0.0, 0.0, 1.0], wall.normal)
    spread = wall.polygon @ along
    return bool(spread.min() < float(item.pose.position @ along) < spread.max())


def _move_wall_behind_objects(
    scene: Scene, wall_id: str, standing: Sequence[SceneObject], against: Sequence[SceneObject]
) -> Scene:
    """The wall at the backs of what is on it, behind everything whose middle is in front of it; objects stay.

    Args:
        scene: with the wall, which was not seen.
        wall_id: of the wall.
        standing: everything on the floor.
        against: of that what surely stands against the wall.
    """
    wall = scene.plane(wall_id)
    # Of what was seen, something touches the wall: it says where the wall is, within the room that it leaves.
    backs = [_back(o, wall) for o in (*_hanging(scene, wall_id), *against)]
    inward = float(np.median(backs)) if backs else 0.0
    deepest = min((_wall_gap_m(o, wall, inward) for o in standing), default=inward)
    if inward == 0.0 and deepest == inward:
        return scene
    return _move_wall(scene, wall_id, SETTINGS.margin_m - deepest if deepest < inward else -inward)


def _hanging(scene: Scene, wall_id: str) -> list[SceneObject]:
    return [scene.object(s.child) for s in scene.supports if s.parent == wall_id and s.relation == "mounted on"]


def _standing_against(scene: Scene, wall_id: str) -> list[SceneObject]:
    return [scene.object(s.child) for s in scene.supports if wall_id in s.adheres_to]


def _lengthen_wall(scene: Scene, wall_id: str) -> Scene:
    """The wall long enough for what hangs on it: an end is known only where it meets another wall that was seen."""
    wall = scene.plane(wall_id)
    hanging = _hanging(scene, wall_id)
    if not hanging:
        return scene
    level = np.cross([0.0, 0.0, 1.0], wall.normal)
    along = wall.polygon @ level
    needed = np.concatenate([o.corners_world @ level for o in hanging])
    polygon = wall.polygon.copy()
    seen = [other for other in scene.architecture.by_role("wall") if other.is_seen]
    for end, reach in (
        (along.min(), needed.min() - SETTINGS.margin_m),
        (along.max(), needed.max() + SETTINGS.margin_m),
    ):
        at_end = np.abs(along - end) < SETTINGS.joined_m
        beyond = (reach - end) * np.sign(end - along.mean())
        if beyond > 0.0 and not _meets_a_wall(wall, wall.polygon[at_end], seen):
            polygon[at_end] += (reach - end) * level
    return scene if np.array_equal(polygon, wall.polygon) else _with_plane(scene, replace(wall, polygon=polygon))


def _wall_gap_m(item: SceneObject, wall: Plane, inward_m: float = 0.0) -> float:
    """Distance of an object's hindmost corner before a wall, at most and by default `inward_m`.

    The default is given for objects beside the wall or behind it.
    """
    if not _is_between_ends(item, wall) or float(item.pose.position @ wall.normal) < wall.offset:
        return inward_m
    return min(_back(item, wall), inward_m)


def _footprint(scene: Scene, item: SceneObject) -> Float[np.ndarray, "k 2"]:
    """What an object covers of the floor before the walls that were seen, counter-clockwise in plan."""
    polygon = np.column_stack([_box_footprint(item), np.zeros(4)])
    for wall in scene.architecture.by_role("wall"):
        if wall.is_seen and _wall_gap_m(item, wall) < 0.0:
            polygon = clip_polygon(polygon, wall.normal * [1.0, 1.0, 0.0], wall.offset)
    return polygon[:, :2]


def _box_footprint(item: SceneObject) -> Float[np.ndarray, "4 2"]:
    half = item.size_m / 2 + SETTINGS.margin_m
    signs = np.array([[1, 1, -1], [-1, 1, -1], [-1, -1, -1], [1, -1, -1]])
    return np.asarray(item.pose.position + (signs * half) @ item.pose.R_world_object.T)[:, :2]


def _with_floor_under(scene: Scene, prints: list[Float[np.ndarray, "_ 2"]]) -> Scene:
    floor = scene.architecture.floor
    assert floor is not None
    here = _section(floor.polygon[:, :2])
    missing = [p for p in prints if _area(p) - (_section(p) ^ here).area() > SETTINGS.min_area_m2]
    if not missing:
        return scene
    union = manifold3d.CrossSection.batch_boolean([here, *map(_section, missing)], manifold3d.OpType.Add)
    outer = [o for o in union.to_polygons() if signed_area(o) > 0]
    # Footprints away from the floor are reached by the hull of both.
    outline = outer[0] if len(outer) == 1 else union.hull().to_polygons()[0]
    return _with_floor_outline(scene, floor, outline)


def _with_floor_outline(scene: Scene, floor: Plane, outline: Float[np.ndarray, "k 2"]) -> Scene:
    polygon = np.column_stack([outline, np.full(len(outline), float(floor.centre[2]))])
    return _with_plane(scene, replace(floor, polygon=polygon))


def _section(polygon: Float[np.ndarray, "k 2"]) -> manifold3d.CrossSection:
    return manifold3d.CrossSection([polygon], manifold3d.FillRule.NonZero)


def _area(polygon: Float[np.ndarray, "k 2"]) -> float:
    return abs(signed_area(polygon))


def _meets_a_wall(wall: Plane, corners: Float[np.ndarray, "k 3"], walls: Sequence[Plane]) -> bool:
    """Whether all of some corners of a wall are at corners of another one."""
    others = [other.polygon for other in walls if other.id != wall.id]
    away = [np.linalg.norm(polygon[:, None] - corners[None], axis=2).min(axis=0) for polygon in others]
    return any(bool((distance < SETTINGS.joined_m).all()) for distance in away)
