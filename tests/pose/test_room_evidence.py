"""What posing tells the decision about headings."""

from __future__ import annotations

import numpy as np

from diorama_core.pose import RenderAndCompare
from diorama_core.pose.room_evidence import Trials
from diorama_core.progress import Progress
from tests.pose.rooms import LIBRARY, Room, camera_at, standing

STAGE = RenderAndCompare(LIBRARY)


def trials() -> Trials:
    room = Room(camera_at(), (standing("chair", 0.2, 2.6, 30.0), standing("carton", -1.0, 3.0, 0.0)), (0, 1))
    depth = room.depth(measured=False)
    return STAGE.trials(room.inputs, room.objects, room.geometry, depth, room.ranked(), Progress())


def test_a_picture_prefers_headings_near_the_true_one_and_fine_poses_all_the_more() -> None:
    found = trials()
    chair = found.room.objects[0]
    off = np.abs(np.mod(np.rad2deg(chair.yaw_rad) + 15 * np.arange(24) - 30 + 180, 360) - 180)
    assert off[chair.picture.argmax()] <= 30
    fine = STAGE.refine_best(found.tasks[0], found.tried[0][0], 4)
    assert len(fine.scores) == len(found.tried[0][0].scores) + 8
    finer = found.with_shapes([[fine, *found.tried[0][1:]], *found.tried[1:]])
    assert off[finer.room.objects[0].picture.argmax()] <= 30
    assert np.array_equal(finer.room.objects[1].picture, found.room.objects[1].picture)


def test_folds_are_those_of_the_likeliest_shapes() -> None:
    found = trials()
    assert [found.folds()[task.item.id] for task in found.tasks] == [1, 2]
