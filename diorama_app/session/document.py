"""The edited document: a history of scenes with their photos. The single source of truth."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import cast

from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import EditRefused
from diorama_core.multiview.camera_changes import following
from diorama_core.scene.history import Entry, History, move_last, move_next
from diorama_core.scene.types import Scene


@dataclass(frozen=True, eq=False)
class Photos:
    """What belongs to a scene besides itself."""

    inputs: Inputs | None = None
    """The photo that it was built from, with all corrections."""
    further: tuple[FurtherPhoto, ...] = ()
    """Other photos of the same room."""

    def __eq__(self, other: object) -> bool:
        """Whether both are of the very same pictures: corrections make new ones."""
        same = isinstance(other, Photos) and self.inputs is other.inputs and len(self.further) == len(other.further)
        return same and all(a is b for a, b in zip(self.further, cast("Photos", other).further, strict=True))

    def __hash__(self) -> int:
        return hash(id(self.inputs))


IsMine = Callable[[Entry], bool]
"""Whether a change may be taken back, or done again, by somebody."""


def anybodys(entry: Entry) -> bool:
    """Any change."""
    return True


class Document:
    """The open scene. Used from the UI thread only; `history` is a value and may be read from anywhere."""

    def __init__(self, scene: Scene | None = None) -> None:
        self.history = History.start(scene or Scene())
        self._opened, self._changes = secrets.token_hex(3), 0

    @property
    def version(self) -> str:
        """Names this state: another one after every change, and in every process that opens the document."""
        return f"{self._opened}.{self._changes}"

    @property
    def scene(self) -> Scene:
        """The scene as it is now."""
        return self.history.current.scene

    @property
    def inputs(self) -> Inputs | None:
        """The current photo inputs with all corrections."""
        return self._photos.inputs

    @property
    def further_photos(self) -> tuple[FurtherPhoto, ...]:
        """The other photos of the room."""
        return self._photos.further

    @property
    def _photos(self) -> Photos:
        beside = self.history.current.beside
        return beside if isinstance(beside, Photos) else Photos()

    def open(self, scene: Scene, inputs: Inputs | None = None, further: tuple[FurtherPhoto, ...] = ()) -> None:
        """Replace the scene and its photos, and clear the history."""
        self.history = History(entries=(Entry("open", scene, beside=Photos(inputs, further)),))
        self._opened, self._changes = secrets.token_hex(3), 0

    def commit(
        self,
        label: str,
        scene: Scene,
        *,
        inputs: Inputs | None = None,
        further: tuple[FurtherPhoto, ...] | None = None,
        selection: Iterable[str] = (),
        merge_key: str | None = None,
        author: str = "",
    ) -> None:
        """Make `scene` the current state, as one undo step called `label`.

        Args:
            label: what was done.
            scene: what it led to.
            inputs: what is said of the photo from now on; as before when None.
            further: the other photos of the room from now on; as before, following the scene's camera, when None.
            selection: what the person who did it has selected then: undo and redo select it again.
            merge_key: quick edits of the same key become one step.
            author: who did it.
        """
        if further is None:
            further = following(self.further_photos, self.scene.camera, scene.camera)
        beside = Photos(self.inputs if inputs is None else inputs, further)
        entry = Entry(label, scene, tuple(selection), merge_key, time.monotonic(), beside, author)
        self.history = self.history.commit(entry)
        self._changes += 1

    def next_undo(self, is_mine: IsMine = anybodys) -> Entry | None:
        """What `undo` would take back; None when there is nothing."""
        return self._entry(self._next_undo(is_mine))

    def next_redo(self, is_mine: IsMine = anybodys) -> Entry | None:
        """What `redo` would do again; None when there is nothing."""
        return self._entry(self._next_redo(is_mine))

    def _entry(self, index: int | None) -> Entry | None:
        return None if index is None else self.history.entries[index]

    def undo(self, is_mine: IsMine = anybodys) -> Entry:
        """Take back the last change that somebody may take back; returns it.

        Raises:
            EditRefused: there is none, or others have changed the same things since.
        """
        index = self._next_undo(is_mine)
        if index is None:
            mine = self.history.can_undo
            raise EditRefused("there is nothing of yours to undo" if mine else "there is nothing to undo")
        self.history = move_last(self.history, index)
        undone = self.history.current
        self.history = self.history.undo()
        self._changes += 1
        return undone

    def redo(self, is_mine: IsMine = anybodys) -> Entry:
        """Do the next change again that somebody may do again; returns it.

        Raises:
            EditRefused: there is none, or others have changed the same things since.
        """
        index = self._next_redo(is_mine)
        if index is None:
            mine = self.history.can_redo
            raise EditRefused("there is nothing of yours to redo" if mine else "there is nothing to redo")
        self.history = move_next(self.history, index).redo()
        self._changes += 1
        return self.history.current

    def _next_undo(self, is_mine: IsMine) -> int | None:
        entries = self.history.entries
        return next((k for k in range(self.history.cursor, 0, -1) if is_mine(entries[k])), None)

    def _next_redo(self, is_mine: IsMine) -> int | None:
        entries = self.history.entries
        return next((k for k in range(self.history.cursor + 1, len(entries)) if is_mine(entries[k])), None)

    def note_selection(self, selection: tuple[str, ...]) -> None:
        """Remember a selection with the current state, so that undoing back to here selects it again."""
        if self.history.current.selection == selection:
            return
        entries = list(self.history.entries)
        entries[self.history.cursor] = replace(self.history.current, selection=selection)
        self.history = replace(self.history, entries=tuple(entries))
