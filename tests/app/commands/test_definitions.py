"""Every command of the table runs, and does what its name says."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from diorama_core.errors import EditRefused
from diorama_core.scene.support import check_scene

UNDOABLE = {
    "duplicate", "cut", "paste", "delete", "hide", "lock", "turn_left", "turn_right", "next_shape", "mirror",
    "align_left", "align_right", "align_centre", "align_back", "align_front", "align_depth", "distribute",
}  # fmt: skip


def run(commands, client, command_id: str) -> None:
    commands[command_id].run(client)


def test_ids_and_keys_are_used_once(commands) -> None:
    assert max(Counter(c.id for c in commands.all).values()) == 1
    keys = Counter((c.hotkey, c.modifier) for c in commands.all if c.hotkey)
    assert max(keys.values()) == 1, keys.most_common(2)


@pytest.mark.parametrize("command_id", sorted(UNDOABLE))
def test_commands_on_objects_are_one_step_and_leave_a_sound_scene(session, client, commands, command_id) -> None:
    client.select(["chair_2", "table_1", "chair_1"])
    if command_id == "paste":
        run(commands, client, "copy")
    before, steps = session.scene, len(session.document.history.entries)
    run(commands, client, command_id)
    assert session.scene != before
    assert len(session.document.history.entries) == steps + 1
    check_scene(session.scene)
    run(commands, client, "undo")
    assert session.scene == before
    run(commands, client, "redo")
    assert session.scene != before


@pytest.mark.parametrize("command_id", sorted(UNDOABLE | {"copy", "drop", "select_same", "focus", "previous_shape"}))
def test_without_a_selection_they_say_what_to_do(session, client, commands, command_id) -> None:
    before = session.scene
    with pytest.raises(EditRefused, match="nothing"):
        run(commands, client, command_id)
    assert session.scene is before


def test_selections(session, client, commands) -> None:
    client.select(["chair_1"])
    run(commands, client, "hide")
    run(commands, client, "select_all")
    assert set(client.selection) == {"table_1", "lamp_1", "chair_2", "picture_1"}
    client.select(["table_1"])
    run(commands, client, "select_invert")
    assert set(client.selection) == {"lamp_1", "chair_2", "picture_1"}
    run(commands, client, "show_all")
    assert not session.scene.object("chair_1").hidden
    with pytest.raises(EditRefused, match="nothing collides"):
        run(commands, client, "select_bad")
    session.badges = {"lamp_1": ("floats",)}
    run(commands, client, "select_bad")
    assert client.selection == ("lamp_1",)


def test_lock_and_hide_go_back_and_forth_by_the_last_selected(session, client, commands) -> None:
    client.select(["chair_1", "chair_2"])
    for _ in range(2):
        before = session.scene.object("chair_2").locked
        run(commands, client, "lock")
        assert {session.scene.object(i).locked for i in client.selection} == {not before}


def test_dropping_puts_an_object_down_on_what_holds_it(session, client, commands) -> None:
    from diorama_core.scene import edits

    lamp = session.scene.object("lamp_1").pose
    session.commit("lift", edits.move(session.scene, "lamp_1", lamp.move((0.0, 0.0, 0.3))))
    client.select(["lamp_1"])
    run(commands, client, "drop")
    np.testing.assert_allclose(session.scene.object("lamp_1").pose.position, lamp.position, atol=1e-6)


def test_turns_are_fifteen_degrees_to_either_side(session, client, commands) -> None:
    client.select(["chair_1"])
    before = session.scene.object("chair_1").pose.yaw_rad
    run(commands, client, "turn_left")
    assert np.rad2deg(session.scene.object("chair_1").pose.yaw_rad - before) == pytest.approx(15.0)
    run(commands, client, "turn_right")
    assert session.scene.object("chair_1").pose.yaw_rad == pytest.approx(before)


def test_switches_change_one_preference_each(client, commands) -> None:
    for name in ("snap", "slide", "names", "badges", "planes"):
        before = getattr(client.preferences, name)
        run(commands, client, name)
        assert getattr(client.preferences, name) is not before
    for mode in ("floor", "free", "size"):
        run(commands, client, f"gizmo_{mode}")
        assert client.preferences.gizmo == mode
    dark = client.preferences.dark
    run(commands, client, "theme")
    assert client.preferences.dark is not dark


def test_saving_writes_the_project_and_needs_one(session, client, commands) -> None:
    client.select(["chair_1"])
    run(commands, client, "delete")
    run(commands, client, "save")
    assert not session.project.load_scene().has_object("chair_1")
    session.project = None
    with pytest.raises(EditRefused, match="no project"):
        run(commands, client, "save")


def test_escape_stops_one_object_after_another(session, client, commands) -> None:
    closed = []
    client.dialog = lambda: closed.append(1) or setattr(client, "dialog", None)
    client.select(["chair_1"])
    client.view.canvas.open(session.photo.rgb, lambda event: None)
    run(commands, client, "escape")
    assert closed == [1]
    assert client.view.canvas.is_open
    run(commands, client, "escape")
    assert not client.view.canvas.is_open
    assert client.selection == ("chair_1",)
    run(commands, client, "escape")
    assert client.selection == ()
