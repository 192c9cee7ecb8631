"""Playing in the editor: gravity acts on a preview, and what came of it is one undo step."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_app.commands.play import play
from diorama_app.session.client import Playing
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from tests.app.people import settle
from tests.waiting import until

pytest.importorskip("mujoco", reason="playing needs MuJoCo (extra 'sim')")


def _lifted(session, client) -> None:
    chair = session.scene.object("chair_1")
    session.edit("lift", lambda s: edits.move(s, "chair_1", chair.pose.move((0.0, 0.0, 0.4))), by=client)


def test_what_falls_and_is_pushed_is_one_undo_step(session, client, monkeypatch) -> None:
    _lifted(session, client)
    before, shown = session.scene, []
    monkeypatch.setattr(session.viewport, "preview", lambda poses: shown.append(poses))
    play(client)
    assert isinstance(client.doing, Playing)
    until(lambda: shown and shown[-1]["chair_1"].position[2] < before.object("chair_1").pose.position[2] - 0.3)
    client.doing.push("chair_2", np.array([0.0, -1.0, 0.0]))
    was = before.object("chair_2").pose.position[1]
    until(lambda: shown[-1]["chair_2"].position[1] < was - 0.05)
    assert session.scene is before, "the document waits"
    play(client)
    settle(session)
    assert client.doing is None
    assert session.scene.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=0.02)
    session.undo(client)
    assert session.scene == before


def test_a_cancelled_game_changes_nothing(session, client) -> None:
    _lifted(session, client)
    before = session.scene
    play(client)
    session.jobs.cancel()
    settle(session)
    assert session.scene is before
    assert client.doing is None


def test_an_empty_room_is_no_playground(session, client) -> None:
    ids = [o.id for o in session.scene.objects]
    session.edit("clear", lambda s: edits.remove(s, ids), by=client)
    with pytest.raises(EditRefused, match="nothing to play with"):
        play(client)


def test_where_nothing_moves_there_is_no_step(session, client) -> None:
    play(client)
    until(lambda: session.jobs.status is not None and "push" in session.jobs.status.message)
    before = session.scene
    play(client)
    settle(session)
    assert session.scene is before
