from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.opening_insertion import with_opening
from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from tests.text.test_edit_room import living_room


def test_openings_of_one_wall_stand_beside_one_another_until_it_is_full() -> None:
    library, scene, made = built_in_library(), living_room(), []
    middle = scene.plane("wall_3").polygon[:, :2].mean(axis=0)
    wall_3 = scene.plane("wall_3").polygon[:, :2]
    for category in ("door", "window"):
        scene, new_id = with_opening(scene, library, category, "wall_3", middle)
        made.append(new_id)
    for _ in range(int(np.ptp(wall_3, axis=0).max() / 0.8)):
        try:
            scene, new_id = with_opening(scene, library, "window", "wall_3", middle)
            made.append(new_id)
        except EditRefused:
            break
    with pytest.raises(EditRefused, match="no part of this wall is free"):
        with_opening(scene, library, "door", "wall_3", middle)
    for k, one in enumerate(made):
        low, high = _span(scene.object(one))
        for other in made[:k]:
            other_low, other_high = _span(scene.object(other))
            assert ((high <= other_low + 1e-6) | (other_high <= low + 1e-6)).any()


def test_a_door_is_put_beside_what_stands_at_the_wall() -> None:
    library, scene = built_in_library(), living_room()
    middle = scene.plane("wall_3").polygon[:, :2].mean(axis=0)
    first, door = with_opening(scene, library, "door", "wall_3", middle)
    stands_there = next(o for o in scene.objects if o.category != "rug" and o.size_m[2] > 0.3 and o.size_m[1] < 1.5)
    shift = np.append(first.object(door).pose.position[:2], stands_there.pose.position[2])
    moved = replace(stands_there, pose=replace(stands_there.pose, position=shift))
    blocked = replace(scene, objects=tuple(moved if o.id == moved.id else o for o in scene.objects))
    after, door = with_opening(blocked, library, "door", "wall_3", middle)
    (low, high), (moved_low, moved_high) = _span(after.object(door)), _span(moved)
    assert ((high <= moved_low + 1e-6) | (moved_high <= low + 1e-6)).any()


def _span(item):
    return item.corners_world[:, :2].min(axis=0), item.corners_world[:, :2].max(axis=0)
