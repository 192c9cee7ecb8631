"""What is being edited: a history of scenes and what is selected. The single source of truth for every browser."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import replace

from diorama_core.errors import EditRefused
from diorama_core.scene.history import Entry, History
from diorama_core.scene.types import Scene, SceneObject


class Document:
    """The open scene. Used from the desk's thread only; `history` is a value and may be read from anywhere."""

    def __init__(self, scene: Scene | None = None) -> None:
        self.history = History.start(scene or Scene())
        self.selection: tuple[str, ...] = ()

    @property
    def scene(self) -> Scene:
        """The scene as it is now."""
        return self.history.current.scene

    @property
    def selected(self) -> SceneObject | None:
        """The object selected last, or None."""
        return self.scene.object(self.selection[-1]) if self.selection else None

    def open(self, scene: Scene) -> None:
        """Start over with another scene; the history begins anew."""
        self.history = History.start(scene)
        self.selection = ()

    def commit(
        self, label: str, scene: Scene, *, selection: Iterable[str] | None = None, merge_key: str | None = None
    ) -> None:
        """Make `scene` the current state, as one undo step called `label`."""
        if selection is not None:
            self.selection = tuple(selection)
        self._drop_missing(scene)
        entry = Entry(label, scene, self.selection, merge_key, time.monotonic())
        self.history = self.history.commit(entry)

    def edit(
        self,
        label: str,
        change: Callable[[Scene], Scene],
        *,
        selection: Iterable[str] | None = None,
        merge_key: str | None = None,
    ) -> None:
        """Apply a pure edit to the current scene and commit it; raises `EditRefused` with nothing changed."""
        self.commit(label, change(self.scene), selection=selection, merge_key=merge_key)

    def select(self, ids: Iterable[str]) -> None:
        """Select exactly these objects, in this order."""
        self.selection = tuple(i for i in dict.fromkeys(ids) if self.scene.has_object(i))

    def toggle(self, object_id: str) -> None:
        """Add an object to the selection, or take it out."""
        rest = tuple(i for i in self.selection if i != object_id)
        self.select(rest if object_id in self.selection else (*rest, object_id))

    def undo(self) -> str:
        """One step back; returns what was taken back."""
        if not self.history.can_undo:
            raise EditRefused("there is nothing to undo")
        undone = self.history.current.label
        self.history = self.history.undo()
        self._restore_selection()
        return undone

    def redo(self) -> str:
        """One step forward; returns what was done again."""
        if not self.history.can_redo:
            raise EditRefused("there is nothing to redo")
        self.history = self.history.redo()
        self._restore_selection()
        return self.history.current.label

    def rebase_selection(self) -> None:
        """Remember the selection with the current state, so that undoing back to here selects it again."""
        entries = list(self.history.entries)
        entries[self.history.cursor] = replace(self.history.current, selection=self.selection)
        self.history = replace(self.history, entries=tuple(entries))

    def _restore_selection(self) -> None:
        kept = self.selection
        self.selection = self.history.current.selection or kept
        self._drop_missing(self.scene)

    def _drop_missing(self, scene: Scene) -> None:
        self.selection = tuple(i for i in self.selection if scene.has_object(i))
