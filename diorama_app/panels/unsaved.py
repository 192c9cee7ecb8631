"""Notices about unsaved changes: a locked project, a full disk, recovery of an earlier session."""

from __future__ import annotations

import viser

from diorama_app.projects.manage import duplicate_project
from diorama_app.reconstruction.build_job import build, forget_build
from diorama_app.session.client import Client
from diorama_app.session.recovery import Unsaved
from diorama_app.strings import _
from diorama_app.web.html import LiveHtml, button, text
from diorama_core.project.storage import Project


class UnsavedChanges:
    """A card below the toolbar."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action.do)))
        self._of: Project | None = None
        self._found: Unsaved | None = None

    def refresh(self) -> None:
        """Look for unsaved changes of a project that was just opened."""
        session = self._client.session
        if session.project is not self._of:
            self._of = session.project
            self._found = None if session.project is None else session.autosave.recovery.find_unsaved(session.project)
        self._html.show(self._trouble() + self._offer() + self._build_card())

    def _trouble(self) -> str:
        session = self._client.session
        if session.read_only:
            return _card(
                _(session.read_only),
                button(_("Work on a copy"), "copy", title=_("Create a new project from the current state")),
                button(_("Try again"), "again", title=_("Close the project elsewhere first")),
            )
        return f'<div class="card warn">{text(_(session.autosave.trouble))}</div>' if session.autosave.trouble else ""

    def _offer(self) -> str:
        unsaved = self._found
        if unsaved is None or not unsaved.path.exists():
            return ""
        message = _("Changes of {time} were not saved when Diorama ended.").format(time=unsaved.when)
        return _card(
            message,
            button(_("Restore unsaved changes"), "restore", title=_("One undo step")),
            button(_("Discard"), "discard", title=_("Delete these changes permanently")),
        )

    def _build_card(self) -> str:
        session = self._client.session
        if not session.interrupted or session.jobs.status is not None:
            return ""
        return _card(
            _("Diorama ended while this scene was being built."),
            button(_("Continue building"), "build", title=_("Continue where the build stopped")),
            button(_("Not now"), "no build", title=_("Build it later with “Build scene”")),
        )

    def _do(self, what: str) -> None:
        session, unsaved = self._client.session, self._found
        if what in ("copy", "again") and session.project is not None:
            folder = session.project.folder
            if what == "copy":
                session.visit(self._client, duplicate_project(folder, session.projects_dir), "")
            else:
                session.open_project(Project.open(folder))
            return
        if what in ("build", "no build"):
            self._settle_build(go_on=what == "build")
            return
        if unsaved is None or not unsaved.path.exists():
            return
        if what == "restore" and session.project is not None:
            scene = unsaved.scene()
            session.textures = {**session.textures, **session.project.textures(scene)}
            session.commit("restore unsaved changes", scene, by=self._client, selection=())
        if what in ("restore", "discard"):
            unsaved.discard()
            session.refresh_panels()

    def _settle_build(self, *, go_on: bool) -> None:
        session = self._client.session
        if go_on:
            build(session)
        elif session.project is not None:
            session.interrupted = False
            forget_build(session.project)
        session.refresh_panels()


def _card(message: str, *buttons: str) -> str:
    bar = f'<div class="bar tight" style="margin:6px 0 0 0">{"".join(buttons)}</div>'
    return f'<div class="card warn">{text(message)}{bar}</div>'
