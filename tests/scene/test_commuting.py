"""One person's change is taken back from under the changes of others."""

from __future__ import annotations

import pytest

from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.commuting import moved_last, moved_next
from diorama_core.scene.history import Entry, History
from diorama_core.scene.types import Scene, Support
from tests.app.small_room import furnished_scene


def _history(*changes: tuple[str, str, object]) -> History:
    """A history of an author, a label and an edit each."""
    history = History.start(furnished_scene())
    for author, label, change in changes:
        history = history.commit(Entry(label, change(history.current.scene), author=author))
    return history


def _painted(object_id: str, red: float = 1.0):
    return lambda s: edits.recolour(s, object_id, (red, 0.0, 0.0))


def _moved(object_id: str):
    return lambda s: edits.move(s, object_id, s.object(object_id).pose.moved((0.1, 0.0, 0.0)))


def test_a_change_is_moved_past_those_of_others_and_undone_there() -> None:
    history = _history(
        ("B", "paint", _painted("lamp_1")), ("A", "move", _moved("chair_1")), ("A", "red", _painted("chair_2"))
    )
    last = moved_last(history, 1)
    assert last.current.scene == history.current.scene
    assert [(e.author, e.label) for e in last.entries[1:]] == [("A", "move"), ("A", "red"), ("B", "paint")]
    undone = last.undo()
    assert undone.current.scene.object("lamp_1").colour is None
    assert undone.current.scene.object("chair_2").colour == (1.0, 0.0, 0.0)
    assert undone.redo().current.scene == history.current.scene


def test_a_deletion_is_taken_back_where_it_was() -> None:
    history = _history(("B", "delete", lambda s: edits.remove(s, ["chair_1"])), ("A", "red", _painted("chair_2")))
    back = moved_last(history, 1).undo().current.scene
    assert [o.id for o in back.objects] == [o.id for o in furnished_scene().objects]
    assert back.support_of("chair_1") == furnished_scene().support_of("chair_1")
    assert back.object("chair_2").colour is not None


def test_what_others_changed_since_is_not_taken_back() -> None:
    history = _history(("B", "paint", _painted("chair_1")), ("A", "move", _moved("chair_1")))
    with pytest.raises(EditRefused, match="A has changed chair since, so “paint” stays"):
        moved_last(history, 1)


def test_what_others_built_on_is_not_taken_back() -> None:
    def added(scene: Scene) -> Scene:
        return edits.duplicate(scene, "table_1")[0]

    def on_it(scene: Scene) -> Scene:
        return edits.attach(scene, Support("lamp_1", scene.objects[-1].id))

    history = _history(("B", "duplicate", added), ("A", "lamp onto the copy", on_it))
    with pytest.raises(EditRefused, match="A has since built on what would go"):
        moved_last(history, 1)


def test_an_undone_change_is_moved_before_those_of_others() -> None:
    history = _history(("A", "move", _moved("chair_1")), ("B", "paint", _painted("lamp_1"))).undo().undo()
    next_ = moved_next(history, 2)
    done = next_.redo()
    assert done.current.author == "B"
    assert done.current.scene.object("lamp_1").colour is not None
    assert done.current.scene.object("chair_1") == furnished_scene().object("chair_1")
    assert done.redo().current.scene == history.redo().redo().current.scene
