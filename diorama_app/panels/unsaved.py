"""Offers what an earlier session could not save, until it is taken or put away."""

from __future__ import annotations

import viser

from diorama_app.guest import Guest
from diorama_app.page import Action, LiveHtml, button, text
from diorama_app.recovery import Unsaved
from diorama_core.project.storage import Project


class UnsavedChanges:
    """A card below the toolbar."""

    def __init__(self, gui: viser.GuiApi, guest: Guest) -> None:
        self._guest = guest
        self._html = LiveHtml(gui, self._act)
        self._of: Project | None = None
        self._found: Unsaved | None = None

    def refresh(self) -> None:
        """Look for unsaved changes of a project that was just opened."""
        room = self._guest.room
        if room.project is not self._of:
            self._of = room.project
            self._found = None if room.project is None else room.saver.recovery.left_behind(room.project)
        found = self._found
        if found is None or not found.path.exists():
            self._html.show("")
            return
        self._html.show(
            f'<div class="card warn">Changes of {text(found.when)} were not saved when Diorama ended.'
            f'<div class="bar tight" style="margin:6px 0 0 0">'
            + button("Restore unsaved changes", "restore", title="One undo step")
            + button("Discard", "discard", title="Forget them for good")
            + "</div></div>"
        )

    def _act(self, action: Action) -> None:
        self._guest.post(lambda: self._do(action.do))

    def _do(self, what: str) -> None:
        room, found = self._guest.room, self._found
        if found is None or not found.path.exists():
            return
        if what == "restore" and room.project is not None:
            scene = found.scene()
            room.textures = {**room.textures, **room.project.textures(scene)}
            room.commit("restore unsaved changes", scene, by=self._guest, selection=())
        if what in ("restore", "discard"):
            found.discard()
            room.refresh_panels()
