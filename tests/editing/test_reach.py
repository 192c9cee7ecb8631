"""Areas, turning circles, ways between doors and doors that open, in rooms whose furniture is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.homes import join
from diorama_core.editing.reach import uses_of
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene, Support
from tests.app.small_room import furnished_scene
from tests.editing.objects import item
from tests.editing.test_homes import with_door


def bare(*doors: tuple[str, str]) -> Scene:
    scene = replace(furnished_scene(), objects=(), supports=(), camera=None)
    for name, wall in doors:
        scene = with_door(scene, name, wall, 0.0)
    return scene


def test_an_empty_room_has_all_of_it() -> None:
    (use,) = uses_of(bare(("one", "wall_1"), ("two", "wall_3")))
    assert use.area_m2 == pytest.approx(4.4 * 4.0)
    assert use.turning_at is not None
    assert use.way_m == 1.2
    assert use.stuck == ()


def test_furniture_narrows_ways_and_takes_the_turning_circle() -> None:
    scene = bare(("one", "wall_1"), ("two", "wall_3"))
    low, high = (f(scene.architecture.by_role("floor")[0].polygon[:, :2], axis=0) for f in (np.min, np.max))
    middle = (low + high) / 2
    for width, way in ((3.45, 0.9), (4.3, 0.0)):  # what is left beside it: 95 and 10 cm
        wide = item("bar", (0.6, width, 1.0), 0.0, 0.0)
        pose = Pose.upright((high[0] - width / 2, middle[1], 0.5), np.pi / 2)
        (use,) = uses_of(edits.insert(scene, replace(wide, pose=pose), Support("bar", "floor")))
        assert use.way_m == way
    full = scene
    for number, x in enumerate(np.arange(low[0] + 0.3, high[0], 0.7)):
        for y in np.arange(low[1] + 0.3, high[1], 0.7):
            block = item(f"b{number}-{y:.1f}", (0.3, 0.3, 1.0), float(x), float(y))
            full = edits.insert(full, block, Support(block.id, "floor"))
    assert uses_of(full)[0].turning_at is None


def test_rooms_of_a_home_are_told_apart() -> None:
    home = join(bare(("door", "wall_3")), bare(("way", "wall_1")), "door", "way", names=("hall", "study")).scene
    home = with_door(home, "out", "wall_1", 0.0)
    hall, study = uses_of(home)
    assert (hall.room.name, study.room.name) == ("hall", "study")
    assert hall.way_m == 1.2
    assert study.way_m is None, "it has one door"
    assert hall.turning_at is not None
    assert study.turning_at is not None
    assert uses_of(Scene()) == ()
