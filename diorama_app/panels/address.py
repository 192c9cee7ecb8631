"""The address of a page names its project; the editor takes the page to another one."""

from __future__ import annotations

import json

import viser

from diorama_app.web.html import run_once


class Address:
    """The address of one page."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._script = gui.add_html("")
        self._moves = 0

    def go_to(self, project: str) -> None:
        """Take the page to a project, by the name of its folder; Back leads here again."""
        self._moves += 1
        self._script.content = run_once(f"window.__dioGoTo({json.dumps(project)}); /* {self._moves} */")
