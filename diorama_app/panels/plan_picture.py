"""The picture below the plan: a scan or a PDF page, kept in the project and scaled by a length that is known."""

from __future__ import annotations

import json
import threading
from typing import Any

import numpy as np
import viser
from jaxtyping import UInt8

from diorama_app.panels.fields import add_hidden_upload
from diorama_app.projects.pictures import jpeg_uri
from diorama_app.session.client import Client
from diorama_app.session.reading import raising
from diorama_app.strings import _
from diorama_app.web.html import run_once
from diorama_core.errors import EditRefused
from diorama_core.importing.plan_pages import plan_page
from diorama_core.io.limited import LimitedProcess
from diorama_core.project.plan_picture import (
    PlanPicture,
    load_plan_picture,
    place_plan_picture,
    save_plan_picture,
)
from diorama_core.project.storage import Project


class PicturesBelow:
    """Tells the page about the picture of the open project's plan, and takes another one."""

    def __init__(self, gui: viser.GuiApi, client: Client, bounds: Any) -> None:
        """Tell the page nothing yet; `bounds` gives least and largest x and y of what the plan shows."""
        self._client, self._bounds = client, bounds
        self._told: tuple[object, ...] = ()
        self._uuid = add_hidden_upload(
            gui, client, _("Picture of a plan"), self._receive, mime_type="image/*,application/pdf"
        )
        self._teller = gui.add_html("")

    def refresh(self) -> None:
        """Tell the page what lies below, where it does not know."""
        project = self._client.session.project
        stored = None if project is None else load_plan_picture(project)
        state = (project, None if stored is None else (len(stored[0]), stored[1]))
        if state == self._told:
            return
        self._told = state
        about: dict[str, Any] = {"upload": self._uuid, "picture": None}
        if stored is not None:
            jpeg, picture = stored
            place = {"size": picture.size, "at": picture.at, "metres": picture.metres}
            about["picture"] = {"url": jpeg_uri(jpeg), **place}
        self._teller.content = run_once(f"window.__dioPlanTools.given({json.dumps(about)})")

    def place(self, place: Any) -> None:
        """The page moved, scaled or removed the picture.

        Raises:
            EditRefused: the project is read-only.
            InputError: it cannot lie there.
        """
        project = self._project()
        stored = load_plan_picture(project)
        if place is None:
            place_plan_picture(project, None)
        elif stored is not None:
            x, y = place["at"]
            place_plan_picture(project, PlanPicture(stored[1].size, (float(x), float(y)), float(place["metres"])))
        for client in self._client.session.clients.values():
            client.refresh()

    def _project(self) -> Project:
        session = self._client.session
        session.need_writable()
        if session.project is None:
            raise EditRefused("no project is open")
        return session.project

    def _receive(self, name: str, content: bytes) -> None:
        project, client = self._project(), self._client

        def read() -> None:
            process = LimitedProcess()
            try:
                rgb = process.call(name, plan_page, content, name)
            except Exception as error:  # raised again on the UI thread, for whoever uploaded
                client.post(raising(error))
                return
            finally:
                process.close()
            client.post(lambda: self._put(project, rgb))

        threading.Thread(target=read, daemon=True, name="plan picture").start()

    def _put(self, project: Project, rgb: UInt8[np.ndarray, "h w 3"]) -> None:
        """Below the whole plan, until a length is known."""
        if project != self._client.session.project:
            return  # another project was opened meanwhile
        (x0, y0), (x1, y1) = self._bounds()
        height, width = rgb.shape[:2]
        metres = max((x1 - x0) / width, (y1 - y0) / height, 0.001)
        save_plan_picture(project, rgb, PlanPicture((width, height), ((x0 + x1) / 2, (y0 + y1) / 2), metres))
        for client in self._client.session.clients.values():
            client.refresh()
