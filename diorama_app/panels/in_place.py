"""A panel in its place: where it cannot be drawn one line stands there, until it can be again."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Generic, TypeVar

import viser

from diorama_app.session.connected_client import Panel
from diorama_app.strings import _
from diorama_app.web.html import LiveHtml, text
from diorama_core.errors import DioramaError
from diorama_core.io.bounded import shorten

log = logging.getLogger(__name__)

P = TypeVar("P", bound=Panel)


class InPlace(Generic[P]):
    """A panel whose failures are its own: other panels go on, and its elements make room for a line that says so."""

    def __init__(self, gui: viser.GuiApi, title: str, make: Callable[[], P]) -> None:
        """Make the panel, which people call by its title, here."""
        self._title = title
        self._line = LiveHtml(gui)
        self._folder = gui.add_folder(None)
        with self._folder:
            self.panel = make()

    def refresh(self) -> None:
        """Draw the panel, or the line where that fails."""
        try:
            self.panel.refresh()
        except Exception as error:  # whatever one panel does wrong, the page stands
            log.log(logging.DEBUG if self._line.body else logging.ERROR, "the panel %s", self._title, exc_info=True)
            self._show(shorten(str(error)) if isinstance(error, DioramaError) else type(error).__name__)
        else:
            self._show("")

    def _show(self, reason: str) -> None:
        words = _("{title} cannot be shown ({reason}). Your work is saved.").format(title=self._title, reason=_(reason))
        self._line.show(f'<div class="card warn">{text(words)}</div>' if reason else "")
        if self._folder.visible == bool(reason):
            self._folder.visible = not reason
