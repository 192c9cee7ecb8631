"""Edits that move objects: to where they are wished, by lengths and angles, larger and smaller; all stay free."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diorama_core.editing.footprints import footprint_of, lie_within
from diorama_core.editing.placing import seat
from diorama_core.editing.positioning import Positioner
from diorama_core.editing.relations import OF_ROOM, Relation, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.errors import EditRefused
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.library.taxonomy import broad, category
from diorama_core.scene import edits
from diorama_core.scene.support import ancestors, descendants
from diorama_core.scene.types import Scene, Support, yaw_rotation
from diorama_core.text.edit_plan import Done, Move, Place, Resize, Shift, Side, Turn, names_of
from diorama_core.text.edit_room import direction_of, off_wall, wall_on

SHARES = (1.0, 0.8, 0.6, 0.4, 0.2)
"""Shares of a way, tried in turn until it is free."""
MIN_HUNG_SHARE = 0.3
"""What hangs is not made shorter than this share of itself."""


def relations_of(scene: Scene, places: Sequence[Place], moved_ids: Sequence[str] = ()) -> list[Relation]:
    """The relations that hold at places.

    Raises:
        EditRefused: a place names no object, or one that is to go there itself, or a wall that the room has not.
    """
    relations = []
    for place in places:
        targets = tuple(place.targets)
        if not targets and place.relation not in OF_ROOM and not moved_ids:
            raise EditRefused(f"“{place.relation}” what? Name the object")
        if set(targets) & set(moved_ids):
            raise EditRefused(f"{scene.object(targets[0]).label} cannot be {place.relation} itself")
        toward = _side_direction(scene, place.side, moved_ids)
        if place.relation == "against wall" and place.side not in ("", "other"):
            wall_on(scene, place.side)
        relations.append(Relation(place.relation, targets, toward=toward, side=place.side))
    return relations


def _side_direction(scene: Scene, side: Side, moved_ids: Sequence[str]) -> tuple[float, float] | None:
    """The direction of a side of the room; "other" is away from where the first object is."""
    if not side or (side == "other" and not moved_ids):
        return None
    if side == "other":
        way = RoomFrame.of(scene).middle - scene.object(moved_ids[0]).pose.position[:2]
    else:
        way = direction_of(scene, side)
    return float(way[0]), float(way[1])


def move(positioner: Positioner, scene: Scene, edit: Move) -> Done:
    """Objects at the best free places where relations hold."""
    ids, relations = edit.objects, relations_of(scene, edit.places, edit.objects)
    if not relations:
        raise EditRefused(f"where to should {names_of(scene, ids)} go?")
    after, missed = scene, []
    for object_id in ids:
        item = after.object(object_id)
        if item.locked:
            raise EditRefused(f"{item.label} is locked; unlock it first")
        others = tuple(i for i in ids if i != object_id)
        placing = [r if r.kind in OF_ROOM else replace(r, targets=r.targets or others) for r in relations]
        spot = positioner.best(after, item, placing, near=item.pose.position)
        if spot is None:
            raise EditRefused(f"there is no free place for {item.label} {placing[0].words(after)}")
        after = positioner.put(after, item, spot)
        after = lift_onto(after, item.id)
        frame = RoomFrame.of(after)
        of_room = next((r for r in placing if r.side and not is_met(after, object_id, r, frame)), None)
        if of_room is not None:
            raise EditRefused(f"there is no free place for {item.label} {of_room.words(scene)}")
        missed += unmet_notes(after, object_id, placing)
    where = " and ".join(r.words(scene) for r in relations)
    return Done(after, (f"move {names_of(scene, ids)} {where}",), tuple(ids), tuple(missed))


def shift(positioner: Positioner, scene: Scene, edit: Shift) -> Done:
    """Objects moved by lengths: as seen in the photo, up and down what they hang on, or toward an object."""
    if not (edit.right_m or edit.away_m or edit.up_m or edit.off_wall_m or (edit.toward and edit.toward_m)):
        raise EditRefused(f"which way should {names_of(scene, edit.objects)} go?")
    # What stands on these goes with them.
    ids = [i for i in edit.objects if not set(edit.objects) & set(ancestors(scene, i))]
    after, notes = _as_far_as_free(positioner, scene, ids, edit)
    for object_id in ids:
        after, note = free(positioner, after, object_id)
        if edit.up_m and not _is_within_heights(after, object_id):
            raise EditRefused(f"{scene.object(object_id).label} would leave its wall; move it by less")
        if _off_its_support(after, object_id):
            raise EditRefused(f"{after.object(object_id).label} would fall off what it stands on; move it by less")
        notes += note
    goal = scene.object(edit.toward).label if edit.toward else ""
    ways = (
        (edit.right_m, "to the right", "to the left"),
        (edit.away_m, "back", "forward"),
        (edit.up_m, "up", "down"),
        (edit.off_wall_m, "away from the wall", "toward the wall"),
        (edit.toward_m if edit.toward else 0.0, f"toward {goal}", f"away from {goal}"),
    )
    distances = " and ".join(f"{abs(m):.3g} m {plus if m > 0 else minus}" for m, plus, minus in ways if m)
    return Done(after, (f"move {names_of(scene, ids)} {distances}",), tuple(ids), tuple(notes))


def _as_far_as_free(positioner: Positioner, scene: Scene, ids: Sequence[str], edit: Shift) -> tuple[Scene, list[str]]:
    """Objects moved together: by less where the whole way is not free, all of it where none of it is."""
    whole = _shift_by(scene, ids, edit, 1.0)
    if edit.up_m:
        return whole
    moved_ids = [d for i in ids for d in (i, *descendants(scene, i))]
    for share in SHARES:
        after, notes = whole if share == 1.0 else _shift_by(scene, ids, edit, share)
        if not positioner.collisions.pairs(after, moved_ids) and all(positioner.is_inside(after, i) for i in ids):
            short = [] if share == 1.0 else [f"{names_of(scene, ids)}: only {share:.0%} of the way is free"]
            return after, [*notes, *short]
    return whole


def _shift_by(scene: Scene, ids: Sequence[str], edit: Shift, share: float) -> tuple[Scene, list[str]]:
    step = share * (edit.right_m * direction_of(scene, "right") + edit.away_m * direction_of(scene, "back"))
    after, notes = scene, list[str]()
    for object_id in ids:
        item, shift_m = scene.object(object_id), step
        edge = after.support_of(object_id)
        if edit.up_m and (edge is None or edge.relation != "mounted on"):
            raise EditRefused(f"{item.label} stands and does not hang; only what hangs can go up or down")
        if edit.toward:
            ahead = after.object(edit.toward).pose.position[:2] - item.pose.position[:2]
            shift_m = step + share * edit.toward_m * ahead / max(float(np.linalg.norm(ahead)), 1e-6)
        if edit.off_wall_m:
            shift_m = shift_m + share * edit.off_wall_m * off_wall(after, object_id)
        under_ceiling = edge is not None and any(p.id == edge.parent for p in scene.architecture.by_role("ceiling"))
        after = edits.move(
            after, object_id, item.pose.move((shift_m[0], shift_m[1], 0.0 if under_ceiling else edit.up_m))
        )
        if edit.up_m and under_ceiling:
            after, note = _hang_lower(after, object_id, -edit.up_m)
            notes += note
    return after, notes


def _hang_lower(scene: Scene, object_id: str, by_m: float) -> tuple[Scene, list[str]]:
    """What hangs from the ceiling reaches lower or less low; it stays fixed to the ceiling."""
    item = scene.object(object_id)
    height = float(item.size_m[2]) + by_m
    if height < MIN_HUNG_SHARE * float(item.size_m[2]):
        raise EditRefused(f"{item.label} is {float(item.size_m[2]):.2f} m tall and hangs at the ceiling already")
    after = edits.resize(scene, object_id, np.array([*item.size_m[:2], height]))
    grown = after.object(object_id).pose  # on its foot; its top is to stay where it was
    after = edits.move(after, object_id, grown.move((0.0, 0.0, -by_m)))
    return after, [f"{item.label} is {height:.2f} m tall now; it hangs at the ceiling as before"]


def turn(positioner: Positioner, scene: Scene, edit: Turn) -> Done:
    """Objects turned where they are, by an angle or toward an object."""
    ids, toward = edit.objects, edit.toward
    if not toward and not edit.degrees:
        raise EditRefused(f"which way should {names_of(scene, ids)} turn?")
    after, notes = scene, []
    for object_id in ids:
        pose = after.object(object_id).pose
        if toward:
            away = after.object(toward).pose.position[:2] - pose.position[:2]
            angle = float(np.arctan2(away[1], away[0])) - pose.yaw_rad
        else:
            angle = float(np.radians(edit.degrees))
        pose = replace(pose, R_world_object=yaw_rotation(angle) @ pose.R_world_object)
        after = edits.move(after, object_id, pose)
        after, note = free(positioner, after, object_id)
        notes += note
    if toward:
        how = f"to {scene.object(toward).label}"
    else:
        side = "" if abs(edit.degrees) == 180 else " to the left" if edit.degrees > 0 else " to the right"
        how = f"by {abs(edit.degrees):g} degrees{side}"
    return Done(after, (f"turn {names_of(scene, ids)} {how}",), tuple(ids), tuple(notes))


def resize(positioner: Positioner, scene: Scene, edit: Resize) -> Done:
    """Objects larger or smaller, standing on what they stood on."""
    ids, factor = edit.objects, edit.factor
    after, notes = scene, []
    for object_id in ids:
        item, edge = after.object(object_id), scene.support_of(object_id)
        hangs = edge is not None and edge.relation == "mounted on"
        rise = 0.0 if hangs else float(item.size_m[2]) * (factor - 1.0) / 2
        after = edits.move(after, object_id, replace(item.pose.move((0.0, 0.0, rise)), scale=item.pose.scale * factor))
        for child in scene.children_of(object_id):
            after = seat(after, positioner.library, child)
        if not hangs:
            after, note = free(positioner, after, object_id)
            notes += note
    how = "larger" if factor > 1 else "smaller"
    return Done(after, (f"make {names_of(scene, ids)} {factor:.0%} of its size ({how})",), tuple(ids), tuple(notes))


def free(positioner: Positioner, scene: Scene, object_id: str) -> tuple[Scene, list[str]]:
    """An object that turned or grew into another steps aside, with the same heading."""
    item, moved_ids = scene.object(object_id), [object_id, *descendants(scene, object_id)]
    if not positioner.collisions.pairs(scene, moved_ids) and positioner.is_inside(scene, object_id):
        return scene, []
    spot = positioner.nearby(scene, object_id)
    if spot is None:
        raise EditRefused(f"{item.label} has no free space to do that; move it away from other objects first")
    return edits.move(scene, object_id, spot.pose), [f"{item.label} steps aside to stay free"]


def unmet_notes(scene: Scene, object_id: str, relations: Sequence[Relation]) -> list[str]:
    """The relations that a placed object does not meet, in words."""
    frame = RoomFrame.of(scene)
    label = scene.object(object_id).label
    return [
        f"{label} does not fit {r.words(scene)}; it is placed as near as possible"
        for r in relations
        if not is_met(scene, object_id, r, frame)
    ]


def lift_onto(scene: Scene, rug_id: str) -> Scene:
    """What stands wholly on a new rug is raised onto it; what reaches over its rim stays on the floor."""
    rug = scene.object(rug_id)
    if broad(rug.category) != "rug":
        return scene
    quad, top = footprint_of(rug), float(rug.corners_world[:, 2].max())
    edge = scene.support_of(rug_id)
    for item in scene.objects:
        below = scene.support_of(item.id)
        if item.id == rug_id or below is None or edge is None or below.parent != edge.parent:
            continue
        if category(item.category).mount == "wall" or broad(item.category) == "rug":
            continue
        if bool(lie_within(footprint_of(item)[None], quad)[0]):
            rise = top - float(item.corners_world[:, 2].min())
            scene = edits.move(scene, item.id, item.pose.move((0.0, 0.0, rise)))
            scene = edits.attach(scene, Support(item.id, rug_id))
    return scene


def _is_within_heights(scene: Scene, object_id: str) -> bool:
    """True for an object between the floor and the top of the walls."""
    heights = scene.object(object_id).corners_world[:, 2]
    planes = [p.polygon[:, 2] for p in scene.architecture.planes if p.role in ("floor", "wall")]
    if not planes:
        return True
    within_m = np.concatenate(planes)
    return bool(heights.min() >= within_m.min() and heights.max() <= within_m.max())


def _off_its_support(scene: Scene, object_id: str) -> bool:
    """Whether the middle of an object is no longer over the furniture that holds it up."""
    edge = scene.support_of(object_id)
    if edge is None or not scene.has_object(edge.parent) or broad(scene.object(edge.parent).category) == "rug":
        return False
    place = scene.object(object_id).pose.position[None, :2]
    return not bool(is_in_polygon(place, footprint_of(scene.object(edge.parent)))[0])
