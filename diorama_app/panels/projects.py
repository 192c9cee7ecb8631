"""Projects and files: what is open, recent ones, save, open a file, earlier versions."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path

import viser
from PIL import Image

from diorama_app.commands.registry import CommandTable
from diorama_app.panels.fields import GO_COLOUR, QUIET_COLOUR, UploadField, enable, on_press
from diorama_app.projects import manage as project_care
from diorama_app.projects.packing import SUFFIX
from diorama_app.projects.pictures import encode_picture, jpeg_uri
from diorama_app.reconstruction.opening_job import open_file
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, button, library_text, text
from diorama_core.errors import EditRefused, ProjectError
from diorama_core.importing.forms import SUFFIXES
from diorama_core.io.bounded import read_picture
from diorama_core.project.storage import Project

RECENT = 6
PICTURE_SIZE = (96, 72)
MAX_PICTURES = 500
"""Kept in memory, 3 kB each."""


class Projects:
    """Save, open, and the list of recent projects."""

    def __init__(
        self, gui: viser.GuiApi, client: Client, commands: CommandTable, take_photo: Callable[[str, bytes], None]
    ) -> None:
        self._client = client
        self._status = LiveHtml(gui, self._act)
        save = gui.add_button(_("Save now"), color=QUIET_COLOUR, hint=commands["save"].tooltip)
        on_press(save, lambda: client.post(lambda: commands["save"].run(client)))
        start = gui.add_button(_("Start page"), color=QUIET_COLOUR, hint=commands["start_page"].tooltip)
        on_press(start, lambda: client.post(client.open_start))
        everything = gui.add_button(_("All projects"), color=QUIET_COLOUR, hint=commands["projects"].tooltip)
        on_press(everything, lambda: client.post(client.open_projects))
        UploadField(gui, client, _("New from a photo"), take_photo, color=GO_COLOUR, mime_type="image/*")
        self._open = UploadField(
            gui,
            client,
            _("Open a file"),
            lambda name, content: open_file(client, name, content),
            color=QUIET_COLOUR,
            mime_type=",".join((*SUFFIXES, SUFFIX)),
        )
        self._notes = LiveHtml(gui)
        self._list = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw what is open and what else there is."""
        session = self._client.session
        enable(self._open.handle, session.jobs.status is None)
        if session.project is None:
            self._status.show(f'<div class="card">{text(_("No project is open."))}</div>')
        else:
            named, versions = session.glances.get("versions", partial(_name_and_versions, session.project))
            self._status.show(
                f"{named}<p class='dim' style='margin-top:4px'>{text(_what_becomes_of_changes(session))}</p>{versions}"
            )
        notes = "".join(f"<p>{library_text(note)}.</p>" for note in session.notes[:6])
        title = f"<h4>{text(_('How this scene was made'))}</h4>"
        self._notes.show(f'{title}<div class="card">{notes}</div>' if notes else "")
        self._list.show(session.glances.get("projects", self._cards))

    def _cards(self) -> str:
        """The projects that were changed last."""
        session = self._client.session
        rows = "".join(self._row(folder) for folder in project_care.recent_projects(session.projects_dir)[:RECENT])
        return f"<h4>{text(_('Recent projects'))}</h4>{rows}" if rows else ""

    def _row(self, folder: Path) -> str:
        current = is_open(self._client.session.project, folder)
        when = time.strftime("%Y-%m-%d, %H:%M", time.localtime(project_care.mtime(folder)))
        name = text(project_care.name_of(folder))
        on = "on" if current else ""
        return (
            f'<div class="row tall {on}" data-do="open" data-arg="{text(project_care.address_of(folder))}">'
            f'{self._picture(folder)}<span class="name" title="{name}"><b>{name}</b>'
            f'<span class="dim">{when}</span></span>'
            + ("" if current else button(_("Open"), "open", project_care.address_of(folder)))
            + "</div>"
        )

    def _picture(self, folder: Path) -> str:
        path = folder / "photo.jpg"
        if not path.exists():
            return ""
        return _small_picture(path, path.stat().st_mtime_ns)

    def _act(self, action: Action) -> None:
        self._client.post(lambda: self._do(action))

    def _do(self, action: Action) -> None:
        client, session = self._client, self._client.session
        if action.do == "rename" and session.project is not None:
            session.need_writable()
            project_care.rename_project(session.project, action.pair[1])
            client.toast(_("This project is now called {name}.").format(name=session.project.name), False)
        elif action.do == "version" and session.project is not None:
            scene = project_care.earlier_scene(session.project, action.arg)
            session.textures = {**session.textures, **session.project.textures(scene)}
            session.commit(_("restore an earlier version"), scene, by=client, selection=())
        elif action.do == "open":
            visit_listed(client, action.arg)
        session.glances.forget()
        session.refresh_panels()


def folder_in_list(session: EditorSession, address: str) -> Path:
    """The folder of a project that is listed: a page must not reach outside the projects' folder."""
    folder = project_care.find_project(session.projects_dir, address)
    if folder is None:
        raise EditRefused("that project no longer exists")
    return folder


def visit_listed(client: Client, address: str) -> None:
    """Go to a project that is listed."""
    project = Project.open(folder_in_list(client.session, address))
    client.session.visit(client, project, _("Opened {name}.").format(name=project.name))


def is_open(project: Project | None, folder: Path) -> bool:
    """Whether the open project is in this folder."""
    return project is not None and project.folder.resolve() == folder.resolve()


def _name_and_versions(project: Project) -> tuple[str, str]:
    """The field with the project's name, and its earlier versions."""
    earlier = "".join(
        f'<div class="row"><span class="name">{text(when)}</span>'
        + button(_("Restore this version"), "version", file)
        + "</div>"
        for file, when in project_care.earlier_versions(project)
    )
    return (
        f'<input data-change="rename" value="{text(project.name)}" aria-label="{text(_("Project name"))}" '
        f'title="{text(_("Type to rename"))}">',
        f"<details><summary class='dim'>{text(_('Earlier versions'))}</summary>{earlier}</details>" if earlier else "",
    )


def _what_becomes_of_changes(session: EditorSession) -> str:
    if session.read_only:
        return _("This project is read-only here.")
    if session.autosave.trouble:
        return _("Changes cannot be saved at the moment.")
    return _("Every change is saved as you make it.")


@lru_cache(maxsize=MAX_PICTURES)
def _small_picture(path: Path, written_ns: int) -> str:
    """A project's photo as it was written then, small; the same for all pages."""
    try:
        picture = read_picture(path, ProjectError, most_pixels=8_000_000, within=PICTURE_SIZE)
    except ProjectError:
        return ""  # the project itself says what is wrong when it is opened
    image = Image.fromarray(picture)
    image.thumbnail(PICTURE_SIZE)
    return f'<img alt="" class="small" src="{jpeg_uri(encode_picture(image, "JPEG", quality=75))}">'
