"""The editor: assembles a session, its panels, gestures and commands."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import viser

from diorama_app.commands.camera_presets import Views
from diorama_app.commands.definitions import build_commands
from diorama_app.commands.registry import Command
from diorama_app.interaction.gestures import Gestures
from diorama_app.interaction.wall_handle import WallHandle
from diorama_app.panels.all_projects import AllProjects
from diorama_app.panels.alternatives import Alternatives
from diorama_app.panels.dropping import DroppedFiles, listen_for_drops
from diorama_app.panels.edit_by_words import EditByWords
from diorama_app.panels.export import ExportPanel
from diorama_app.panels.ghost import PlacingGhost
from diorama_app.panels.help import show_help
from diorama_app.panels.home import HomePanel
from diorama_app.panels.in_place import InPlace
from diorama_app.panels.job import JobStrip
from diorama_app.panels.library import LibraryPanel
from diorama_app.panels.light import LightPanel
from diorama_app.panels.messages import Toasts
from diorama_app.panels.networks import Networks
from diorama_app.panels.object_card import ObjectCard
from diorama_app.panels.optimiser import Optimiser
from diorama_app.panels.outliner import Outliner
from diorama_app.panels.overlays import Compare, Overlays, Silhouettes
from diorama_app.panels.own_models import OwnModel
from diorama_app.panels.page import Address, PanelLayout, Tabs
from diorama_app.panels.photo import PhotoPanel
from diorama_app.panels.photo_bar import NoSceneCard
from diorama_app.panels.photo_camera import PhotoCameraPanel
from diorama_app.panels.photo_correction import PhotoCorrection
from diorama_app.panels.photo_strip import PhotoStrip
from diorama_app.panels.physics import Physics
from diorama_app.panels.picture import show_picture
from diorama_app.panels.plan import Plan
from diorama_app.panels.projects import Projects
from diorama_app.panels.properties import Properties
from diorama_app.panels.review import Review
from diorama_app.panels.room_size import RoomSize, Tape
from diorama_app.panels.start_page import StartPage
from diorama_app.panels.supports import Supports
from diorama_app.panels.surfaces import Surfaces
from diorama_app.panels.toolbar import Toolbar
from diorama_app.panels.unsaved import UnsavedChanges
from diorama_app.panels.walls import Walls
from diorama_app.projects.example import example_project
from diorama_app.reconstruction.photo_outlines import PhotoOutlines
from diorama_app.session.client import Client
from diorama_app.session.connected_client import Panel
from diorama_app.session.preferences import Preferences, recall
from diorama_app.session.session import EditorSession
from diorama_app.strings import N_, _
from diorama_app.viewport.client_view import set_theme
from diorama_core.editing.collisions import Collisions
from diorama_core.errors import DioramaError
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.user_library import ProjectShapes, UserLibrary
from diorama_core.project.storage import Project

log = logging.getLogger(__name__)

P = TypeVar("P", bound=Panel)
Place = Callable[[str, Callable[[], Panel]], Panel]
"""Puts a panel where the page is being made, with a line in its place when it fails."""

LEFT_WIDTH_PX, RIGHT_WIDTH_PX = 246, 254
"""Together at most 40 % of a screen of 1280 pixels."""
LEFT_TABS = (N_("Scene"), N_("Photo"), N_("Arrange"), N_("Project"))
RIGHT_TABS = (N_("Object"), N_("Library"), N_("Export"))


class Editor:
    """The session and everything that serves its pages."""

    def __init__(
        self, server: viser.ViserServer, library: ShapeLibrary, projects_dir: Path, *, low_graphics: bool
    ) -> None:
        self.server = server
        library = ProjectShapes(library if isinstance(library, UserLibrary) else UserLibrary(library))
        self.session = EditorSession(server, library, projects_dir, Client, low_graphics=low_graphics)
        self.session.viewport.light(low_graphics=low_graphics)
        self.views = Views(self.session)
        self._collisions = Collisions(library)
        self._gestures: dict[int, Gestures] = {}
        session = self.session
        session.on_client = self._lay_out
        session.view.on_photo_camera = self.views.photo_of
        session.view.on_pick = lambda object_id, event: self._hand(event, lambda g: g.pick(object_id, event))
        session.view.on_drag = lambda object_id, event: self._hand(event, lambda g: g.drag(object_id, event))
        self._outlines = PhotoOutlines(session)
        self.commands = build_commands(session, self.views, self._outlines, self._cancel, self._help, show_picture)
        self.commands.register(server.gui, self._ask)
        server.gui.set_panel_label("Diorama")
        set_theme(server.gui, dark=False)

    def _ask(self, command: Command, client_id: int | None) -> None:
        client = None if client_id is None else self.session.clients.get(client_id)
        if isinstance(client, Client):
            client.post(lambda: command.run(client))

    def _hand(self, event: Any, act: Callable[[Gestures], None]) -> None:
        gestures = self._gestures.get(event.client_id)
        if gestures is not None:
            act(gestures)

    def _cancel(self, client: Client) -> bool:
        return self._gestures[client.id].cancel()

    def _help(self, client: Client) -> None:
        show_help(client, self.commands)

    def open_first(self, project: Project | None) -> None:
        """Show a project; without one the bundled example, or at least an empty room that says what to do.

        Pages that came before are answered after it: they would greet nobody and show an empty room first.
        """
        self.session.greets = project is None
        done: list[BaseException] = []

        def open_it() -> None:
            try:
                if project is not None:
                    self.session.open_project(project)
                else:
                    self._open_example()
            except BaseException as error:  # raised again by whoever waits for it
                done.append(error)

        self.session.ui_thread.post(open_it)
        self.session.ui_thread.wait(60.0)
        if done:
            raise done[0]
        self.server.on_client_connect(self._join)
        self.server.on_client_disconnect(self._leave)

    def _open_example(self) -> None:
        session = self.session
        try:
            example = example_project(session.projects_dir)
            if example is not None:
                session.open_project(example)
                return
        except DioramaError as error:
            log.warning("the example cannot be opened: %s", error)
        session.refresh()

    def refuse_upload(self, client_id: int, line: str) -> None:
        """Tell the user why an upload was refused. May be called from any thread."""
        self.session.ui_thread.post(
            lambda: self.session.notice(client_id, line, "bad"), client_id=client_id, key="upload refused"
        )

    def close(self) -> None:
        """Save and end everything that runs."""
        self.session.close()

    def _lay_out(self, client: Client) -> None:
        """Create the panels of a newly connected client."""
        gui = client.viser_client.gui
        gui.main_panel.dock_left()
        client.handles = self._gestures[client.id] = Gestures(client, self._collisions)
        toolbar = Toolbar(gui, client, self.commands)
        client.job_panel = job_strip = JobStrip(gui, client)
        panels: list[Panel] = [
            toolbar,
            job_strip,
            UnsavedChanges(gui, client),
            Tape(gui, client),
            Compare(gui, client, self.views),
            NoSceneCard(gui, client),
            Overlays(client, self._outlines),
            Toasts(gui, client),
            Walls(gui, client),
            Silhouettes(gui, client),
            WallHandle(client),
            PlacingGhost(gui, client),
            Plan(gui, client),
        ]
        client.open_tab = Tabs(gui, LEFT_TABS + RIGHT_TABS).open
        client.go_to = Address(gui).go_to
        self.views.follow(client)
        left = gui.add_tab_group()
        scene, from_photo, arrange, projects = (left.add_tab(_(name)) for name in LEFT_TABS)

        def place(title: str, make: Callable[[], P]) -> P:
            placed = InPlace(gui, title, make)
            panels.append(placed)
            return placed.panel

        with scene:
            place(_("Edits by words"), lambda: EditByWords(gui, client))
            place(_("The review"), lambda: Review(gui, client))
            place(_("The list of objects"), lambda: Outliner(gui, client))
            place(_("The rooms of the home"), lambda: HomePanel(gui, client))
            place(_("The size of the room"), lambda: RoomSize(gui, client))
            place(_("The light"), lambda: LightPanel(gui, client))
        with from_photo:
            place(_("The photos of the room"), lambda: PhotoStrip(gui, client, self.views))
            photo = place(_("The photo"), lambda: PhotoPanel(gui, client, self.commands))
            place(_("The photo's camera"), lambda: PhotoCameraPanel(gui, client, self.views))
        with arrange:
            client.curves = place(_("The layout"), lambda: Optimiser(gui, client))
        with projects:
            place(_("The list of projects"), lambda: Projects(gui, client, self.commands, photo.take))
            place(_("The list of networks"), lambda: Networks(gui, client))
        right = gui.add_panel()
        count = len(panels)
        self._right_side(client, place, right.add_tab)
        on_the_right = panels[count:]
        listen_for_drops(gui, client, DroppedFiles(client, photo).take)
        panels += [StartPage(gui, client, photo.take), AllProjects(gui, client)]
        right.dock_right()

        def widen() -> None:
            gui.main_panel.set_width(LEFT_WIDTH_PX)
            right.set_width(RIGHT_WIDTH_PX)

        widen()

        def one_panel() -> None:
            """A phone shows one panel: what is on the right goes into the tabs of the left."""
            right.remove()
            panels[:] = [p for p in panels if p not in on_the_right]
            self._right_side(client, place, left.add_tab)
            client.refresh()

        panels.append(PanelLayout(gui, client, one_panel, widen))
        client.panels = panels

    def _right_side(self, client: Client, place: Place, add_tab: Callable[[str], viser.GuiTabHandle]) -> None:
        """Create what is about the selection, the library and the export, in tabs of their own."""
        gui = client.viser_client.gui
        about, library, exporting = (add_tab(_(name)) for name in RIGHT_TABS)
        with about:
            place(_("The object"), lambda: ObjectCard(gui, client, self.commands))
            place(_("The surface"), lambda: Surfaces(gui, client))
            place(_("Your own model"), lambda: OwnModel(gui, client))
            place(_("The alternatives"), lambda: Alternatives(gui, client))
            place(_("The properties"), lambda: Properties(gui, client))
            place(_("What supports it"), lambda: Supports(gui, client))
            place(_("The physics"), lambda: Physics(gui, client))
            place(_("The correction by the photo"), lambda: PhotoCorrection(gui, client))
        with library:
            place(_("The library"), lambda: LibraryPanel(gui, client))
        with exporting:
            place(_("The export"), lambda: ExportPanel(gui, client))

    async def _join(self, viser_client: viser.ClientHandle) -> None:
        self.session.ui_thread.post(lambda: self.session.join(viser_client))
        threading.Thread(target=self._recall, args=(viser_client,), daemon=True, name="settings").start()

    def _recall(self, viser_client: viser.ClientHandle) -> None:
        """Restore the client's stored preferences, unless it has changed them already."""
        preferences = recall(viser_client)

        def take() -> None:
            client = self.session.clients.get(viser_client.client_id)
            if isinstance(client, Client) and client.preferences == Preferences() != preferences:
                client.take_preferences(preferences)

        self.session.ui_thread.post(take)

    async def _leave(self, viser_client: viser.ClientHandle) -> None:
        def leave() -> None:
            self._gestures.pop(viser_client.client_id, None)
            self.session.leave(viser_client)

        self.session.ui_thread.forget(viser_client.client_id)
        self.session.ui_thread.post(leave)
