"""The edited document: a history of scenes with their photos. The single source of truth."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass, replace

from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import EditRefused
from diorama_core.multiview.following import following
from diorama_core.scene.history import Entry, History
from diorama_core.scene.types import Scene


@dataclass(frozen=True, eq=False)
class Photos:
    """What belongs to a scene besides itself."""

    inputs: Inputs | None = None
    """The photo that it was built from, with all corrections."""
    further: tuple[FurtherPhoto, ...] = ()
    """Other photos of the same room."""


class Document:
    """The open scene. Used from the UI thread only; `history` is a value and may be read from anywhere."""

    def __init__(self, scene: Scene | None = None) -> None:
        self.history = History.start(scene or Scene())

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
        """Replace the scene and clear the history."""
        self.history = History(entries=(Entry("open", scene, beside=Photos(inputs, further)),))

    def commit(
        self,
        label: str,
        scene: Scene,
        *,
        inputs: Inputs | None = None,
        further: tuple[FurtherPhoto, ...] | None = None,
        selection: Iterable[str] = (),
        merge_key: str | None = None,
    ) -> None:
        """Make `scene` the current state, as one undo step called `label`.

        Args:
            label: what was done.
            scene: what it led to.
            inputs: what is said of the photo from now on; as before when None.
            further: the other photos of the room from now on; as before, following the scene's camera, when None.
            selection: what the person who did it has selected then: undo and redo select it again.
            merge_key: quick edits of the same key become one step.
        """
        if further is None:
            further = following(self.further_photos, self.scene.camera, scene.camera)
        beside = Photos(self.inputs if inputs is None else inputs, further)
        entry = Entry(label, scene, tuple(selection), merge_key, time.monotonic(), beside)
        self.history = self.history.commit(entry)

    def undo(self) -> Entry:
        """One step back; returns what was taken back."""
        if not self.history.can_undo:
            raise EditRefused("there is nothing to undo")
        undone = self.history.current
        self.history = self.history.undo()
        return undone

    def redo(self) -> Entry:
        """One step forward; returns what was done again."""
        if not self.history.can_redo:
            raise EditRefused("there is nothing to redo")
        self.history = self.history.redo()
        return self.history.current

    def note_selection(self, selection: tuple[str, ...]) -> None:
        """Remember a selection with the current state, so that undoing back to here selects it again."""
        if self.history.current.selection == selection:
            return
        entries = list(self.history.entries)
        entries[self.history.cursor] = replace(self.history.current, selection=selection)
        self.history = replace(self.history, entries=tuple(entries))
