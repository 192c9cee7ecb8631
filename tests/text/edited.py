"""Furnished rooms that tests edit by words, and what must hold of them afterwards."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from diorama_core.editing.collisions import Collisions
from diorama_core.editing.footprints import footprint_of, lie_within
from diorama_core.editing.positioning import Positioner
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.schema import scene_from_json
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Scene
from diorama_core.synthesis.grammar import furnish_room
from diorama_core.text.edit_apply import EditApplier
from diorama_core.text.edit_plan import Edit


@cache
def living_room() -> Scene:
    """Sofa, coffee table, side table, sideboard with a lamp and books, piano, plant, rug, four pictures.

    It is on disk, since rooms are furnished otherwise when shapes come to the library.
    """
    return scene_from_json((Path(__file__).parent / "living_room.json").read_bytes())


@cache
def dining_room() -> Scene:
    return furnish_room(2, "dining", built_in_library(), outline="box", clutter=6)


def done(scene: Scene, *asked: Edit) -> Scene:
    applier = EditApplier(Positioner(built_in_library()))
    for edit in asked:
        scene = applier.apply(scene, edit).scene
    check_scene(scene)
    return scene


def apart_m(scene: Scene, first: str, second: str) -> float:
    """From middle to middle, seen from above."""
    return float(np.linalg.norm((scene.object(first).pose.position - scene.object(second).pose.position)[:2]))


def turned_deg(after: Scene, before: Scene, object_id: str) -> float:
    turn = after.object(object_id).pose.yaw_rad - before.object(object_id).pose.yaw_rad
    return abs(float(np.degrees(np.arctan2(np.sin(turn), np.cos(turn)))))


def assert_sound(before: Scene, after: Scene) -> None:
    """What changed meets nothing that it did not meet before, and is inside the room."""
    changed = [o.id for o in after.objects if not before.has_object(o.id) or before.object(o.id) != o]
    collisions = Collisions(built_in_library())
    earlier = collisions.pairs(before, [o.id for o in before.objects])
    assert {frozenset(p) for p in collisions.pairs(after, changed)} <= {frozenset(p) for p in earlier}
    outline = RoomFrame.of(after).outline
    for object_id in changed:
        item = after.object(object_id)
        if item.category not in ("window", "door"):
            assert lie_within(footprint_of(item)[None], outline, 0.03)[0], object_id
        assert after.support_of(object_id) is not None
