from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from diorama_core.scene.history import Entry, History
from diorama_core.scene.types import Scene
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
    late = history.commit(Entry("nudge", Scene(), merge_key="nudge chair", time_s=9.0))
    assert len(late.entries) == 3


def test_the_oldest_entries_are_dropped_beyond_the_limit() -> None:
    history = History.start(Scene(), limit=5)
    for i in range(20):
        history = history.commit(Entry(str(i), Scene()))
    assert [e.label for e in history.entries] == ["15", "16", "17", "18", "19"]
    assert history.current.label == "19"
