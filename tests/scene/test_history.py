"""One person's change is taken back from under the changes of others."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.history import Entry, History, move_last, move_next
from diorama_core.scene.types import Scene, Support
from tests.app.small_room import furnished_scene
from tests.scene.strategies import scenes

steps = st.lists(st.sampled_from(["commit", "undo", "redo"]), max_size=30)


@given(st.lists(scenes(max_objects=2), min_size=1, max_size=4), steps)
def test_undo_then_redo_is_identity(pool: list[Scene], actions: list[str]) -> None:
    history = History.start(pool[0])
    for i, action in enumerate(actions):
        if action == "commit":
            history = history.commit(Entry(f"step {i}", pool[i % len(pool)]))
        else:
            history = history.undo() if action == "undo" else history.redo()
        if history.can_undo:
            assert history.undo().redo() == history
        if history.can_redo:
            assert history.redo().undo() == history


@given(st.integers(1, 10))
def test_undoing_everything_gives_back_the_first_scene(count: int) -> None:
    first = Scene(metrics=(("n", 0.0),))
    history = History.start(first)
    for i in range(count):
        history = history.commit(Entry("step", Scene(metrics=(("n", float(i + 1)),))))
    for _ in range(count):
        history = history.undo()
    assert history.current.scene == first
    assert not history.can_undo


def test_a_commit_cuts_off_the_redo_branch() -> None:
    history = History.start(Scene()).commit(Entry("a", Scene())).undo().commit(Entry("b", Scene()))
    assert [e.label for e in history.entries] == ["open", "b"]


def test_repeated_nudges_within_the_window_become_one_step() -> None:
    history = History.start(Scene())
    for i in range(5):
        history = history.commit(Entry("nudge", Scene(), merge_key="nudge chair", time_s=0.3 * i))
    assert len(history.entries) == 2
    last = history.current.time_s
    for time_s, key, author, count in (
        (last + 0.5, "nudge chair", "", 2),
        (last + 0.6, "nudge chair", "", 3),
        (last + 0.1, "nudge table", "", 3),
        (last + 0.1, "nudge chair", "somebody else", 3),
        (last + 0.1, None, "", 3),
    ):
        longer = history.commit(Entry("nudge", Scene(), merge_key=key, time_s=time_s, author=author))
        assert len(longer.entries) == count, (time_s, key, author)
    assert len(history.undo().commit(Entry("nudge", Scene(), merge_key=None)).entries) == 2, "the first state stays"


def test_the_first_state_is_never_merged_and_steps_without_a_key_are_steps() -> None:
    opened = Entry("open", Scene(), merge_key="nudge chair")
    history = History((opened,)).commit(Entry("nudge", Scene(), merge_key="nudge chair"))
    assert history.entries[0] is opened
    for _ in range(2):
        history = history.commit(Entry("plain", Scene()))
    assert len(history.entries) == 4


def test_where_nothing_can_be_undone_or_done_again_the_history_stays() -> None:
    history = History.start(Scene(), label="begin")
    assert history.current.label == "begin"
    assert history.undo() is history
    assert history.redo() is history


def test_the_oldest_entries_are_dropped_beyond_the_limit() -> None:
    history = History.start(Scene(), limit=5)
    for i in range(20):
        history = history.commit(Entry(str(i), Scene()))
    assert [e.label for e in history.entries] == ["15", "16", "17", "18", "19"]
    assert history.current.label == "19"


def _history(*changes: tuple[str, str, object]) -> History:
    """A history of an author, a label and an edit each."""
    history = History.start(furnished_scene())
    for author, label, change in changes:
        history = history.commit(Entry(label, change(history.current.scene), author=author))
    return history


def _painted(object_id: str, red: float = 1.0):
    return lambda s: edits.recolour(s, object_id, (red, 0.0, 0.0))


def _moved(object_id: str):
    return lambda s: edits.move(s, object_id, s.object(object_id).pose.move((0.1, 0.0, 0.0)))


def test_a_change_is_moved_past_those_of_others_and_undone_there() -> None:
    history = _history(
        ("B", "paint", _painted("lamp_1")), ("A", "move", _moved("chair_1")), ("A", "red", _painted("chair_2"))
    )
    last = move_last(history, 1)
    assert last.current.scene == history.current.scene
    assert [(e.author, e.label) for e in last.entries[1:]] == [("A", "move"), ("A", "red"), ("B", "paint")]
    undone = last.undo()
    assert undone.current.scene.object("lamp_1").colour is None
    assert undone.current.scene.object("chair_2").colour == (1.0, 0.0, 0.0)
    assert undone.redo().current.scene == history.current.scene


def test_a_deletion_is_taken_back_where_it_was() -> None:
    history = _history(("B", "delete", lambda s: edits.remove(s, ["chair_1"])), ("A", "red", _painted("chair_2")))
    back = move_last(history, 1).undo().current.scene
    assert [o.id for o in back.objects] == [o.id for o in furnished_scene().objects]
    assert back.support_of("chair_1") == furnished_scene().support_of("chair_1")
    assert back.object("chair_2").colour is not None


def test_what_others_changed_since_is_not_taken_back() -> None:
    history = _history(("B", "paint", _painted("chair_1")), ("A", "move", _moved("chair_1")))
    with pytest.raises(EditRefused, match="A has changed chair since, so “paint” stays"):
        move_last(history, 1)


def test_what_others_built_on_is_not_taken_back() -> None:
    def added(scene: Scene) -> Scene:
        return edits.duplicate(scene, "table_1")[0]

    def on_it(scene: Scene) -> Scene:
        return edits.attach(scene, Support("lamp_1", scene.objects[-1].id))

    history = _history(("B", "duplicate", added), ("A", "lamp onto the copy", on_it))
    with pytest.raises(EditRefused, match="A has since built on what would go"):
        move_last(history, 1)


def test_an_undone_change_is_moved_before_those_of_others() -> None:
    history = _history(("A", "move", _moved("chair_1")), ("B", "paint", _painted("lamp_1"))).undo().undo()
    next_ = move_next(history, 2)
    done = next_.redo()
    assert done.current.author == "B"
    assert done.current.scene.object("lamp_1").colour is not None
    assert done.current.scene.object("chair_1") == furnished_scene().object("chair_1")
    assert done.redo().current.scene == history.redo().redo().current.scene
