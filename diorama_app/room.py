"""One open project: the document, its jobs, and the browsers that look at it.

Everything here runs on the desk's thread, except where a method says otherwise. A change goes through `edit`; then
`refresh` brings the page in line with the document, and the project's folder follows within a second.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Protocol

import numpy as np
import viser
from jaxtyping import UInt8

from diorama_app.client_view import DEFAULT_FOV_RAD, ClientView, NoticeKind, room_view
from diorama_app.desk import Desk
from diorama_app.document import Document
from diorama_app.drafts import Draft
from diorama_app.jobs import Jobs, JobStatus, Outcome
from diorama_app.saver import Saver
from diorama_app.shapes import ShapeBytes
from diorama_app.thumbnails import Thumbnails
from diorama_app.viewport import Viewport
from diorama_core.artefacts import Photo
from diorama_core.errors import DioramaError, EditRefused
from diorama_core.library.record import ShapeLibrary
from diorama_core.project.storage import Project
from diorama_core.scene.types import Pose, Scene

JOB_TOLD_EVERY_S = 0.15
MESH_OVERLAP_S = 0.45
"""How long an old mesh stays while the browser parses its successor."""


class Panel(Protocol):
    """A part of the page that shows something of the room."""

    def refresh(self) -> None:
        """Draw what differs from what is drawn."""
        ...


class Room:
    """The open project and everyone in it."""

    def __init__(self, server: viser.ViserServer, library: ShapeLibrary, projects_dir: Path) -> None:
        self.server = server
        self.library = library
        self.projects_dir = projects_dir
        self.document = Document()
        self.draft = Draft()
        self.project: Project | None = None
        self.photo: Photo | None = None
        self.notes: tuple[str, ...] = ()
        """What the pipeline had to say of how the scene was made."""
        self.textures: Mapping[str, UInt8[np.ndarray, "h w 3"]] = {}
        self.views: dict[int, ClientView] = {}
        self.panels: list[Panel] = []
        self.job_panel: Panel | None = None
        self._job_told_at = 0.0
        self.desk = Desk(lambda message: self.notice_all(message, "bad"))
        self.jobs = Jobs(self._job_changed, self._job_ended)
        self.saver = Saver(on_error=lambda message: self.notice_all(message, "bad"))
        self.shapes = ShapeBytes(library)
        self.thumbnails = Thumbnails(library, on_ready=lambda: self.desk.post(self.refresh_panels, key="panels"))
        self.viewport = Viewport(server, self.shapes, pick=self._picked, later=self._later)
        self.on_photo_camera: Callable[[int], None] | None = None
        self.on_pick: Callable[[str, viser.SceneNodePointerEvent], None] | None = None

    # -- the document -----------------------------------------------------------------------------------------

    @property
    def scene(self) -> Scene:
        """The scene as it is now."""
        return self.document.scene

    def edit(
        self,
        label: str,
        change: Callable[[Scene], Scene],
        *,
        selection: Iterable[str] | None = None,
        merge_key: str | None = None,
    ) -> None:
        """Apply a pure edit as one undo step, show it and save it. A refused edit changes nothing."""
        try:
            self.document.edit(label, change, selection=selection, merge_key=merge_key)
        except DioramaError:
            self.refresh()  # fields and gizmo go back to what the document says
            raise
        self.changed()

    def commit(self, label: str, scene: Scene, *, selection: Iterable[str] | None = None) -> None:
        """Make a whole scene the current state as one undo step, show it and save it."""
        self.document.commit(label, scene, selection=selection)
        self.changed()

    def changed(self) -> None:
        """The document changed: show and save it."""
        self.refresh()
        if self.project is not None:
            self.saver.save_soon(self.project, self.scene)

    def select(self, ids: Iterable[str]) -> None:
        """Select exactly these objects."""
        self.document.select(ids)
        self.document.rebase_selection()
        self.refresh()

    def toggle(self, object_id: str) -> None:
        """Add an object to the selection, or take it out."""
        self.document.toggle(object_id)
        self.document.rebase_selection()
        self.refresh()

    def need_selected(self) -> str:
        """The object selected last; refuses with advice when there is none."""
        if not self.document.selection:
            raise EditRefused("nothing is selected; click an object first")
        return self.document.selection[-1]

    def preview(self, poses: Mapping[str, Pose]) -> None:
        """Show poses that are not (yet) part of the document."""
        self.viewport.preview(poses)

    def refresh(self) -> None:
        """Bring every browser in line with the document."""
        self.viewport.show(self.scene, self.document.selection, self.textures)
        for client_id in self.views:
            self._show_photo_camera(client_id)
        self.refresh_panels()

    def refresh_panels(self) -> None:
        """Redraw the panels only."""
        for panel in self.panels:
            panel.refresh()

    # -- projects ---------------------------------------------------------------------------------------------

    def open_project(self, project: Project) -> None:
        """Show another project; the one that was open is on disk already. Raises with nothing changed."""
        scene = project.load_scene()
        inputs = project.load_inputs()
        textures = project.textures(scene)
        self.saver.flush()
        self.project, self.textures = project, textures
        self.read_notes()
        self.photo = None if inputs is None else inputs.photo
        self.draft = Draft()
        if inputs is not None:
            self.draft = Draft(inputs, inputs.boxes, from_project=True, name=project.name)
        self.document.open(scene)
        self.show_everyone_the_room()
        self.refresh()

    def read_notes(self) -> None:
        """Learn what the project's build had to say."""
        notes = self.project.info().get("notes", []) if self.project is not None else []
        self.notes = tuple(dict.fromkeys(str(note) for note in notes))

    def show_everyone_the_room(self) -> None:
        """New visitors and all who are here look at the whole room."""
        position, target = room_view(self.scene)
        self.server.initial_camera.position = position
        self.server.initial_camera.look_at = target
        self.server.initial_camera.fov = float(DEFAULT_FOV_RAD)
        for view in self.views.values():
            view.show_backdrop(None, None, 1.0)
            view.show_overlay(None, None, 0.0)
            if not view.drawing:
                view.look(*room_view(self.scene, view.aspect))

    # -- browsers ---------------------------------------------------------------------------------------------

    def joined(self, client: viser.ClientHandle) -> None:
        """A browser connected (or reloaded): everything shared is replayed to it by the server."""
        self.views[client.client_id] = ClientView(client)
        self._show_photo_camera(client.client_id)
        self.refresh_panels()

    def left(self, client: viser.ClientHandle) -> None:
        """A browser went away."""
        self.views.pop(client.client_id, None)

    def notice(self, client_id: int | None, message: str, kind: NoticeKind = "info") -> None:
        """Tell one browser, or all when it is not known which."""
        view = self.views.get(client_id) if client_id is not None else None
        for one in [view] if view is not None else list(self.views.values()):
            one.notice(message, kind)

    def notice_all(self, message: str, kind: NoticeKind = "info") -> None:
        """Tell every browser."""
        self.notice(None, message, kind)

    def post(self, client_id: int | None, task: Callable[[], None], *, key: str | None = None) -> None:
        """Do `task` on the desk for one browser, which is told when it fails. May be called from any thread."""
        self.desk.post(task, key=key, on_error=lambda message: self.notice(client_id, message, "bad"))

    def close(self) -> None:
        """Stop jobs, write what is unsaved, end the threads. Called from outside the desk."""
        self.jobs.cancel()
        self.jobs.wait(5.0)
        self.desk.stop()
        self.saver.stop()
        self.thumbnails.stop()

    def _show_photo_camera(self, client_id: int) -> None:
        photo = None if self.photo is None else self.photo.rgb

        def through_it() -> None:
            if self.on_photo_camera is not None:
                ask = self.on_photo_camera
                self.post(client_id, lambda: ask(client_id))

        self.views[client_id].show_photo_camera(self.scene.camera, photo, through_it)

    def _picked(self, object_id: str, event: viser.SceneNodePointerEvent) -> None:
        if self.on_pick is not None:
            self.on_pick(object_id, event)

    def _later(self, task: Callable[[], None]) -> None:
        timer = threading.Timer(MESH_OVERLAP_S, lambda: self.desk.post(task))
        timer.daemon = True
        timer.start()

    def _job_changed(self, status: JobStatus) -> None:
        now = time.monotonic()
        begins = status.fraction == 0.0
        if begins or status.cancelling or now - self._job_told_at > JOB_TOLD_EVERY_S:
            self._job_told_at = now
            self.desk.post(
                self.refresh_panels if begins or self.job_panel is None else self.job_panel.refresh, key="job"
            )

    def _job_ended(self, outcome: Outcome) -> None:
        def tell() -> None:
            self.refresh()
            if outcome.cancelled:
                self.notice_all("Stopped; nothing was changed.")
            elif outcome.error is not None:
                self.notice_all(outcome.error, "bad")

        self.desk.post(tell)
