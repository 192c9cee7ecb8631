from __future__ import annotations

import pytest

from diorama_app.commands.edit_by_words import WordEdits
from diorama_core.errors import EditRefused
from diorama_core.scene.edits import remove
from tests.waiting import until


@pytest.fixture
def edits(client) -> WordEdits:
    return WordEdits(client)


def test_edits_are_proposed_then_made_as_one_step(session, client, edits) -> None:
    before = session.scene
    edits.ask("  remove the   chair ")
    until(lambda: edits.proposed is not None)
    assert session.scene is before
    edits.apply()
    assert len(session.scene.objects) < len(before.objects)
    assert session.document.history.current.label == "remove the chair"
    assert edits.proposed is None
    session.undo(client)
    assert session.scene == before


def test_what_is_not_there_is_refused_in_one_line(session, edits) -> None:
    edits.ask("remove the piano")
    until(lambda: edits.refused != "")
    assert "piano" in edits.refused
    assert "\n" not in edits.refused
    with pytest.raises(EditRefused, match="no edits to make"):
        edits.apply()


def test_edits_of_an_older_scene_are_looked_at_again(session, client, edits) -> None:
    edits.ask("remove the chair")
    until(lambda: edits.proposed is not None)
    session.edit("hide", lambda scene: remove(scene, [scene.objects[-1].id]), by=client)
    with pytest.raises(EditRefused, match="has changed since"):
        edits.apply()
