"""The projects that are open on one server: each has an editor of its own, and a browser sees the one in its address.

An address without a project leads to the first one. A project is opened when the first browser asks for it and closed
some time after the last one left, unless a job of it is running.
"""

from __future__ import annotations

import logging
import threading
import time
from concurrent.futures import Future
from pathlib import Path

import viser

from diorama_app.app import Editor
from diorama_app.projects.manage import address_of, find_project
from diorama_app.session.connected_client import ConnectedClient
from diorama_app.strings import _
from diorama_app.web.viser_adapter import create_server_without_port, stop_server
from diorama_core.errors import DioramaError
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.user_library import UserLibrary
from diorama_core.project.storage import Project

log = logging.getLogger(__name__)

CLOSED_AFTER_S = 60.0
"""How long a project stays open that nobody looks at: a reload must find it as it was."""


class Workspace:
    """Implements `ProjectServers`. May be used from any thread."""

    def __init__(self, library: ShapeLibrary, projects_dir: Path, *, low_graphics: bool) -> None:
        """Without any project at first.

        Args:
            library: where shapes come from, the same for all projects.
            projects_dir: where projects are found by the name in the address.
            low_graphics: no shadows, no environment map.
        """
        self._library = UserLibrary(library)
        self._projects_dir = projects_dir
        self._low_graphics = low_graphics
        self._lock = threading.RLock()
        self._editors: list[Editor] = []
        self._front: viser.ViserServer | None = None
        """The server that has the port."""
        self._asked_for: dict[Editor, float] = {}
        self._timer: threading.Timer | None = None
        self._left_meanwhile = False
        """Whether pages were closed since the timer began."""

    def begin(self, server: viser.ViserServer, project: Project | None) -> Editor:
        """Put the first editor on the server that has the port."""
        with self._lock:
            self._front = server
            return self._add(server, project)

    @property
    def editors(self) -> tuple[Editor, ...]:
        """Those of all open projects, the first one first."""
        return tuple(self._editors)

    def first(self) -> str | None:
        """The project of an address that names none."""
        project = self._editors[0].session.project if self._editors else None
        return None if project is None else address_of(project.folder)

    def server(self, name: str) -> viser.ViserServer | None:
        """The server of a project by the name of its folder; None where it cannot be opened."""
        try:
            editor = self.editor(name)
        except DioramaError as error:
            log.warning("the project %s is not opened: %s", name, error)
            editor = None
        if editor is not None:
            return editor.server
        with self._lock:
            if self._editors:
                self._editors[0].session.greeting = (
                    _("There is no project called “{name}” to open here.").format(name=name[:60]),
                    "bad",
                )
        return None

    def editor(self, name: str) -> Editor | None:
        """The editor of a project by the name of its folder, opened if necessary; None where there is no such project.

        Raises:
            ProjectError, SceneError: it cannot be opened.
        """
        with self._lock:
            for editor in self._editors:
                project = editor.session.project
                if project is not None and address_of(project.folder) == name:
                    self._asked_for[editor] = time.monotonic()
                    return editor
            folder = find_project(self._projects_dir, name)
            return None if folder is None else self._editor_of(Project.open(folder))

    def visit(self, client: ConnectedClient, project: Project, message: str = "") -> None:
        """Take one browser to a project, opened if necessary.

        Args:
            client: whose browser.
            project: where to.
            message: what is said there.

        Raises:
            ProjectError, SceneError: it cannot be opened; the browser stays where it is.
        """
        with self._lock:
            editor = self._editor_of(project)
        if message:
            editor.session.greeting = (message, "good")
        client.go_to(address_of(project.folder))

    def picture(self, name: str) -> Future[bytes | None]:
        """The picture of a shape that one of the pages shows."""
        for editor in self.editors:
            if editor.session.thumbnails.knows(name):
                return editor.session.thumbnails.png(name)
        none_yet: Future[bytes | None] = Future()  # a page of an earlier server asks before the editor is there
        none_yet.set_result(None)
        return none_yet

    def close(self) -> None:
        """Save and end everything that runs."""
        with self._lock:
            editors, self._editors = self._editors, []
        for editor in editors:
            editor.close()
        for editor in editors[1:]:
            stop_server(editor.server)

    def close_unused(self, *, at_once: bool = False) -> None:
        """Close projects that nobody looks at and that have nothing to do, some time after they were asked for."""
        with self._lock:
            for editor in self.editors[1:]:
                session = editor.session
                left_alone = at_once or time.monotonic() - self._asked_for.get(editor, 0.0) > CLOSED_AFTER_S
                watched = bool(session.clients or session.watchers)
                if left_alone and not watched and session.jobs.status is None:
                    self._editors.remove(editor)
                    self._asked_for.pop(editor, None)
                    editor.close()
                    stop_server(editor.server)

    def _editor_of(self, project: Project) -> Editor:
        for editor in self._editors:
            shown = editor.session.project
            if shown is not None and shown.folder.resolve() == project.folder.resolve():
                self._asked_for[editor] = time.monotonic()
                return editor
        assert self._front is not None, "begin comes first"
        made: list[Editor] = []
        server = create_server_without_port(
            "Diorama", front=self._front, refused=lambda client, line: made[0].refuse_upload(client, line)
        )
        try:
            made.append(self._add(server, project))
        except BaseException:
            stop_server(server)
            raise
        return made[0]

    def _add(self, server: viser.ViserServer, project: Project | None) -> Editor:
        editor = Editor(server, self._library, self._projects_dir, low_graphics=self._low_graphics)
        session = editor.session
        session.visit = self.visit
        session.on_left = self._leave
        if self._editors:
            session.shared = self._editors[0].session.shared
        try:
            editor.open_first(project)
        except BaseException:
            editor.close()
            raise
        self._editors.append(editor)
        self._asked_for[editor] = time.monotonic()
        return editor

    def _leave(self) -> None:
        """A page was closed: look a while later whether its project is still needed. One timer, however many left."""
        with self._lock:
            if self._timer is not None and self._timer.is_alive():
                self._left_meanwhile = True
                return
            self._timer = threading.Timer(CLOSED_AFTER_S + 1.0, self._look_for_unused)
            self._timer.daemon = True
            self._timer.start()

    def _look_for_unused(self) -> None:
        self.close_unused()
        with self._lock:
            busy = any(not editor.session.clients for editor in self._editors[1:])
            again, self._left_meanwhile, self._timer = self._left_meanwhile or busy, False, None
        if again:
            self._leave()
