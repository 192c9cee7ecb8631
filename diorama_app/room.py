"""One open project: the document, its jobs, and the people who look at it.

Everything here runs on the desk's thread, except where a method says otherwise. A change goes through `edit`; then
`refresh` brings the page in line with the document, and the project's folder follows within a second.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

import numpy as np
import viser
from jaxtyping import UInt8

from diorama_app.checks import Checker, Problems
from diorama_app.client_view import NoticeKind
from diorama_app.clipboard import Clip
from diorama_app.desk import Desk
from diorama_app.document import Document
from diorama_app.drafts import Draft
from diorama_app.framing import DEFAULT_FOV_RAD, room_view
from diorama_app.guest import Guest
from diorama_app.jobs import Jobs, JobStatus, Outcome
from diorama_app.layout_run import LayoutRun
from diorama_app.preparing import Preparer
from diorama_app.saver import Saver
from diorama_app.shapes import ShapeBytes
from diorama_app.shelf import Records
from diorama_app.thumbnails import Thumbnails
from diorama_app.viewport import Viewport
from diorama_core.artefacts import Inputs, Photo
from diorama_core.errors import DioramaError
from diorama_core.library.record import ShapeLibrary
from diorama_core.project.storage import Project
from diorama_core.scene.types import Pose, Scene

JOB_TOLD_EVERY_S = 0.15
MESH_OVERLAP_S = 0.45
"""How long an old mesh stays while the browser parses its successor."""


class Room:
    """The open project and everyone in it."""

    def __init__(
        self, server: viser.ViserServer, library: ShapeLibrary, projects_dir: Path, *, low_graphics: bool = False
    ) -> None:
        self.server = server
        self.library: ShapeLibrary = library
        self.projects_dir = projects_dir
        self.low_graphics = low_graphics
        self.document = Document()
        self.draft = Draft()
        self.project: Project | None = None
        self._inputs_kept: Inputs | None = None
        """What is said of the photo, as it is in the project's folder."""
        self.photo: Photo | None = None
        self.notes: tuple[str, ...] = ()
        """What the pipeline had to say of how the scene was made."""
        self.textures: Mapping[str, UInt8[np.ndarray, "h w 3"]] = {}
        self.guests: dict[int, Guest] = {}
        self.badges: Problems = {}
        """What is wrong with objects just now, in a word or two each."""
        self.on_guest: Callable[[Guest], None] | None = None
        """Lays out the page of somebody who came."""
        self._guests_so_far = 0
        self.clip: Clip | None = None
        """What was copied last, in whichever project."""
        self.binned: Path | None = None
        """The project deleted last, until it is brought back."""
        self.layout_run: LayoutRun | None = None
        """The last optimisation, as the panels show it."""
        self._job_told_at = 0.0
        self.desk = Desk(lambda message: self.notice_all(message, "bad"))
        self.jobs = Jobs(self._job_changed, self._job_ended)
        self.saver = Saver(on_error=lambda message: self.notice_all(message, "bad"))
        self.shapes = ShapeBytes(library, light=low_graphics)
        self.preparer = Preparer(library)
        self.checker = Checker(library, lambda found: self.desk.post(lambda: self._badged(found)))
        self.records = Records(library)
        self.thumbnails = Thumbnails(library, self.records)
        self.viewport = Viewport(server, self.shapes, pick=self._picked, drag=self._dragged, later=self._later)
        self.on_photo_camera: Callable[[Guest], None] | None = None
        self.on_pick: Callable[[str, viser.SceneNodePointerEvent], None] | None = None
        self.on_drag: Callable[[str, viser.SceneNodeDragEvent], None] | None = None

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
        by: Guest | None = None,
        selection: Iterable[str] | None = None,
        merge_key: str | None = None,
        inputs: Inputs | None = None,
    ) -> None:
        """Apply a pure edit as one undo step, show it and save it. A refused edit changes nothing.

        Args:
            label: what is done, as the undo button and the toast say it.
            change: the edit.
            by: who does it.
            selection: what that person has selected afterwards; as before when None.
            merge_key: quick edits of the same key become one step.
            inputs: what is said of the photo from now on; as before when None.
        """
        try:
            scene = self._with_pictures_refitted(change(self.scene))
        except DioramaError:
            self.refresh()  # fields and gizmo go back to what the document says
            raise
        if scene == self.scene and inputs is None:
            self.refresh()
            return
        self.commit(label, scene, by=by, selection=selection, merge_key=merge_key, inputs=inputs)

    def _with_pictures_refitted(self, scene: Scene) -> Scene:
        """The edited scene with the pictures of resized planes cut and continued, not stretched."""
        if not self.textures or scene.architecture is self.scene.architecture:
            return scene
        from diorama_core.architecture.refit import refitted_textures  # OpenCV; opening a project does without it

        scene, made = refitted_textures(self.scene, scene, self.textures)
        if made:
            self.textures = {**self.textures, **made}
            if self.project is not None:
                self.project.save_textures(made)
        return scene

    def commit(
        self,
        label: str,
        scene: Scene,
        *,
        by: Guest | None = None,
        selection: Iterable[str] | None = None,
        merge_key: str | None = None,
        inputs: Inputs | None = None,
    ) -> None:
        """Make a whole scene the current state as one undo step, show it and save it."""
        if by is not None and selection is not None:
            by.selection = tuple(selection)
        chosen = () if by is None else tuple(i for i in by.selection if scene.has_object(i))
        self.document.commit(label, scene, selection=chosen, merge_key=merge_key, inputs=inputs)
        self.changed()
        for guest in self.guests.values():
            who = "" if guest is by or by is None else f"{by.name}: "
            guest.toast(f"{who}{label[:1].upper()}{label[1:]}", True)

    def undo(self, by: Guest) -> None:
        """Take back the last change, whoever made it."""
        undone = self.document.undo()
        self._time_travelled(by, f"Undone: {undone.label}", self.document.history.current.selection)

    def redo(self, by: Guest) -> None:
        """Do again what was undone."""
        done = self.document.redo()
        self._time_travelled(by, f"Done again: {done.label}", done.selection)

    def _time_travelled(self, by: Guest, message: str, selection: tuple[str, ...]) -> None:
        by.selection = selection or by.selection
        self.changed()
        for guest in self.guests.values():
            guest.toast(message, False)

    def changed(self) -> None:
        """The document changed: show and save it."""
        self._follow_inputs()
        self.refresh()
        self.checker.look_at(self.scene)
        if self.project is not None:
            self.saver.save_soon(self.project, self.scene)

    def _follow_inputs(self) -> None:
        """What is said of the photo changed: the next build starts from that, in this session and in later ones."""
        inputs = self.document.inputs
        if inputs is None or inputs is self._inputs_kept:
            return
        try:
            if self.project is not None:
                self.project.save_inputs(inputs, self.project.info().get("warnings", ()))
        except DioramaError as error:
            self.notice_all(f"what you said of the photo is not saved: {error}", "bad")
        if self.draft.from_project:
            self.draft = self.draft.following(inputs)
        self._inputs_kept, self.photo = inputs, inputs.photo

    def _badged(self, found: Problems) -> None:
        self.badges = found
        self.refresh_panels()

    def preview(self, poses: Mapping[str, Pose]) -> None:
        """Show poses that are not (yet) part of the document."""
        self.viewport.preview(poses)

    def refresh(self) -> None:
        """Bring every browser in line with the document."""
        self.viewport.show(self.scene, self.textures)
        self.preparer.want(o.shape_id for o in self.scene.objects)
        for guest in self.guests.values():
            guest.drop_missing()
            self._show_photo_camera(guest)
            guest.refresh()

    def refresh_panels(self) -> None:
        """Redraw the panels only."""
        for guest in self.guests.values():
            guest.refresh()

    def refresh_cursors(self) -> None:
        """Redraw what everyone sees of the others' selections."""
        for guest in self.guests.values():
            guest.refresh()

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
        self.shapes.expect(len(scene.objects))
        if inputs is not None:
            self.draft = Draft(inputs, inputs.boxes, from_project=True, name=project.name)
        self.document.open(scene, inputs)
        self._inputs_kept = inputs
        self.layout_run = None
        self.show_everyone_the_room()
        self.refresh()
        self.checker.look_at(scene)

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
        for guest in self.guests.values():
            guest.selection = ()
            guest.doing = None
            guest.view.show_backdrop(None, None, 1.0)
            guest.view.show_overlay(None, None, 0.0)
            if not guest.view.drawing:
                guest.view.look(*room_view(self.scene, guest.view.aspect))

    # -- people -----------------------------------------------------------------------------------------------

    def joined(self, client: viser.ClientHandle) -> None:
        """A browser connected (or reloaded): the shared scene is replayed to it by the server, its panels are made."""
        self._guests_so_far += 1
        guest = self.guests[client.client_id] = Guest(self, client, self._guests_so_far)
        with client.atomic():
            if self.on_guest is not None:
                self.on_guest(guest)
            self._show_photo_camera(guest)
            guest.refresh()

    def left(self, client: viser.ClientHandle) -> None:
        """A browser went away."""
        self.guests.pop(client.client_id, None)
        self.refresh_cursors()

    def notice(self, client_id: int | None, message: str, kind: NoticeKind = "info") -> None:
        """Tell one person, or all when it is not known which."""
        guest = self.guests.get(client_id) if client_id is not None else None
        for one in [guest] if guest is not None else list(self.guests.values()):
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
        self.checker.stop()
        self.preparer.stop()
        self.thumbnails.stop()

    def _show_photo_camera(self, guest: Guest) -> None:
        photo = None if self.photo is None else self.photo.rgb

        def through_it() -> None:
            if self.on_photo_camera is not None:
                ask = self.on_photo_camera
                guest.post(lambda: ask(guest))

        guest.view.show_photo_camera(self.scene.camera, photo, through_it)

    def _picked(self, object_id: str, event: viser.SceneNodePointerEvent) -> None:
        if self.on_pick is not None:
            self.on_pick(object_id, event)

    def _dragged(self, object_id: str, event: viser.SceneNodeDragEvent) -> None:
        if self.on_drag is not None:
            self.on_drag(object_id, event)

    def _later(self, task: Callable[[], None]) -> None:
        timer = threading.Timer(MESH_OVERLAP_S, lambda: self.desk.post(task))
        timer.daemon = True
        timer.start()

    def _job_changed(self, status: JobStatus) -> None:
        now = time.monotonic()
        begins = status.fraction == 0.0
        if begins or status.cancelling or now - self._job_told_at > JOB_TOLD_EVERY_S:
            self._job_told_at = now
            self.desk.post(self.refresh_panels if begins else self._refresh_job, key="job")

    def _refresh_job(self) -> None:
        for guest in self.guests.values():
            if guest.job_panel is not None:
                guest.job_panel.refresh()

    def _job_ended(self, outcome: Outcome) -> None:
        def tell() -> None:
            self.refresh()
            if outcome.cancelled:
                self.notice_all("Stopped; nothing was changed.")
            elif outcome.error is not None:
                self.notice_all(outcome.error, "bad")

        self.desk.post(tell)
