"""The editor: a room, its panels, its gestures and its commands, put together in one place."""

from __future__ import annotations

import logging
from pathlib import Path

import viser

from diorama_app.actions import Views, build_commands
from diorama_app.example import example_project
from diorama_app.gestures import Gestures
from diorama_app.panels.alternatives import Alternatives
from diorama_app.panels.compare import Compare
from diorama_app.panels.job import JobStrip
from diorama_app.panels.library import LibraryPanel
from diorama_app.panels.optimiser import Optimiser
from diorama_app.panels.outliner import Outliner
from diorama_app.panels.photo import PhotoPanel
from diorama_app.panels.projects import Projects
from diorama_app.panels.properties import Properties
from diorama_app.panels.supports import Supports
from diorama_app.panels.toolbar import Toolbar
from diorama_app.room import Panel, Room
from diorama_app.viser_adapter import MAX_UPLOAD_BYTES
from diorama_core.errors import DioramaError
from diorama_core.library.record import ShapeLibrary
from diorama_core.project.storage import Project

log = logging.getLogger(__name__)

LEFT_WIDTH_PX = 292
RIGHT_WIDTH_PX = 312


class Editor:
    """Everything behind one page."""

    def __init__(
        self, server: viser.ViserServer, library: ShapeLibrary, projects_dir: Path, *, low_graphics: bool
    ) -> None:
        self.server = server
        self.room = Room(server, library, projects_dir)
        self.room.viewport.light(low_graphics=low_graphics)
        self.gestures = Gestures(self.room)
        self.views = Views(self.room)
        self.room.on_photo_camera = self.views.photo
        self.commands = build_commands(self.room, self.gestures, self.views)
        self.commands.register(server.gui, lambda command, client: self.room.post(client, lambda: command.run(client)))
        self._lay_out()
        server.on_client_connect(self._joined)
        server.on_client_disconnect(self._left)

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

    def _lay_out(self) -> None:
        gui = self.server.gui
        gui.configure_theme(
            control_layout="floating", show_logo=False, show_share_button=False, brand_color=(47, 111, 214)
        )
        gui.set_panel_label("Diorama")
        gui.main_panel.dock_left()
        gui.main_panel.set_width(LEFT_WIDTH_PX)
        room = self.room
        toolbar = Toolbar(gui, room, self.commands, self.gestures)
        room.job_panel = job_strip = JobStrip(gui, room)
        panels: list[Panel] = [
            self.gestures,
            toolbar,
            job_strip,
            Compare(gui, room, self.views),
        ]
        left = gui.add_tab_group()
        with left.add_tab("Scene"):
            panels.append(Outliner(gui, room))
        with left.add_tab("Photo"):
            panels.append(PhotoPanel(gui, room, self.views))
        with left.add_tab("Arrange"):
            panels.append(Optimiser(gui, room))
        with left.add_tab("Project"):
            panels.append(Projects(gui, room, self.commands))
        right = gui.add_panel()
        with right.add_tab("Object"):
            panels += [Properties(gui, room, self.commands), Supports(gui, room), Alternatives(gui, room)]
        with right.add_tab("Library"):
            panels.append(LibraryPanel(gui, room))
        right.dock_right()
        right.set_width(RIGHT_WIDTH_PX)
        room.panels = panels

    async def _joined(self, client: viser.ClientHandle) -> None:
        self.room.desk.post(lambda: self.room.joined(client))

    async def _left(self, client: viser.ClientHandle) -> None:
        self.room.desk.post(lambda: self.room.left(client))
