"""The support graph against what was measured: edges that the observed gap contradicts, and what is there instead.

A graph says what is likely; the observed poses say how far an object is from what should hold it up or stand behind
it. Where that gap is larger than the observation's noise explains and another supporter fits, the edge is changed;
where an object does not stand against its wall, it need not.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.layout.behind_walls import NEVER_HANGS, UPRIGHT, before_wall
from diorama_core.arrangement.noise import ObservationNoise
from diorama_core.layout.on_walls import moved_to_wall
from diorama_core.arrangement.surfaces import (
    SMALLEST_CLEARANCE,
    Surface,
    carries_things,
    choose_surface,
    closes_cycle,
    is_wide_enough,
    label_of,
    misfit,
    outside_m,
    plane_surface,
    resting_cost,
    surfaces_below,
)
from diorama_core.library import taxonomy
from diorama_core.library.company import SELDOM_CARRIED, STACKED_ON, often_carried
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.types import Pose, Scene, SceneObject, Support

CLEARLY = 0.5
"""Another supporter is taken only where its gap is at most this share of the contradicted one."""
WALL_FACTOR = 2.0
"""Objects that belong on walls stay on theirs up to so many times the tolerance: the wall may be wrong as well."""
MEASURED_GAP = 0.25
"""Share of the tolerance beyond which a measured gap before a wall is one: what would close it is a move or a guess."""
MEASURED_PARALLEL = float(np.cos(np.deg2rad(8.0)))
"""What was measured turned farther from a wall touches it with an edge: it does not stand against it."""
_IN_WALLS = frozenset(OPENING_CATEGORIES)
"""From a photo alone it is surer that these are in a wall than how far away they are; measured doors may stand open."""
_WALKED_ON = taxonomy.having("rug")
"""What furniture stands on and is on the floor nevertheless."""
_SOMETIMES_HANGS = taxonomy.having("sometimes_hangs")
"""Of the kinds that are set down on things."""
SHORTEST_ON_PLACE = 0.3
"""An object that reaches down through the place on which it rests keeps at least this share of its height above it."""
UNUSUAL_M = 0.3
"""Objects that people put on surfaces hang on a wall only where nothing is below them: this is added to their gap.

Where distances are reasoned, it is added to the gap to what hardly ever carries their kind, too: a vase is on the
night stand beside the bed.
"""


def checked_supports(
    scene: Scene, library: ShapeLibrary, noise: ObservationNoise, *, shapes_clear: bool = True
) -> tuple[Scene, tuple[str, ...]]:
    """The scene with the edges that agree with the observed poses, and what was changed.

    Args:
        scene: as observed, before any layout.
        library: where shapes come from.
        noise: of the observed positions.
        shapes_clear: whether shapes leave their neighbours room: what is in furniture then rests on it.
    """
    reasons = []
    for item in scene.objects:
        edge = scene.support_of(item.id)
        if edge is None:
            continue
        hangs = edge.relation == "mounted on" and scene.has_plane(edge.parent)
        floor = scene.architecture.floor
        if hangs and item.category in NEVER_HANGS and floor is not None:
            reasons.append(f"support changed: {item.label} stands on the floor; nothing of its kind hangs")
            scene = edits.attach(scene, Support(item.id, floor.id))
            continue
        there = noise.measured and _gap(scene, library, item, edge) <= _tolerance(scene, item, edge, noise)
        wall = _wall_in_sight(scene, item, edge, noise) if hangs and not there else None
        # Where distances were measured, a wall that is farther from the object than its own is not the one it hangs on.
        if wall is not None and noise.measured:
            other = _gap(scene, library, item, replace(edge, parent=wall, adheres_to=()))
            wall = wall if other < _gap(scene, library, item, edge) else None
        if wall is not None:
            reasons.append(f"support changed: {item.label} was seen on another wall than its own")
            scene = edits.attach(scene, replace(edge, parent=wall, adheres_to=()))
            if not noise.measured:
                scene = moved_to_wall(scene, item, scene.plane(wall))
            continue
        if not noise.measured and floor is not None and edge.parent == floor.id:
            before = before_wall(scene, library, item, noise)
            if before is not None:
                scene, reason = before
                reasons.append(reason)
                continue
        if hangs and not noise.measured and item.category in _IN_WALLS:
            continue
        mount = taxonomy.resolve(item.category).category.mount
        portable = item.category in taxonomy.PORTABLE
        sits = noise.measured and (mount == "surface" or portable or (hangs and mount == "floor"))
        entered = _entered(scene, library, item, edge, sits=sits) if shapes_clear or sits else {}
        inside = max(entered.values(), default=0.0)
        better = _better(scene, library, item, edge, noise, inside, frozenset(entered) if sits else frozenset())
        if better is None and floor is not None and _belongs_on_floor(scene, library, item, edge, noise):
            better = Support(item.id, floor.id)
        if better is not None:
            gap = _gap(scene, library, item, edge)
            where = "in something that is on" if inside > 0.0 else f"{100 * gap:.0f} cm from"
            reasons.append(
                f"support changed: {item.label} is {where} {label_of(scene, edge.parent)} and rests on "
                f"{label_of(scene, better.parent)}"
            )
            scene = edits.attach(scene, better)
            if noise.measured and inside > 0.0:
                scene = _ending_on_place(scene, library, item, better)
        elif hangs and _is_set_down(item):
            reasons.append(
                f"please check: {item.label} hangs on {label_of(scene, edge.parent)}; nothing was seen below it"
            )
        elif (walls := _touched(scene, item, edge, noise)) != edge.adheres_to:
            scene = edits.attach(scene, replace(edge, adheres_to=walls))
    return scene, tuple(reasons)


def _place_reached_through(library: ShapeLibrary, item: SceneObject, other: SceneObject) -> Surface | None:
    """The lowest place of another object through which an upright object reaches down, and above which it fits."""
    heights = item.corners_world @ UP_WORLD
    low, high = float(heights.min()), float(heights.max())
    found = [
        place
        for place in surfaces_below(item, other, library.shape(other.shape_id), under=1.0)
        if low < place.level < high - SHORTEST_ON_PLACE * (high - low)
        and place.clearance_m >= SMALLEST_CLEARANCE * (high - place.level)
    ]
    upright = float(item.pose.R_world_object[2, 2]) >= UPRIGHT
    return min(found, key=lambda place: place.level) if found and upright else None


def _ending_on_place(scene: Scene, library: ShapeLibrary, item: SceneObject, edge: Support) -> Scene:
    """The scene with an object that reached down through a place ending there: its top was seen, its foot was not."""
    if not scene.has_object(edge.parent):
        return scene  # what stands on the floor or hangs on a wall reached through no place of furniture
    place = _place_reached_through(library, item, scene.object(edge.parent))
    if place is None:
        return scene
    candidates = tuple(replace(c, pose=_ending_at(c.pose, c.shape_size_m, place.level)) for c in item.candidates)
    ended = replace(item, pose=_ending_at(item.pose, item.shape_size_m, place.level), candidates=candidates)
    return replace(scene, objects=tuple(ended if o.id == item.id else o for o in scene.objects))


def _ending_at(pose: Pose, size_m: tuple[float, float, float], level_m: float) -> Pose:
    """A pose in which a shape that reached down through a height ends there; unchanged where little would be left."""
    height, centre = float(size_m[2] * pose.scale[2]), float(pose.position[2])
    share = (centre + 0.5 * height - level_m) / height
    if not SHORTEST_ON_PLACE <= share < 1.0:
        return pose
    higher = pose.position + 0.5 * (1.0 - share) * height * UP_WORLD
    return Pose(pose.R_world_object, higher, pose.scale * [1.0, 1.0, share])


def _wall_in_sight(scene: Scene, item: SceneObject, edge: Support, noise: ObservationNoise) -> str | None:
    """The wall that the line of sight through an object meets, where it passes its own wall by; else None."""
    own = scene.plane(edge.parent)
    if own.role != "wall" or scene.camera is None:
        return None
    eye, sight = scene.camera.position, item.pose.position - scene.camera.position
    met: list[tuple[float, str]] = []
    for wall in scene.architecture.by_role("wall"):
        closing = float(wall.normal @ sight)
        if not wall.seen or closing >= 0.0:
            continue
        share = (wall.offset - float(wall.normal @ eye)) / closing
        beside = outside_m(plane_surface(wall), eye + share * sight)
        if wall.id == own.id and beside <= 2.0 * noise.across_m:
            return None
        if share > 0.0 and beside == 0.0:
            met.append((share, wall.id))
    return min(met)[1] if met else None


def _belongs_on_floor(
    scene: Scene, library: ShapeLibrary, item: SceneObject, edge: Support, noise: ObservationNoise
) -> bool:
    """Whether the measured gap contradicts the edge of furniture on an object, or of a door: their feet are hidden."""
    on_object = scene.has_object(edge.parent) and edge.relation == "placed on" and item.category in NEVER_HANGS
    is_door = scene.has_plane(edge.parent) and edge.relation == "mounted on" and item.category == "door"
    return (on_object or is_door) and _gap(scene, library, item, edge) > _tolerance(scene, item, edge, noise)


def _is_set_down(item: SceneObject) -> bool:
    mount = taxonomy.resolve(item.category).category.mount
    return mount == "surface" and item.category not in _SOMETIMES_HANGS


def _better(
    scene: Scene,
    library: ShapeLibrary,
    item: SceneObject,
    edge: Support,
    noise: ObservationNoise,
    inside: float,
    entered: frozenset[str],
) -> Support | None:
    """The supporter that is there, where the measured gap contradicts the edge; None where it may stay.

    What lies on the same supporter right under the object is there, too: a tray under a bottle, but not one remote
    control under another that lies beside it. How far an object
    reaches down through the places of what it has entered says nothing: its foot was not seen. What may hang or stand
    stands where its measured foot is clearly nearer to a place than its back is to the wall.
    """
    gap = _gap(scene, library, item, edge) + inside
    unusual = _is_unusual(scene, item, edge)
    contradicted = gap > _tolerance(scene, item, edge, noise) or unusual
    options = []
    for other in _candidates(scene, library, item):
        odd = UNUSUAL_M * (_holds_nothing(scene, other) if noise.measured else _is_odd_company(scene, item, other))
        if other.parent == edge.parent or closes_cycle({s.child: s for s in scene.supports}, item.id, other.parent):
            continue
        cost, limit = _gap(scene, library, item, other) + odd, _tolerance(scene, item, other, noise)
        cost = min(cost, inside) if other.parent in entered else cost
        between = _is_between(scene, library, item, edge, other, noise)
        # Against a measured gap that is many times as large, a foot that is hidden does not count.
        reached = np.inf if noise.measured else max(limit, UNUSUAL_M * unusual)
        most = (
            min(CLEARLY * gap, reached)
            if contradicted or _may_stand(scene, library, item, edge, other, noise)
            else limit * between
        )
        if cost <= max(most, inside):
            options.append((cost, other.parent, other))
    return min(options, key=lambda option: option[:2])[2] if options else None


def _is_between(
    scene: Scene, library: ShapeLibrary, item: SceneObject, edge: Support, other: Support, noise: ObservationNoise
) -> bool:
    """Whether what an edge puts an object on lies on the object's supporter and, right under it, hardly higher.

    Measured, the lowest board of a shelf is such a place too, for what people set down.
    """
    beneath = scene.support_of(other.parent)
    if edge.relation != "placed on" or beneath is None or beneath.parent != edge.parent:
        return False
    limit = _tolerance(scene, item, other, noise)
    thin = _is_thin(scene, other.parent, limit)
    if noise.measured:
        return (thin or _is_set_down(item)) and _is_over(scene, library, item, other, limit)
    return thin and (carries_things(scene.object(other.parent)) or _is_over(scene, library, item, other))


def _may_stand(
    scene: Scene, library: ShapeLibrary, item: SceneObject, edge: Support, other: Support, noise: ObservationNoise
) -> bool:
    """Whether what hangs on a wall and may as well stand, as a clock, was measured over a place of furniture."""
    if not noise.measured or edge.relation != "mounted on" or item.category not in _SOMETIMES_HANGS:
        return False
    return scene.has_object(other.parent) and other.relation == "placed on" and _is_over(scene, library, item, other)


def _is_over(scene: Scene, library: ShapeLibrary, item: SceneObject, edge: Support, most_m: float = np.inf) -> bool:
    """Whether an object's middle is over the place on which an edge puts it: beside a thin thing it lies on another.

    A place higher than `most_m` above the lowest point of what it belongs to is not meant.
    """
    parent = scene.object(edge.parent)
    place = choose_surface(scene, item, edge, library.shape(parent.shape_id)).in_world(parent.pose)
    height = place.level - float((parent.corners_world @ UP_WORLD).min())
    return height <= most_m and outside_m(place, item.pose.position) == 0.0


def _is_thin(scene: Scene, object_id: str, limit_m: float) -> bool:
    return float(np.ptp(scene.object(object_id).corners_world @ UP_WORLD)) <= limit_m


def _candidates(scene: Scene, library: ShapeLibrary, item: SceneObject) -> list[Support]:
    """Usual supporters of a category: walls for mounted objects, the floor for furniture, else surfaces too."""
    mount = taxonomy.resolve(item.category).category.mount
    roles = {"wall": ("wall", "floor") if item.category == "door" else ("wall",), "ceiling": ("ceiling",)}
    usual = roles.get(mount, ("floor",))
    found = [
        Support(item.id, plane.id, "placed on" if plane.role == "floor" else "mounted on")
        for plane in scene.architecture.planes
        if plane.role in usual
    ]
    if mount in ("surface", "wall") or (mount == "floor" and item.category not in NEVER_HANGS):
        for other in scene.objects:
            if mount == "floor" and other.category in _WALKED_ON:
                continue
            edge, shape = Support(item.id, other.id), library.shape(other.shape_id)
            if surfaces_below(item, other, shape, under=1.0) and is_wide_enough(item, edge, other, shape):
                found.append(edge)
    return found


def _gap(scene: Scene, library: ShapeLibrary, item: SceneObject, edge: Support) -> float:
    """How badly the observed pose agrees with an edge, metres."""
    if scene.has_plane(edge.parent):
        plane = scene.plane(edge.parent)
        # How far the floor reaches is a guess where it was not seen; how high it is, is not.
        beside = outside_m(plane_surface(plane), item.pose.position) if plane.role == "floor" else 0.0
        return (
            resting_cost(scene, item, edge, plane_surface(plane)) - beside + UNUSUAL_M * _is_unusual(scene, item, edge)
        )
    parent = scene.object(edge.parent)
    surface = choose_surface(scene, item, edge, library.shape(parent.shape_id))
    world = surface.in_world(parent.pose)
    return resting_cost(scene, item, edge, world) if edge.relation == "mounted on" else misfit(item, world)


def _is_unusual(scene: Scene, item: SceneObject, edge: Support) -> bool:
    """Whether an edge hangs on a wall what people put on surfaces."""
    on_wall = scene.has_plane(edge.parent) and scene.plane(edge.parent).role == "wall"
    return on_wall and taxonomy.resolve(item.category).category.mount == "surface"


def _is_odd_company(scene: Scene, item: SceneObject, edge: Support) -> bool:
    """Whether an edge puts an object on what hardly ever carries its kind."""
    if not scene.has_object(edge.parent):
        return False
    seldom = often_carried(item.category, scene.object(edge.parent).category) <= SELDOM_CARRIED
    return seldom or _holds_nothing(scene, edge)


def _holds_nothing(scene: Scene, edge: Support) -> bool:
    """Whether an edge puts something on a thing that people put on others and nothing on: on the foot of a monitor."""
    if not scene.has_object(edge.parent):
        return False
    carrier = taxonomy.resolve(scene.object(edge.parent).category).category
    return carrier.mount == "surface" and not carrier.supports_objects and carrier.name not in STACKED_ON


def _entered(scene: Scene, library: ShapeLibrary, item: SceneObject, edge: Support, *, sits: bool) -> dict[str, float]:
    """Furniture in which an object was observed that stands on the floor, and how far it would have to go to be beside
    it, metres; for what people put on things, also where it hangs on a wall.
    """
    roles = ("floor", "wall") if sits else ("floor",)
    if not scene.has_plane(edge.parent) or scene.plane(edge.parent).role not in roles:
        return {}
    return {
        other.id: depth
        for other in scene.objects
        if other.category not in _WALKED_ON
        and (
            carries_things(other) and _place_reached_through(library, item, other) is not None
            if sits
            else bool(surfaces_below(item, other, library.shape(other.shape_id), under=1.0))
        )
        and is_wide_enough(item, Support(item.id, other.id), other, library.shape(other.shape_id))
        and (depth := _overlap_m(item, other)) > 0.0
    }


def _overlap_m(item: SceneObject, other: SceneObject) -> float:
    """Depth in plan by which an object's box is in another's, along the other's axes."""
    axes = other.pose.R_world_object[:, :2]
    reach = 0.5 * (np.abs(axes.T @ item.pose.R_world_object) @ item.size_m + other.size_m[:2])
    away = np.abs(axes.T @ (item.pose.position - other.pose.position))
    return max(float((reach - away).min()), 0.0)


def _tolerance(scene: Scene, item: SceneObject, edge: Support, noise: ObservationNoise) -> float:
    up = scene.plane(edge.parent).normal if scene.has_plane(edge.parent) else UP_WORLD
    hangs = taxonomy.resolve(item.category).category.mount == "wall" and edge.relation == "mounted on"
    return noise.tolerance_m(scene.camera, item.pose.position, up) * (WALL_FACTOR if hangs else 1.0)


def _touched(scene: Scene, item: SceneObject, edge: Support, noise: ObservationNoise) -> tuple[str, ...]:
    """The walls of an edge that the object stands against as far as was measured."""
    retained = []
    for wall_id in edge.adheres_to:
        if not scene.has_plane(wall_id):
            continue
        wall = scene.plane(wall_id)
        gap = abs(float((item.corners_world @ wall.normal).min()) - wall.offset)
        tolerance = noise.tolerance_m(scene.camera, item.pose.position, wall.normal)
        facing = float(np.abs(wall.normal @ item.pose.R_world_object).max())
        if noise.measured and facing < MEASURED_PARALLEL:
            continue
        if gap <= (MEASURED_GAP * tolerance if noise.measured else tolerance):
            retained.append(wall_id)
    return tuple(retained)
