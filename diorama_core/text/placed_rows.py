"""Rows of objects in a room: one block is placed like one large object, and its members stand in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from diorama_core.editing.positioning import Positioner
from diorama_core.editing.relations import OF_ROOM, Relation, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.record import Shape
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene, SceneObject
from diorama_core.text.prompt import RequestedObject, Wish
from diorama_core.text.requested_relations import targets_of, usual_relations
from diorama_core.text.rows import Rows


@dataclass(frozen=True, eq=False)
class PlacedRows:
    """Rows that stand in a scene."""

    scene: Scene
    ids: tuple[str, ...]
    """Ids of the objects, row by row."""
    block: SceneObject
    """All of them as one object, which is not in the scene."""
    wishes: tuple[Wish, ...]
    """For the rows as a whole; how they stand to one another is what rows are."""

    def unmet(self, scene: Scene) -> list[tuple[Wish, Relation]]:
        """Wishes that the rows as a whole do not meet in a scene."""
        others = replace(scene, objects=tuple(o for o in scene.objects if o.id not in self.ids))
        whole, frame = replace(others, objects=(*others.objects, self.block)), RoomFrame.of(scene)
        return [(w, r) for w, r in _relations(others, self.wishes) if not is_met(whole, self.block.id, r, frame)]


def rows_of(request: RequestedObject, shape: Shape) -> Rows:
    """How the objects of a request stand in their rows."""
    facing = [w for w in request.wishes if w.kind in ("facing", "opposite")]
    face_to_face = request.rows == 2 and any(w.each_other for w in facing)
    watching = any(not w.each_other for w in facing)
    return Rows(request.count, request.rows, request.category, np.asarray(shape.size_m), face_to_face, watching)


def place_rows(
    scene: Scene,
    request: RequestedObject,
    shapes: Sequence[Shape],
    positioner: Positioner,
    others: Mapping[str, Sequence[Relation]],
) -> PlacedRows | None:
    """The scene with all objects of a request in rows; None where no shape's rows have room.

    Args:
        scene: without them.
        request: with its number of rows.
        shapes: tried in turn; all objects get one.
        positioner: of the scene's library.
        others: wishes of objects that are there.
    """
    wishes = tuple(w for w in request.wishes if not w.each_other)
    relations = [r for _, r in _relations(scene, wishes)]
    usual = [Relation("in middle")] if request.rows > 1 else usual_relations(scene, request, 0)
    middle = np.array([*RoomFrame.of(scene).middle, 0.0]) if request.rows > 1 else None
    for shape in shapes:
        rows = rows_of(request, shape)
        size = (float(shape.size_m[0]), float(shape.size_m[1]), float(shape.size_m[2]))
        one = SceneObject(
            f"rows of {request.category}", "", request.category, shape.id, size, Pose.upright(np.zeros(3))
        )
        block = rows.as_one(one)
        spot = positioner.best(scene, block, relations, usual=usual, others=others, near=middle)
        if spot is None:
            continue
        filled, ids = scene, list[str]()
        for pose in rows.poses(spot.pose, one.pose.scale):
            number = sum(o.category == shape.category for o in filled.objects) + 1
            ids.append(edits.fresh_id(filled, request.category))
            member = replace(one, id=ids[-1], label=f"{shape.category} {number}", category=shape.category, pose=pose)
            support = None if spot.support is None else replace(spot.support, child=member.id)
            filled = edits.insert(filled, member, support)
        free = not positioner.collisions.pairs(filled, ids) and all(positioner.is_inside(filled, i) for i in ids)
        if free:
            return PlacedRows(
                filled, tuple(ids), replace(block, pose=replace(spot.pose, scale=block.pose.scale)), wishes
            )
    return None


def _relations(scene: Scene, wishes: Sequence[Wish]) -> list[tuple[Wish, Relation]]:
    """Wishes with ids in the place of categories."""
    named = [(w, Relation(w.kind) if w.kind in OF_ROOM else Relation(w.kind, targets_of(scene, w, 0))) for w in wishes]
    return [(w, r) for w, r in named if r.targets or w.kind in OF_ROOM]
