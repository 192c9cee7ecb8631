"""Two people edit one room and take back what is theirs, in any order."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from diorama_app.session.document import Document
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from tests.app.small_room import furnished_scene

PEOPLE = st.sampled_from(["Ada", "Grace"])
OBJECTS = ("chair_1", "table_1", "lamp_1")


@dataclass(frozen=True)
class Change:
    """An object's new name."""

    author: str
    object_id: str
    label: str


class UndoMachine(RuleBasedStateMachine):
    """A document beside a list of changes that are done and one of those that are undone, the next one first."""

    @initialize()
    def begin(self) -> None:
        self.first = furnished_scene()
        self.document = Document(self.first)
        self.done, self.undone, self.number = list[Change](), list[Change](), 0

    @rule(author=PEOPLE, object_id=st.sampled_from(OBJECTS))
    def edit(self, author: str, object_id: str) -> None:
        self.number += 1
        change = Change(author, object_id, f"edit {self.number}")
        scene = edits.rename(self.document.scene, object_id, change.label)
        self.document.commit("rename", scene, author=author)
        self.done.append(change)
        self.undone.clear()

    @rule(author=PEOPLE)
    def undo(self, author: str) -> None:
        own = next((c for c in reversed(self.done) if c.author == author), None)
        since = [] if own is None else self.done[self.done.index(own) + 1 :]
        if own is None or any(c.object_id == own.object_id for c in since):
            with pytest.raises(EditRefused):
                self.document.undo(lambda entry: entry.author == author)
            return
        self.document.undo(lambda entry: entry.author == author)
        self.done.remove(own)
        self.undone.insert(0, own)

    @rule(author=PEOPLE)
    def redo(self, author: str) -> None:
        own = next((c for c in self.undone if c.author == author), None)
        between = [] if own is None else self.undone[: self.undone.index(own)]
        if own is None or any(c.object_id == own.object_id for c in between):
            with pytest.raises(EditRefused):
                self.document.redo(lambda entry: entry.author == author)
            return
        self.document.redo(lambda entry: entry.author == author)
        self.undone.remove(own)
        self.done.append(own)

    @invariant()
    def the_scene_is_what_is_done(self) -> None:
        if hasattr(self, "document"):
            labels = {o: self.first.object(o).label for o in OBJECTS} | {c.object_id: c.label for c in self.done}
            assert {o: self.document.scene.object(o).label for o in OBJECTS} == labels
            assert self.document.history.can_undo == bool(self.done)
            assert self.document.history.can_redo == bool(self.undone)


TestUndo = UndoMachine.TestCase
TestUndo.settings = settings(max_examples=20, stateful_step_count=30, deadline=None)
