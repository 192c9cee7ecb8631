from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_app.session.document import Document
from diorama_core.artefacts import Inputs
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from tests.app.small_room import furnished_scene, plain_photo

SCENE = furnished_scene()


def renamed(label: str):
    return edits.rename(SCENE, "chair_1", label)


def test_undo_and_redo_walk_the_steps_and_say_which() -> None:
    document = Document(SCENE)
    document.commit("first", renamed("a"), selection=["chair_1"])
    document.commit("second", renamed("b"))
    assert document.undo().label == "second"
    assert document.scene == renamed("a")
    assert document.undo().label == "first"
    assert document.scene == SCENE
    assert document.redo().label == "first"
    assert document.history.current.selection == ("chair_1",)
    document.commit("third", renamed("c"))
    with pytest.raises(EditRefused, match="nothing to redo"):
        document.redo()


def test_there_is_nothing_to_undo_at_first() -> None:
    document = Document()
    with pytest.raises(EditRefused, match="nothing to undo"):
        document.undo()
    document.commit("x", SCENE)
    document.open(SCENE)
    with pytest.raises(EditRefused):
        document.undo()


def test_what_is_said_of_the_photo_is_undone_with_the_scene() -> None:
    given = Inputs(plain_photo())
    corrected = replace(given, camera_height_m=1.2)
    document = Document()
    assert document.inputs is None
    document.open(SCENE, given)
    document.commit("camera", SCENE, inputs=corrected)
    document.commit("name", renamed("a"))
    assert document.inputs is corrected
    document.undo()
    document.undo()
    assert document.inputs is given


def test_quick_edits_of_one_key_are_one_step() -> None:
    document = Document(SCENE)
    for label in ("a", "ab", "abc"):
        document.commit("rename", renamed(label), merge_key="name chair_1")
    document.undo()
    assert document.scene == SCENE


def test_a_selection_is_noted_with_its_state() -> None:
    document = Document(SCENE)
    document.commit("first", renamed("a"))
    document.note_selection(("lamp_1",))
    history = document.history
    document.note_selection(("lamp_1",))
    assert document.history is history
    document.commit("second", renamed("b"))
    document.undo()
    assert document.history.current.selection == ("lamp_1",)
    assert document.history.current.label == "first"


def test_quick_edits_of_two_people_are_two_steps() -> None:
    document = Document(SCENE)
    document.commit("a", renamed("a"), merge_key="name", author="A")
    document.commit("b", renamed("b"), merge_key="name", author="B")
    assert len(document.history.entries) == 3
