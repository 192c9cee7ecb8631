"""Outlines of what is selected, and the name of what is pointed at: told to one page (`static/silhouettes.js`)."""

from __future__ import annotations

import json

import viser

from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.viewport.decorations import Outline
from diorama_app.web.html import run_once

_TOLD = "window.__dioSilhouettes.told(%s)"


class Silhouettes:
    """Tells one page what is outlined in which colour."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._told = ""
        self._html = gui.add_html("")
        client.marks.on_outlines = lambda outlines: self.refresh()

    def refresh(self) -> None:
        """Tell the page what differs from what it knows."""
        client = self._client
        told = json.dumps(
            {"lines": [_line(o) for o in client.marks.outlines], "names": self._names()}, separators=(",", ":")
        )
        if told != self._told:
            self._told = told
            self._html.content = run_once(_TOLD % told)

    def _names(self) -> dict[str, str]:
        session = self._client.session
        names = {}
        for item in session.scene.objects:
            node = session.viewport.node_name(item.id)
            if node is not None and not item.hidden:
                problems = "".join(f" ⚠ {_(badge)}" for badge in session.badges.get(item.id, ()))
                names[node] = item.label[:60] + (_(" (locked)") if item.locked else "") + problems
        return names


def _line(outline: Outline) -> tuple[str, str, float]:
    return outline.node, "#" + "".join(f"{c:02x}" for c in outline.colour), outline.thickness_px
