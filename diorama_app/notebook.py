"""The editor in a cell of a notebook: it runs in the kernel's process and shows itself to named origins alone."""

from __future__ import annotations

import atexit
import html
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import diorama_core as diorama
from diorama_app.serve import Running, start
from diorama_core.errors import InputError

JUPYTER = ("http://localhost:8888", "http://127.0.0.1:8888")
"""Origins of Jupyter's pages, unless its server was told otherwise."""
HEIGHT_PX = 640
"""Leaves room for the page's toolbars on a laptop's screen."""


@dataclass(frozen=True, eq=False)
class EditorCell:
    """A running editor, which notebooks show as a frame."""

    running: Running
    folder: Path
    """The project; every change is in it within a second."""
    height_px: int

    def _repr_html_(self) -> str:
        address = html.escape(self.running.url)
        frame = f'<iframe src="{address}" width="100%" height="{self.height_px}" style="border:0"></iframe>'
        link = f'<a href="{address}" target="_blank">{address}</a>'
        return f"{frame}<p>Refused? Open {link}, or give show() this page's address in origins.</p>"

    def room(self) -> diorama.Reconstruction:
        """The room as it has become; raises `ProjectError` where that could not be saved."""
        self.running.session.autosave.flush()
        return diorama.load(self.folder)

    def stop(self) -> None:
        """Save and end the editor."""
        _SHOWN.pop(self.folder, None)
        atexit.unregister(self.stop)
        self.running.stop()


_SHOWN: dict[Path, EditorCell] = {}
"""By folder: a cell that is run again finds its earlier editor here."""


def show(
    room: diorama.Reconstruction,
    folder: Path | str | None = None,
    *,
    origins: Sequence[str] = JUPYTER,
    port: int = 0,
    height_px: int = HEIGHT_PX,
) -> EditorCell:
    """Start the editor of a room, to be shown in a notebook's cell; it ends with the kernel.

    Shown again, `room` takes the place of what became of it in the earlier cell, which is kept as an earlier version.

    Args:
        room: what is edited.
        folder: where it is kept; by default the project that it was loaded from or built in.
        origins: whose pages may show the editor: scheme, host and port of the notebook's address in the browser.
        port: of this machine; 0 lets the system choose.
        height_px: of the frame.

    Raises:
        InputError: the room is in no project and no folder is given, an origin is none, or the port is taken.
        ProjectError: the folder cannot be written, or holds something else.
    """
    folder = folder or (None if room.project is None else room.project.folder)
    if folder is None:
        raise InputError("the room is in no project yet; say in which folder it is kept: show(room, 'my-room')")
    place = Path(folder).resolve()
    if place in _SHOWN:
        _SHOWN[place].stop()
    room.save(place)
    running = start(project=place, projects_dir=place.parent, port=port, library=room.library, frame_origins=origins)
    cell = _SHOWN[place] = EditorCell(running, place, height_px)
    atexit.register(cell.stop)
    return cell
