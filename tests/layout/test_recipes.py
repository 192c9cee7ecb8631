"""Each room of a home is laid out by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.editing.homes import join
from diorama_core.geometry.rooms import rooms_of_objects
from diorama_core.layout.recipes import RoomByRoom, recipe
from diorama_core.progress import Progress
from diorama_core.scene import edits
from tests.app.small_room import PlainLibrary, furnished_scene
from tests.editing.test_homes import with_door

SHAPE = ("picture_a", PlainLibrary().shape("picture_a").size_m)


def test_rooms_of_a_home_are_tidied_one_by_one() -> None:
    one = with_door(furnished_scene(), "door", "wall_3", 0.3, SHAPE)
    other = with_door(furnished_scene(), "door", "wall_1", 0.3, SHAPE)
    home = join(one, other, "door", "door").scene
    twins = ("chair_1", "chair_1-2")
    for name in twins:  # into the table of its own room
        table = home.object(name.replace("chair_1", "table_1"))
        shift = 0.6 * (table.pose.position - home.object(name).pose.position) * (1.0, 1.0, 0.0)
        home = edits.move(home, name, home.object(name).pose.move(shift))
    seen = []
    stage = RoomByRoom(recipe("feasible", PlainLibrary()))
    tidy, report = stage.optimise(home, Progress(), lambda scene, costs: seen.append(scene))
    assert rooms_of_objects(tidy) == rooms_of_objects(home)
    assert [o.id for o in tidy.objects] == [o.id for o in home.objects]
    moves = [tidy.object(n).pose.position - home.object(n).pose.position for n in twins]
    assert min(np.linalg.norm(m) for m in moves) > 0.02
    assert report.after.keys() == report.before.keys()
    assert all(len(scene.objects) == len(home.objects) for scene in seen)
    alone = replace(furnished_scene(), camera=None)
    assert stage.optimise(alone, Progress())[0] == stage.stage.optimise(alone, Progress())[0]
