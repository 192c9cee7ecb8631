"""The editor: a room, its panels, its gestures and its commands, put together in one place."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import viser

from diorama_app.actions import build_commands
from diorama_app.client_view import set_theme
from diorama_app.collisions import Collisions
from diorama_app.commands import Command
from diorama_app.example import example_project
from diorama_app.gestures import Gestures
from diorama_app.guest import Guest, Panel
from diorama_app.importing import import_model
from diorama_app.panels.alternatives import Alternatives
from diorama_app.panels.compare import Compare
from diorama_app.panels.dropping import take_dropped_files
from diorama_app.panels.evidence import Evidence
from diorama_app.panels.help import show_help
from diorama_app.panels.job import JobStrip
from diorama_app.panels.library import LibraryPanel
from diorama_app.panels.measure import Tape
from diorama_app.panels.networks import Networks
from diorama_app.panels.optimiser import Optimiser
from diorama_app.panels.outliner import Outliner
from diorama_app.panels.overlays import Overlays
from diorama_app.panels.own_model import OwnModel
from diorama_app.panels.photo import PhotoPanel
from diorama_app.panels.photo_camera import PhotoCamera
from diorama_app.panels.projects import Projects
from diorama_app.panels.properties import Properties
from diorama_app.panels.room_size import RoomSize
from diorama_app.panels.supports import Supports
from diorama_app.panels.tabs import Tabs
from diorama_app.panels.toast import Toasts
from diorama_app.panels.toolbar import Toolbar
from diorama_app.panels.unsaved import UnsavedChanges
from diorama_app.panels.walls import Walls
from diorama_app.photo_outlines import PhotoOutlines
from diorama_app.room import Room
from diorama_app.settings import Settings, remembered
from diorama_app.shelf import Shelf
from diorama_app.views import Views
from diorama_app.viser_adapter import MAX_UPLOAD_BYTES
from diorama_core.errors import DioramaError
from diorama_core.library.record import ShapeLibrary
from diorama_core.project.storage import Project

log = logging.getLogger(__name__)

LEFT_WIDTH_PX = 292
RIGHT_WIDTH_PX = 312
LEFT_TABS = ("Scene", "Photo", "Arrange", "Project")
RIGHT_TABS = ("Object", "Library")


class Editor:
    """Everything behind one page."""

    def __init__(
        self, server: viser.ViserServer, library: ShapeLibrary, projects_dir: Path, *, low_graphics: bool
    ) -> None:
        self.server = server
        library = Shelf(library)
        self.room = Room(server, library, projects_dir, low_graphics=low_graphics)
        self.room.viewport.light(low_graphics=low_graphics)
        self.views = Views(self.room)
        self._collisions = Collisions(library)
        self._gestures: dict[int, Gestures] = {}
        room = self.room
        room.on_guest = self._lay_out
        room.on_photo_camera = self.views.photo
        room.on_pick = lambda object_id, event: self._hand(event, lambda g: g.picked(object_id, event))
        room.on_drag = lambda object_id, event: self._hand(event, lambda g: g.dragged(object_id, event))
        self._outlines = PhotoOutlines(room)
        self.commands = build_commands(room, self.views, self._outlines, self._cancel, self._help)
        self.commands.register(server.gui, self._asked)
        server.gui.set_panel_label("Diorama")
        set_theme(server.gui, dark=False)
        server.on_client_connect(self._joined)
        server.on_client_disconnect(self._left)

    def _asked(self, command: Command, client_id: int | None) -> None:
        guest = None if client_id is None else self.room.guests.get(client_id)
        if guest is not None:
            guest.post(lambda: command.run(guest))

    def _hand(self, event: Any, act: Callable[[Gestures], None]) -> None:
        gestures = self._gestures.get(event.client_id)
        if gestures is not None:
            act(gestures)

    def _cancel(self, guest: Guest) -> bool:
        return self._gestures[guest.id].cancel()

    def _help(self, guest: Guest) -> None:
        show_help(guest, self.commands)

    def open_first(self, project: Project | None) -> None:
        """Show a project; without one the bundled example, or at least an empty room that says what to do."""
        done: list[BaseException] = []

        def open_it() -> None:
            try:
                if project is not None:
                    self.room.open_project(project)
                else:
                    self._open_example()
            except BaseException as error:
                done.append(error)

        self.room.desk.post(open_it)
        self.room.desk.wait(60.0)
        if done:
            raise done[0]

    def _open_example(self) -> None:
        room = self.room
        try:
            example = example_project(room.projects_dir)
            if example is not None:
                room.open_project(example)
                return
        except DioramaError as error:
            log.warning("the example cannot be opened: %s", error)
        room.refresh()

    def refuse_upload(self, client_id: int, name: str, size: int) -> None:
        """Tell a person that a file was too large. May be called from any thread."""
        message = (
            f"{name} has {size / 1e6:.0f} MB; files up to {MAX_UPLOAD_BYTES / 1e6:.0f} MB can be uploaded. "
            "Make the picture smaller."
        )
        self.room.desk.post(lambda: self.room.notice(client_id, message, "bad"))

    def close(self) -> None:
        """Save and end everything that runs."""
        self.room.close()

    def _lay_out(self, guest: Guest) -> None:
        """Make the panels of somebody who came."""
        gui = guest.client.gui
        gui.main_panel.dock_left()
        gui.main_panel.set_width(LEFT_WIDTH_PX)
        gestures = self._gestures[guest.id] = Gestures(guest, self._collisions)
        toolbar = Toolbar(gui, guest, self.commands)
        guest.job_panel = job_strip = JobStrip(gui, guest)
        panels: list[Panel] = [
            gestures,
            toolbar,
            job_strip,
            UnsavedChanges(gui, guest),
            Tape(gui, guest),
            Compare(gui, guest, self.views),
            Overlays(guest, self._outlines),
            Toasts(gui, guest),
            Walls(gui, guest),
        ]
        guest.open_tab = Tabs(gui, (LEFT_TABS, RIGHT_TABS)).open
        left = gui.add_tab_group()
        scene, from_photo, arrange, projects = (left.add_tab(name) for name in LEFT_TABS)
        with scene:
            panels += [Outliner(gui, guest), RoomSize(gui, guest)]
        with from_photo:
            photo = PhotoPanel(gui, guest, self.views, self.commands)
            panels += [photo, PhotoCamera(gui, guest, self.views)]
        with arrange:
            guest.curves = optimiser = Optimiser(gui, guest)
            panels.append(optimiser)
        with projects:
            panels += [Projects(gui, guest, self.commands, photo.take), Networks(gui, guest)]
        right = gui.add_panel()
        about, library = (right.add_tab(name) for name in RIGHT_TABS)
        with about:
            panels += [
                Properties(gui, guest, self.commands),
                OwnModel(gui, guest),
                Alternatives(gui, guest),
                Supports(gui, guest),
                Evidence(gui, guest),
            ]
        with library:
            panels.append(LibraryPanel(gui, guest))
        take_dropped_files(gui, guest, photo.take, lambda name, content: import_model(guest, name, content))
        right.dock_right()
        right.set_width(RIGHT_WIDTH_PX)
        guest.panels = panels

    async def _joined(self, client: viser.ClientHandle) -> None:
        self.room.desk.post(lambda: self.room.joined(client))
        threading.Thread(target=self._recall, args=(client,), daemon=True, name="settings").start()

    def _recall(self, client: viser.ClientHandle) -> None:
        """Let somebody work as they did the last time, unless they were quicker to choose."""
        kept = remembered(client)

        def take() -> None:
            guest = self.room.guests.get(client.client_id)
            if guest is not None and guest.settings == Settings() != kept:
                guest.take_settings(kept)

        self.room.desk.post(take)

    async def _left(self, client: viser.ClientHandle) -> None:
        def leave() -> None:
            self._gestures.pop(client.client_id, None)
            self.room.left(client)

        self.room.desk.post(leave)
