"""Objects glide from where they were to where they are."""

from __future__ import annotations

import time
from dataclasses import replace
from itertools import pairwise

import numpy as np

from diorama_app.commands.glide import DURATION_S, STEPS, glide, pose_between
from diorama_core.scene import edits
from diorama_core.scene.types import Pose


def test_a_way_begins_and_ends_at_its_poses_and_turns_evenly() -> None:
    start, end = Pose.upright((0, 0, 0.5), 0.2), Pose.upright((2, 1, 0.5), 1.2, (2.0, 1.0, 1.0))
    for share, pose in ((0.0, start), (1.0, end)):
        between = pose_between(start, end, share)
        np.testing.assert_allclose(between.matrix, pose.matrix, atol=1e-9)
    middle = pose_between(start, end, 0.5)
    assert abs(middle.yaw_rad - 0.7) < 1e-9
    np.testing.assert_allclose(middle.position, (1.0, 0.5, 0.5))
    np.testing.assert_allclose(middle.scale, (np.sqrt(2), 1, 1))


def test_a_moved_object_is_shown_on_its_way_and_where_it_is_in_the_end(session, monkeypatch) -> None:
    before, shown = session.scene, []
    item = before.objects[0]
    session.commit("move", edits.move(before, item.id, item.pose.move((0.5, 0.0, 0.0))))
    monkeypatch.setattr(session.viewport, "preview", lambda poses: shown.append(poses[item.id].position[0]))
    session.ui_thread.ask(lambda: glide(session, before))
    ends = time.monotonic() + 10.0 + DURATION_S
    while len(shown) < STEPS and time.monotonic() < ends:
        time.sleep(0.02)
        session.ui_thread.wait()
    assert len(shown) == STEPS
    assert shown[0] == item.pose.position[0]
    assert all(a < b for a, b in pairwise(shown))


def test_an_edit_meanwhile_ends_it_and_a_scene_that_grew_does_not_glide(session, monkeypatch) -> None:
    before, shown = session.scene, []
    monkeypatch.setattr(session.viewport, "preview", lambda poses: shown.append(poses))
    session.commit("rescale", edits.rescale(before, 1.2))
    session.ui_thread.ask(lambda: glide(session, before))
    assert shown == []
    item = before.objects[0]
    moved = edits.move(before, item.id, item.pose.move((0.5, 0.0, 0.0)))
    session.commit("move", moved)

    def begin_and_edit() -> None:
        glide(session, before)
        session.commit("lock", replace(moved, objects=moved.objects))

    session.ui_thread.ask(begin_and_edit)
    time.sleep(3 * DURATION_S / STEPS)
    session.ui_thread.wait()
    assert len(shown) == 1
