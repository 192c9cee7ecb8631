"""What is dropped anywhere on the page, a file, several or a folder, is told by its content and goes where it belongs.

The page packs several files into one zip archive (`static/dropping.js`), so that one upload brings them all.
"""

from __future__ import annotations

import viser

from diorama_app.commands.import_model import import_model
from diorama_app.panels.fields import Take, add_hidden_upload
from diorama_app.panels.messages import ask_which
from diorama_app.panels.photo import PhotoPanel
from diorama_app.projects.dropped import Dropped, Reading, files_of, sources_of, upload_of
from diorama_app.reconstruction.dropped_photos import begin_each, build_one_room
from diorama_app.reconstruction.opening_job import open_file, open_packed
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.web.html import text


class DroppedFiles:
    """Says what was dropped, asks where that is open, and acts."""

    def __init__(self, client: Client, photo: PhotoPanel) -> None:
        self._client, self._photo = client, photo

    def take(self, name: str, content: bytes) -> None:
        """Take a file of any kind, or an archive of several."""
        client, inputs = self._client, self._client.session.inputs

        def handle(dropped: Dropped) -> None:
            if len(dropped.readings) > 1:
                ask_which(client, name, dropped, lambda reading: self._act(name, content, reading))
                return
            (reading,) = dropped.readings
            unused = dropped.unread()
            client.notice(f"{name}: {reading.words}" + (f". {unused}" if unused else ""))
            self._act(name, content, reading)

        size = None if inputs is None else (inputs.photo.width, inputs.photo.height)
        client.session.reader.recognise(content, name, size, client, handle)

    def _act(self, name: str, content: bytes, reading: Reading) -> None:
        client = self._client
        match reading.action:
            case "photo":
                self._photo.begin(upload_of(reading.photos[0], files_of(name, content)))
            case "inputs":
                self._photo.add(sources_of(reading.inputs, files_of(name, content)))
            case "photos":
                begin_each(client, name, content, reading)
            case "room":
                build_one_room(client, name, content, reading)
            case "models":
                import_model(client, name, content)
            case "scene":
                open_file(client, name, content)
            case "project":
                open_packed(client, name, content)


def listen_for_drops(gui: viser.GuiApi, client: Client, take: Take) -> None:
    """Let the page send what is dropped. Call it where the panel is always there."""
    uuid = add_hidden_upload(gui, client, _("Dropped files"), take)
    gui.add_html(f'<i id="dio-drop-to" data-upload="{text(uuid)}"></i>')
