"""Two people in one room: each takes back what is theirs."""

from __future__ import annotations

import pytest

from diorama_app.commands import edit
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.errors import EditRefused
from tests.app.people import join
from tests.waiting import until

RED, BLUE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


@pytest.fixture
def other(session: EditorSession, client: Client) -> Client:
    return join(session, 1)


def test_each_undoes_and_redoes_what_is_theirs(session: EditorSession, client: Client, other: Client) -> None:
    edit.set_colour(client, ["chair_1"], RED)
    edit.set_colour(other, ["lamp_1"], BLUE)
    session.undo(client)
    assert session.scene.object("chair_1").colour is None
    assert session.scene.object("lamp_1").colour == BLUE
    with pytest.raises(EditRefused, match="nothing of yours to undo"):
        session.undo(client)
    with pytest.raises(EditRefused, match="nothing of yours to redo"):
        session.redo(other)
    session.redo(client)
    assert session.scene.object("chair_1").colour == RED


def test_what_the_other_changed_since_stays(session: EditorSession, client: Client, other: Client) -> None:
    edit.set_colour(client, ["chair_1"], RED)
    edit.set_colour(other, ["chair_1"], BLUE)
    with pytest.raises(EditRefused, match=f"{other.name} has changed chair since"):
        session.undo(client)
    session.undo(other)
    session.undo(client)
    assert session.scene.object("chair_1").colour is None


def test_what_somebody_left_behind_is_anybodys(session: EditorSession, client: Client, other: Client) -> None:
    edit.set_colour(other, ["lamp_1"], BLUE)
    session.leave(other.viser_client)
    session.undo(client)
    assert session.scene.object("lamp_1").colour is None


def test_only_who_made_an_edit_is_offered_to_undo_it(session: EditorSession, client: Client, other: Client) -> None:
    told: dict[int, list[tuple[str, bool]]] = {client.id: [], other.id: []}
    for one in (client, other):
        one.toast = lambda message, undo, to=told[one.id]: to.append((message, undo))
    edit.set_colour(client, ["lamp_1"], BLUE)
    until(lambda: told[client.id] and told[other.id])  # the others' pages are drawn a moment later
    assert told[client.id][-1] == ("Paint lamp", True)
    assert told[other.id][-1] == (f"{client.name}: Paint lamp", False)
