"""One open project: the document, its jobs, and the people who look at it.

Everything here runs on the UI thread, except where a method says otherwise. A change goes through `edit`; then
`refresh` brings the page in line with the document, and the project's folder follows within a second.
"""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import viser

from diorama_app.session.autosave import Autosave
from diorama_app.session.connected_client import ConnectedClient
from diorama_app.session.document import Document, IsMine
from diorama_app.session.glances import Glances
from diorama_app.session.job_reports import JobReports
from diorama_app.session.jobs import Jobs, Outcome
from diorama_app.session.layout_run import LayoutRun
from diorama_app.session.problem_checker import Checker, Problems
from diorama_app.session.project_access import ProjectAccess
from diorama_app.session.project_contents import read_project
from diorama_app.session.reading import Reader
from diorama_app.session.shape_preparation import Preparer
from diorama_app.session.shared_view import SharedView
from diorama_app.session.textures import Textures, refitted
from diorama_app.session.ui_thread import UiThread
from diorama_app.viewport.client_view import NoticeKind
from diorama_app.viewport.framing import room_view
from diorama_app.viewport.mesh_assets import ShapeBytes
from diorama_app.viewport.scene_view import Viewport
from diorama_app.viewport.thumbnails import Thumbnails
from diorama_core.artefacts import FurtherPhoto, Inputs, Photo, Reason
from diorama_core.editing.clipboard import Clip
from diorama_core.editing.hand_placed import noted_by_hand
from diorama_core.errors import DioramaError, EditRefused
from diorama_core.io.bounded import shortened
from diorama_core.library.library_names import BUILT_IN
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.user_library import OWN, ProjectShapes, ShapeRecords, UserLibrary, offered_shapes
from diorama_core.project.storage import Project
from diorama_core.scene.history import Entry
from diorama_core.scene.schema import check_limits
from diorama_core.scene.types import Pose, Scene

log = logging.getLogger(__name__)


@dataclass
class Shared:
    """What all open projects have in common."""

    clip: Clip | None = None
    """The clipboard."""


BUILDING = "building"
"""Entry of a project's file while its scene is built: since when."""

MakeClient = Callable[["EditorSession", viser.ClientHandle, int], ConnectedClient]


class EditorSession:
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
        self.server = server
        self._make_client = make_client
        self.library: ShapeLibrary = library
        self.projects_dir = projects_dir
        self.low_graphics = low_graphics
        self.document = Document()
        self.project: Project | None = None
        self._inputs_saved: Inputs | None = None
        """Corrections of the photo as saved in the project's folder."""
        self._further_saved: tuple[FurtherPhoto, ...] = ()
        self.photo: Photo | None = None
        self.notes: tuple[str, ...] = ()
        """Notes of the pipeline about how the scene was made."""
        self.reasons: tuple[Reason, ...] = ()
        """Why objects are where and what the build made them."""
        self.textures: Textures = {}
        self.clients: dict[int, ConnectedClient] = {}
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
        self.jobs = Jobs(reports.changed, reports.ended)
        self.greets = False
        """Whether browsers that come here see the start page first."""
        self.interrupted = False
        """Whether a build of this project was under way when the program ended."""
        self.autosave = Autosave(
            on_error=lambda line: self._saver_says(line, "bad"),
            on_saved=self._saver_says,
            on_version=lambda: self.ui_thread.post(self._look_again),
        )
        self._access = ProjectAccess()
        self.reader = Reader()
        self.checker = Checker(library, lambda found: self.ui_thread.post(lambda: self._badged(found)))
        self.records = ShapeRecords(library)
        self.thumbnails = Thumbnails(library, self.records)
        self.shapes = ShapeBytes(library, light=low_graphics)
        self.preparer = Preparer(library)
        self.view = SharedView(self, self.shapes, self.preparer)

    @property
    def clip(self) -> Clip | None:
        """The clipboard, shared by all projects."""
        return self.shared.clip

    @clip.setter
    def clip(self, clip: Clip | None) -> None:
        self.shared.clip = clip

    @property
    def offered(self) -> ShapeLibrary:
        """The library as builds and words choose from it: without people's own models unless they asked for that."""
        return offered_shapes(self.library)

    # -- the document -----------------------------------------------------------------------------------------

    @property
    def scene(self) -> Scene:
        """The scene as it is now."""
        return self.document.scene

    @property
    def inputs(self) -> Inputs | None:
        """The photo with everything that is said of it; None without one."""
        return self.document.inputs

    @property
    def further_photos(self) -> tuple[FurtherPhoto, ...]:
        """The other photos of the same room."""
        return self.document.further_photos

    def annotate_further(
        self, label: str, further: Iterable[FurtherPhoto], *, by: ConnectedClient | None = None
    ) -> None:
        """Change the other photos of the room, as one undo step; the scene stays as it is.

        Args:
            label: name of the undo step.
            further: the photos from now on.
            by: who did it; None for the server itself.
        """
        self.commit(label, self.scene, by=by, further=tuple(further))

    def annotate(
        self, label: str, inputs: Inputs, *, by: ConnectedClient | None = None, merge_key: str | None = None
    ) -> None:
        """Change what is said of the photo, as one undo step; the scene stays as it is.

        Args:
            label: name of the undo step.
            inputs: from now on.
            by: who did it; None for the server itself.
            merge_key: steps with the same key become one.
        """
        self.commit(label, self.scene, by=by, inputs=inputs, merge_key=merge_key)

    def edit(
        self,
        label: str,
        change: Callable[[Scene], Scene],
        *,
        by: ConnectedClient | None = None,
        selection: Iterable[str] | None = None,
        merge_key: str | None = None,
        inputs: Inputs | None = None,
        by_hand: bool = False,
        author: str = "",
    ) -> None:
        """Apply a pure edit as one undo step, show it and save it. A refused edit changes nothing.

        Args:
            label: what is done, as the undo button and the toast say it.
            change: the edit.
            by: who does it.
            selection: what that person has selected afterwards; as before when None.
            merge_key: quick edits of the same key become one step.
            inputs: what is said of the photo from now on; as before when None.
            by_hand: whether objects are put where the person wants them, so that no automatic step moves them.
            author: who does it where no browser does: the name of another program.
        """
        try:
            self.need_writable()
            scene = change(self.scene)
            scene = noted_by_hand(self.scene, scene) if by_hand else scene
            check_limits(scene, self.scene)
            scene = self._with_pictures_refitted(scene)
        except DioramaError:
            self.refresh(by)  # fields and gizmo go back to what the document says
            raise
        except ValueError as error:  # the scene's own values refuse what is no number
            self.refresh(by)
            raise EditRefused(f"this is not possible: {shortened(str(error))}; give another value") from error
        if scene == self.scene and inputs is None:
            self.refresh(by)
            return
        self.commit(label, scene, by=by, selection=selection, merge_key=merge_key, inputs=inputs, author=author)

    def _with_pictures_refitted(self, scene: Scene) -> Scene:
        """The edited scene with the pictures of resized planes cut and continued, not stretched."""
        scene, made = refitted(self.scene, scene, self.textures)
        self.add_textures(made)
        return scene

    def add_textures(self, made: Textures) -> None:
        """Have pictures for scenes to name, and save them."""
        if not made:
            return
        self.textures = {**self.textures, **made}
        if self.project is not None:
            self.project.save_textures(made)

    def commit(
        self,
        label: str,
        scene: Scene,
        *,
        by: ConnectedClient | None = None,
        selection: Iterable[str] | None = None,
        merge_key: str | None = None,
        inputs: Inputs | None = None,
        further: tuple[FurtherPhoto, ...] | None = None,
        author: str = "",
    ) -> None:
        """Make a whole scene the current state as one undo step, save it and show it.

        Args:
            label: name of the undo step.
            scene: from now on.
            by: who did it; None for the server itself.
            selection: ids that are selected from now on; None leaves it.
            merge_key: steps with the same key become one.
            inputs: from now on; None leaves them.
            further: other photos from now on; None leaves them.
            author: who did it where no browser did: the name of another program.
        """
        self.need_writable()
        if by is not None and selection is not None:
            by.selection = tuple(selection)
        chosen = () if by is None else tuple(i for i in by.selection if scene.has_object(i))
        author = author if by is None else by.name
        self.document.commit(
            label, scene, selection=chosen, merge_key=merge_key, inputs=inputs, further=further, author=author
        )
        for client in self.clients.values():
            who = f"{author}: " if author and client is not by else ""
            client.to_say = (f"{who}{label[:1].upper()}{label[1:]}", by is None or client is by)
        self.changed(by)

    @property
    def read_only(self) -> str:
        """Why the open project is read-only; empty when it is writable."""
        return self._access.read_only

    def need_writable(self) -> None:
        """Raise `EditRefused` when the open project cannot be changed here."""
        self._access.need_writable()

    def undo(self, by: ConnectedClient | str) -> Entry:
        """Take back the last change of a person, or of a program by its name; see `scene.commuting` for the rule.

        Of a person, also one of somebody who has left or of a program.
        """
        self.need_writable()
        undone = self.document.undo(self._own(by))
        self._time_travelled(by, f"Undone: {undone.label}", self.document.history.current.selection)
        return undone

    def _own(self, by: ConnectedClient | str) -> IsMine:
        if isinstance(by, str):
            return lambda entry: entry.author == by
        return partial(self.is_of, by)

    def is_of(self, person: ConnectedClient, entry: Entry) -> bool:
        """Whether a change is a person's to take back: nobody else who is here made it."""
        return all(entry.author != c.name for c in self.clients.values() if c is not person)

    def redo(self, by: ConnectedClient | str) -> Entry:
        """Do again what a person, or a program by its name, undid."""
        self.need_writable()
        done = self.document.redo(self._own(by))
        self._time_travelled(by, f"Redone: {done.label}", done.selection)
        return done

    def _time_travelled(self, by: ConnectedClient | str, message: str, selection: tuple[str, ...]) -> None:
        person = None if isinstance(by, str) else by
        if person is not None:
            person.selection = selection or person.selection
        for client in self.clients.values():
            client.to_say = (message, False)
        self.changed(person)

    def changed(self, by: ConnectedClient | None = None) -> None:
        """The document changed: save and show it. Nothing that is shown can keep it from being saved."""
        inputs = self.document.inputs
        if self.project is not None:
            begun = bool(self.scene.objects or self.scene.architecture.planes) or self.project.has_scene
            unsaved = None if inputs is self._inputs_saved else inputs
            further = self.further_photos
            self._note_library(self.project)
            self.autosave.save_soon(
                self.project,
                self.scene if begun else None,
                unsaved,
                None if further is self._further_saved else further,
            )
        self._inputs_saved, self._further_saved = inputs, self.further_photos
        self.photo = None if inputs is None else inputs.photo
        self.refresh(by)
        self.checker.look_at(self.scene)
        self._tell_watchers()

    def _tell_watchers(self) -> None:
        for told in tuple(self.watchers):
            told()

    def _note_library(self, project: Project) -> None:
        """Commands that open this project must find the models of people's own that stand in it."""
        library = self.library
        if not isinstance(library, UserLibrary) or OWN in project.shared_library_name.split("+"):
            return
        if not {s.id for s in library.uploads()}.isdisjoint(o.shape_id for o in self.scene.objects):
            project.update_info(library=f"{project.info().get('library', BUILT_IN)}+{OWN}")

    def _badged(self, found: Problems) -> None:
        self.badges = found
        self.refresh_panels()

    @property
    def viewport(self) -> Viewport:
        """The scene as all browsers see it."""
        return self.view.viewport

    def preview(self, poses: Mapping[str, Pose]) -> None:
        """Show poses that are not (yet) part of the document."""
        self.viewport.preview(poses)

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
        scene, inputs = read.scene, read.inputs
        if isinstance(self.library, ProjectShapes):
            self.library.show(project.shapes_folder)
        self.autosave.flush()
        if self._access.take(project):
            with contextlib.suppress(OSError):  # leftovers that cannot be removed disturb nobody
                self.autosave.recovery.clean_up(project)
        self.project, self.textures, self.notes, self.reasons = project, read.textures, read.notes, read.reasons
        self.glances.forget()
        self.photo = None if inputs is None else inputs.photo
        self.interrupted = project.info().get(BUILDING) is not None
        self.shapes.expect(len(scene.objects))
        self.document.open(scene, inputs, read.further_photos)
        self._inputs_saved, self._further_saved = inputs, read.further_photos
        self.layout_run = None
        for client in self.clients.values():
            client.view.canvas.close()
        self.view.show_whole_room()
        self.refresh()
        for client in self.clients.values():
            self._show_where_left(client)
        self.checker.look_at(scene)
        for line in (self.read_only, self._access.unwritable, *read.damage):
            if line:
                self.notice_all(line, "bad")

    @property
    def unfinished(self) -> bool:
        """Whether the project has a photo and nothing was built of it yet."""
        empty = not self.scene.objects and not self.scene.architecture.planes
        return self.inputs is not None and empty and self.project is not None and not self.project.has_scene

    def _show_where_left(self, client: ConnectedClient) -> None:
        """An unfinished project opens where its boxes are drawn."""
        if self.unfinished:
            client.open_tab("Photo")
            client.open_board()

    def _open_here(self, client: ConnectedClient, project: Project, message: str = "") -> None:
        self.open_project(project)
        if message:
            self.notice_all(message, "good")

    def _saver_says(self, message: str, kind: NoticeKind = "good") -> None:
        def tell() -> None:
            self.notice_all(message, kind)
            self._look_again()

        self.ui_thread.post(tell)

    def _look_again(self) -> None:
        """What is on disk changed: the panels show it."""
        self.glances.forget()
        self.refresh_panels()

    def inputs_are_saved(self, inputs: Inputs | None) -> None:
        """These corrections of the photo are in the project's folder; None where what is there is not known."""
        self._inputs_saved = inputs

    # -- people -----------------------------------------------------------------------------------------------

    def joined(self, viser_client: viser.ClientHandle) -> None:
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

        async def looked(_: viser.CameraHandle) -> None:
            client.post(client.view.camera.frame_again, key="frame")

        viser_client.camera.on_update(looked)

    def left(self, viser_client: viser.ClientHandle) -> None:
        """A browser went away."""
        self.clients.pop(viser_client.client_id, None)
        self.ui_thread.forget(viser_client.client_id)
        self.refresh_panels()
        self.on_left()

    def notice(self, client_id: int | None, message: str, kind: NoticeKind = "info") -> None:
        """Tell one person, or all when it is not known which.

        Args:
            client_id: of the browser; None for all.
            message: for the person.
            kind: how serious it is.
        """
        client = self.clients.get(client_id) if client_id is not None else None
        for one in [client] if client is not None else list(self.clients.values()):
            one.notice(message, kind)

    def notice_all(self, message: str, kind: NoticeKind = "info") -> None:
        """Tell every browser."""
        self.notice(None, message, kind)

    def post(self, client_id: int | None, task: Callable[[], object], *, key: str | None = None) -> None:
        """Do `task` on the UI thread for one browser, which is told when it fails. May be called from any thread.

        Args:
            client_id: of the browser.
            task: what to do.
            key: of tasks with the same key only the last one is done.
        """
        self.ui_thread.post(
            task, key=key, client_id=client_id, on_error=lambda message: self.notice(client_id, message, "bad")
        )

    def close(self) -> None:
        """Stop jobs, write what is unsaved, end the threads. Called from outside the UI thread."""
        self.jobs.cancel()
        self.jobs.wait(5.0)
        self.ui_thread.stop()
        self.autosave.stop()
        self._access.release()
        self.checker.stop()
        self.preparer.stop()
        self.reader.close()
        self.thumbnails.stop()

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
            self.notice_all("Cancelled; nothing was changed.")
        elif outcome.error is not None:
            self.notice_all(outcome.error, "bad")
