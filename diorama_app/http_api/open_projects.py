"""Projects that are open in the editor of this process, for the threads of the HTTP server.

Other programs and the browsers work on the same document: each step is shown in every browser, and is one undo step.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from diorama_app.projects.begin import begin_project, keep_given
from diorama_app.projects.manage import address_of, recent_projects
from diorama_app.projects.uploads import Upload, decode
from diorama_app.reconstruction.build_job import build
from diorama_app.reconstruction.text_to_scene import creation
from diorama_app.serve import Running
from diorama_app.session.session import EditorSession
from diorama_core.api import Reconstruction
from diorama_core.errors import DioramaError, EditRefused
from diorama_core.io.bounded import shorten
from diorama_core.io.limited import LimitedProcess
from diorama_core.perception.language.client import LmmSettings
from diorama_core.progress import Progress
from diorama_core.project.storage import Project
from diorama_core.text.edit_plan import Edit
from diorama_core.text.editing_by_words import ProposedEdits, apply_edits, propose_edits

MAX_LABEL = 80
"""Characters of an undo step's name."""


class UnknownProjectError(DioramaError):
    """There is no project, or no object in it, of this name."""


class StaleVersionError(DioramaError):
    """The scene has changed since the version that an edit was made for."""


@dataclass(frozen=True)
class Edited:
    """What an edit did, and the version that it led to."""

    proposed: ProposedEdits
    version: str


class OpenProjects:
    """The editor's projects. May be used from any thread but the editor's own."""

    def __init__(self, start: Callable[[], Running]) -> None:
        """Open nothing yet; `start` gives the editor's server, when it is needed first."""
        self._start, self._lock = start, threading.Lock()
        self._running: Running | None = None
        self._decoder = LimitedProcess()

    @property
    def running(self) -> Running:
        """The editor's server."""
        with self._lock:
            if self._running is None:
                self._running = self._start()
            return self._running

    def close(self) -> None:
        """Stop decoding; whoever started the editor stops it."""
        self._decoder.stop()

    def folders(self) -> tuple[Path, ...]:
        """Folders of projects: those that are open, then those on disk."""
        editors = self.running.workspace.editors
        here = [e.session.project.folder for e in editors if e.session.project is not None]
        return tuple(dict.fromkeys([*here, *recent_projects(editors[0].session.projects_dir)]))

    def session(self, name: str) -> EditorSession:
        """The session of a project by the name of its folder, opened if necessary.

        Raises:
            UnknownProjectError: there is none.
            ProjectError, SceneError: it cannot be opened.
        """
        editor = self.running.workspace.editor(name)
        if editor is None:
            known = ", ".join(address_of(f) for f in self.folders()[:10]) or "none yet"
            raise UnknownProjectError(f"there is no project {shorten(name)!r}; there are: {known}")
        return editor.session

    def page(self, session: EditorSession) -> str:
        """Where a browser sees a session's project."""
        url, project = self.running.url, session.project
        return url if project is None else f"{url}{'&' if '?' in url else '?'}project={address_of(project.folder)}"

    def begin(self, upload: Upload, author: str) -> EditorSession:
        """Make a project of a photo and build its scene; every browser is offered to go there.

        Raises:
            InputError: a file cannot be used, or nothing is marked and no network finds furniture.
            ProjectError: the project cannot be written.
        """
        first = self.running.session
        project = begin_project(first.projects_dir, upload.name, decode(upload, self._decoder), upload.photo)
        keep_given(project, upload)
        session = self.session(address_of(project.folder))
        session.ui_thread.ask(lambda: build(session))
        self._announce(project, author)
        return session

    def describe(self, words: str, author: str) -> EditorSession:
        """Make a project of a description in words; every browser is offered to go there.

        Raises:
            InputError: nothing is described.
            ProjectError: the project cannot be written.
        """
        project, _ = creation(self.running.session, words)(Progress())
        self._announce(project, author)
        return self.session(address_of(project.folder))

    def _announce(self, project: Project, author: str) -> None:
        words, visit = f"{author or 'Another program'} builds {project.name}", self.running.workspace.visit
        for editor in self.running.workspace.editors:
            for client in tuple(editor.session.clients.values()):
                client.post(partial(client.offer, words, "Look", partial(visit, client, project)))


def edit(session: EditorSession, version: str, wanted: Sequence[Edit] | str, author: str) -> Edited:
    """Make edits as one undo step, all of them or none.

    Args:
        session: of the project.
        version: that they were made for.
        wanted: typed edits, or a command in words.
        author: who makes them.

    Raises:
        StaleVersionError: somebody has changed the scene since.
        EditRefused: one cannot be done.
    """

    def check() -> None:
        session.need_writable()
        need_version(session, version)

    session.ui_thread.ask(check)
    scene, library = session.scene, session.offer
    if isinstance(wanted, str):
        proposed = propose_edits(wanted, scene, library, language_model=LmmSettings.from_environment())
    else:
        proposed = apply_edits(wanted, scene, library)

    def commit() -> str:
        check()
        label = shorten(proposed.command or "; ".join(proposed.lines), MAX_LABEL)
        session.edit(label, lambda _: proposed.scene, author=author, by_hand=True)
        return session.document.version

    return Edited(proposed, session.ui_thread.ask(commit))


def need_version(session: EditorSession, version: str) -> None:
    """Raise `StaleVersionError` where the document has another version. On the UI thread."""
    now = session.document.version
    if version != now:
        entry = session.document.history.current
        last = f"“{entry.label}”" + (f" by {entry.author}" if entry.author else "")
        raise StaleVersionError(
            f"the scene is at version {now}, not {shorten(version)} (last change: {last}); look at it again"
        )


def room_of(session: EditorSession) -> Reconstruction:
    """The open scene as a value, to be drawn and exported beside the editor."""
    scene = session.scene
    if not scene.objects and not scene.architecture.planes:
        raise EditRefused("there is nothing in this project yet; build its scene first")
    return Reconstruction(scene, session.library, dict(session.textures), given=session.inputs, project=session.project)
