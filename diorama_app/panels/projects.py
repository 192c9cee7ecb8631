"""Projects and files: what is open, recent ones, save, export."""

from __future__ import annotations

import base64
import io
import time
from pathlib import Path

import viser
from PIL import Image

from diorama_app import work
from diorama_app.commands import CommandTable
from diorama_app.page import Action, LiveHtml, button, text
from diorama_app.panels.fields import on_press
from diorama_app.room import Room
from diorama_core.errors import DioramaError, EditRefused
from diorama_core.project.storage import Project

RECENT = 12


class Projects:
    """Save, export and the list of recent projects."""

    def __init__(self, gui: viser.GuiApi, room: Room, commands: CommandTable) -> None:
        self._room = room
        self._pictures: dict[tuple[str, float], str] = {}
        self._status = LiveHtml(gui)
        self._export = gui.add_button("Download GLB", hint="The whole room, for any 3D program")
        on_press(self._export, lambda client: room.post(client, lambda: work.export_glb(room, client)))
        save = gui.add_button("Save now", color="gray", hint=commands["save"].tooltip)
        on_press(save, lambda client: room.post(client, lambda: commands["save"].run(client)))
        self._notes = LiveHtml(gui)
        self._list = LiveHtml(gui, self._act)
        self._keys = LiveHtml(gui)
        self._keys.show(_shortcuts(commands))

    def refresh(self) -> None:
        """Draw what is open and what else there is."""
        room = self._room
        busy = room.jobs.status is not None
        if self._export.disabled != busy:
            self._export.disabled = busy
        if room.project is None:
            self._status.show('<div class="card">No project is open.</div>')
        else:
            where = "Every change is saved as you make it."
            self._status.show(f"<p><b>{text(room.project.name)}</b><br><span class='dim'>{where}</span></p>")
        notes = "".join(f"<p>{text(note[:1].upper() + note[1:])}.</p>" for note in room.notes[:6])
        self._notes.show(f'<h4>How this scene was made</h4><div class="card">{notes}</div>' if notes else "")
        rows = "".join(self._row(folder) for folder in recent_projects(room.projects_dir)[:RECENT])
        self._list.show(f"<h4>Recent projects</h4>{rows}" if rows else "")

    def _row(self, folder: Path) -> str:
        current = self._room.project is not None and self._room.project.folder.resolve() == folder.resolve()
        when = time.strftime("%d %b %H:%M", time.localtime(_touched(folder)))
        return (
            f'<div class="row {"on" if current else ""}" data-do="open" data-arg="{text(folder.name)}">'
            f'{self._picture(folder)}<span class="name">{text(_name(folder))}<br><span class="dim">{when}</span></span>'
            + ("" if current else button("Open", "open", folder.name))
            + "</div>"
        )

    def _picture(self, folder: Path) -> str:
        path = folder / "photo.jpg"
        if not path.exists():
            return ""
        key = (str(path), path.stat().st_mtime)
        if key not in self._pictures:
            self._pictures[key] = _small_picture(path)
        return self._pictures[key]

    def _act(self, action: Action) -> None:
        room = self._room

        def open_it() -> None:
            if room.jobs.status is not None:
                raise EditRefused(f"{room.jobs.status.title} is still running; cancel it or wait")
            # Only a name that is listed: the page must not reach outside the projects' folder.
            folder = next((f for f in recent_projects(room.projects_dir) if f.name == action.arg), None)
            if folder is None:
                raise EditRefused("that project is gone")
            project = Project.open(folder)
            room.open_project(project)
            room.notice(action.client_id, f"Opened {project.name}.", "good")

        if action.do == "open":
            room.post(action.client_id, open_it)


def recent_projects(projects_dir: Path) -> list[Path]:
    """Folders of projects that have a scene, last touched first."""
    if not projects_dir.is_dir():
        return []
    folders = [f for f in projects_dir.iterdir() if (f / "project.json").exists() and (f / "scene.json").exists()]
    return sorted(folders, key=_touched, reverse=True)


def _touched(folder: Path) -> float:
    try:
        return (folder / "scene.json").stat().st_mtime
    except OSError:
        return 0.0


def _name(folder: Path) -> str:
    try:
        return Project.open(folder).name
    except DioramaError:
        return folder.name


def _small_picture(path: Path) -> str:
    try:
        with Image.open(path) as image:
            image.thumbnail((96, 72))
            buffer = io.BytesIO()
            image.convert("RGB").save(buffer, "JPEG", quality=75)
    except OSError:
        return ""
    uri = base64.b64encode(buffer.getvalue()).decode()
    return f'<img alt="" class="small" src="data:image/jpeg;base64,{uri}">'


def _shortcuts(commands: CommandTable) -> str:
    rows = "".join(
        f"<tr><td>{text(c.label)}</td><td><kbd>{text(c.keys)}</kbd></td></tr>" for c in commands.all if c.keys
    )
    return f"<h4>Keys</h4><table>{rows}<tr><td>All commands</td><td><kbd>Ctrl+K</kbd></td></tr></table>"
