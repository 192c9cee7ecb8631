"""Steps of people and programs: who did what, and what each may take back."""

from __future__ import annotations

from functools import partial

import pytest

from diorama_app.session.session import EditorSession
from diorama_app.session.shared_document import SharedDocument
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.people import join


def without(name: str, scene: Scene) -> Scene:
    return edits.remove(scene, (name,))


def test_a_program_takes_back_its_own_step_alone(session: EditorSession) -> None:
    document: SharedDocument = session
    person, said = join(session), list[str]()
    person.toast = lambda message, offers_undo: said.append(message)
    document.edit("remove the lamp", partial(without, "lamp_1"), author="Agent")
    document.edit("remove a chair", partial(without, "chair_1"), by=person)
    assert document.undo("Agent").label == "remove the lamp"
    assert document.scene.has_object("lamp_1")
    assert not document.scene.has_object("chair_1")
    assert said == ["Agent: Remove the lamp", "Remove a chair", "Undone: remove the lamp"]


def test_a_refused_edit_and_one_that_changes_nothing_leave_no_step(session: EditorSession) -> None:
    before = session.document.version
    session.edit("nothing", lambda scene: scene)
    with pytest.raises(EditRefused, match="this is not possible: no number"):
        session.edit("wrong", refused)
    assert session.document.version == before


def refused(scene: Scene) -> Scene:
    raise ValueError("no number")
