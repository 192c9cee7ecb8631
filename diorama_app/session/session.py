"""One open project: the document, its jobs, and the people who look at it.

Everything here runs on the UI thread, except where a method says otherwise. A change goes through `edit`; then
`refresh` brings the page in line with the document, and the project's folder follows within a second.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import viser

from diorama_app.session.connected_client import ConnectedClient
from diorama_app.session.jobs import Jobs, Outcome
from diorama_app.session.layout_run import LayoutRun
from diorama_app.session.preparation import Preparer
from diorama_app.session.problem_checker import Checker, Problems
from diorama_app.session.project_contents import read_project
from diorama_app.session.project_saving import ProjectSaving
from diorama_app.session.reading import Reader
from diorama_app.session.redraws import Glances, JobReports
from diorama_app.session.shared_document import SharedDocument
from diorama_app.session.shared_view import SharedView
from diorama_app.session.ui_thread import UiThread
from diorama_app.strings import _
from diorama_app.viewport.camera import room_view
from diorama_app.viewport.client_view import NoticeKind
from diorama_app.viewport.mesh_assets import ShapeBytes
from diorama_app.viewport.scene_view import Viewport
from diorama_app.viewport.thumbnails import Thumbnails
from diorama_core.artefacts import Reason
from diorama_core.editing.clipboard import Clip
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.user_library import ProjectShapes, ShapeRecords, offer_shapes
from diorama_core.project.storage import Project


@dataclass
class Shared:
    """What all open projects have in common."""

    clip: Clip | None = None
    """The clipboard."""


BUILDING = "building"
"""Entry of a project's file while its scene is built: since when."""

MakeClient = Callable[["EditorSession", viser.ClientHandle, int], ConnectedClient]


class EditorSession(SharedDocument):
    """The open project and everyone in it."""

    def __init__(
        self,
        server: viser.ViserServer,
        library: ShapeLibrary,
        projects_dir: Path,
        make_client: MakeClient,
        *,
        low_graphics: bool = False,
    ) -> None:
        super().__init__(ProjectSaving(self._saver_says, lambda: self.ui_thread.post(self._look_again)))
        self.autosave = self.saving.autosave
        self.server = server
        self._make_client = make_client
        self.library: ShapeLibrary = library
        self.projects_dir = projects_dir
        self.low_graphics = low_graphics
        self.notes: tuple[str, ...] = ()
        """Notes of the pipeline about how the scene was made."""
        self.reasons: tuple[Reason, ...] = ()
        """Why objects are where and what the build made them."""
        self.badges: Problems = {}
        """Current problems of objects, in a word or two each."""
        self.on_client: Callable[[Any], None] | None = None
        """Creates the page of a newly connected client."""
        self._clients_so_far = 0
        self.shared = Shared()
        self.visit: Callable[[ConnectedClient, Project, str], None] = self._open_here
        """Takes a client to a project and says something there; raises when it cannot be opened."""
        self.on_left: Callable[[], None] = lambda: None
        """Told when a client went away."""
        self.greeting: tuple[str, NoticeKind] | None = None
        """What the next client is told that comes."""
        self.watchers: set[Callable[[], None]] = set()
        """Told on the UI thread that the document changed or a job went on."""
        self.outcome: Outcome | None = None
        """How the last job ended."""
        self.glances = Glances()
        self.layout_run: LayoutRun | None = None
        """The last optimisation run."""
        self.ui_thread = UiThread(lambda message: self.notice_all(message, "bad"))
        reports = JobReports(
            self.ui_thread, on_start=self.refresh_panels, on_progress=self._refresh_job, on_end=self._job_ended
        )
        self.jobs = Jobs(reports.update, reports.end)
        self.greets = False
        """Whether browsers that come here see the start page first."""
        self.interrupted = False
        """Whether a build of this project was under way when the program ended."""
        self.reader = Reader()
        self.checker = Checker(library, lambda badges: self.ui_thread.post(lambda: self._show_badges(badges)))
        self.records = ShapeRecords(library)
        self.thumbnails = Thumbnails(library, self.records)
        self.shapes = ShapeBytes(library, light=low_graphics)
        self.preparer = Preparer(library)
        self.view = SharedView(self, server, self.ui_thread, self.shapes, self.preparer)

    @property
    def offer(self) -> ShapeLibrary:
        """The library as builds and words choose from it: without people's own models unless they asked for that."""
        return offer_shapes(self.library)

    def save_and_show(self, by: ConnectedClient | None = None) -> None:
        """The document changed: save and show it. Nothing that is shown can keep it from being saved."""
        if self.project is not None:
            self.saving.save_soon(self.project, self.document, self.library)
        self.refresh(by)
        self.checker.look_at(self.scene)
        self._tell_watchers()

    def _tell_watchers(self) -> None:
        for watcher in tuple(self.watchers):
            watcher()

    def _show_badges(self, badges: Problems) -> None:
        self.badges = badges
        self.refresh_panels()

    @property
    def viewport(self) -> Viewport:
        """The scene as all browsers see it."""
        return self.view.viewport

    def refresh(self, by: ConnectedClient | None = None) -> None:
        """Bring every browser in line with the document; see `SharedView.refresh`."""
        self.view.refresh(by)

    def refresh_panels(self, by: ConnectedClient | None = None) -> None:
        """Redraw the panels, and what everyone sees of the others' selections."""
        self.view.refresh_panels(by)

    # -- projects ---------------------------------------------------------------------------------------------

    def open_project(self, project: Project) -> None:
        """Show another project; the one that was open is on disk already. Raises with nothing changed.

        One that another program has open is only looked at; of one whose scene is damaged the newest good version
        is shown, and the page says so.
        """
        read = read_project(project)
        if isinstance(self.library, ProjectShapes):
            self.library.show(project.shapes_folder)
        self.saving.take(project)
        self.project, self.textures, self.notes, self.reasons = project, read.textures, read.notes, read.reasons
        self.glances.forget()
        self.interrupted = project.info().get(BUILDING) is not None
        self.shapes.expect(len(read.scene.objects))
        self.document.open(read.scene, read.inputs, read.further_photos)
        self.saving.is_saved(self.document)
        self.layout_run = None
        for client in self.clients.values():
            client.forget_choices()
        self.view.show_whole_room()
        self.refresh()
        for client in self.clients.values():
            self._show_where_left(client)
        self.checker.look_at(read.scene)
        for line in (self.read_only, self.saving.access.unwritable, *read.damage):
            if line:
                self.notice_all(line, "bad")

    @property
    def is_unbuilt(self) -> bool:
        """Whether the project has a photo and nothing was built of it yet."""
        empty = not self.scene.objects and not self.scene.architecture.planes
        return self.inputs is not None and empty and self.project is not None and not self.project.has_scene

    def _show_where_left(self, client: ConnectedClient) -> None:
        """An unfinished project opens where its boxes are drawn."""
        if self.is_unbuilt:
            client.open_tab("Photo")
            client.open_board()

    def _open_here(self, client: ConnectedClient, project: Project, message: str = "") -> None:
        self.open_project(project)
        if message:
            self.notice_all(message, "good")

    def _saver_says(self, message: str, kind: NoticeKind) -> None:
        def tell() -> None:
            self.notice_all(message, kind)
            self._look_again()

        self.ui_thread.post(tell)

    def _look_again(self) -> None:
        """What is on disk changed: the panels show it."""
        self.glances.forget()
        self.refresh_panels()

    # -- people -----------------------------------------------------------------------------------------------

    def join(self, viser_client: viser.ClientHandle) -> None:
        """A browser connected (or reloaded): the shared scene is replayed to it by the server, its panels are made."""
        self._clients_so_far += 1
        client = self.clients[viser_client.client_id] = self._make_client(self, viser_client, self._clients_so_far)
        with viser_client.atomic():
            if self.on_client is not None:
                self.on_client(client)
            self.view.show_photo_camera(client)
            client.refresh()
        client.view.camera.frame(partial(room_view, self.scene))
        self._follow_shape(client, viser_client)
        self._show_where_left(client)
        if self.greeting is not None:
            (message, kind), self.greeting = self.greeting, None
            client.notice(message, kind)

    def _follow_shape(self, client: ConnectedClient, viser_client: viser.ClientHandle) -> None:
        """What is framed in a browser stays in view when panels or the window change the view's shape."""

        async def look(_: viser.CameraHandle) -> None:
            client.post(client.view.camera.frame_again, key="frame")

        viser_client.camera.on_update(look)

    def leave(self, viser_client: viser.ClientHandle) -> None:
        """A browser went away."""
        client = self.clients.pop(viser_client.client_id, None)
        if client is not None:
            client.has_left = True
        self.ui_thread.forget(viser_client.client_id)
        self.refresh_panels()
        self.on_left()

    def post(self, client_id: int | None, task: Callable[[], object], *, key: str | None = None) -> None:
        """Do `task` on the UI thread for one browser, which is told when it fails. May be called from any thread.

        Only the last of several tasks with the same key is done.
        """
        self.ui_thread.post(
            task, key=key, client_id=client_id, on_error=lambda message: self.notice(client_id, message, "bad")
        )

    def close(self) -> None:
        """Stop jobs, write what is unsaved, end the threads. Called from outside the UI thread."""
        self.jobs.cancel()
        self.jobs.wait(5.0)
        self.ui_thread.stop()
        self.saving.close()
        self.checker.stop()
        self.preparer.stop()
        self.reader.close()
        self.thumbnails.stop()
        for client in self.clients.values():
            client.has_left = True

    def _refresh_job(self) -> None:
        self._tell_watchers()
        for client in self.clients.values():
            if client.job_panel is not None:
                client.job_panel.refresh()

    def _job_ended(self, outcome: Outcome) -> None:
        self.outcome = outcome
        self.glances.forget()
        self.refresh()
        self._tell_watchers()
        if outcome.cancelled:
            if not outcome.in_favour:
                self.notice_all(_("Cancelled; nothing was changed."))
        elif outcome.error is not None:
            self.notice_all(outcome.error, "bad")
