"""On a phone the page shows one panel: it asks for everything in the tabs of that one (`static/start.js`)."""

from __future__ import annotations

from collections.abc import Callable

import viser

from diorama_app.session.client import Client
from diorama_app.web.html import Action, LiveHtml


class OnePanel:
    """A hidden button that the page presses by itself where there is room for one panel only."""

    def __init__(self, gui: viser.GuiApi, client: Client, gather: Callable[[], None]) -> None:
        """Put the button on the page.

        Args:
            gui: the page.
            client: the owner.
            gather: moves all tabs into one panel; called once.
        """
        self._client, self._gather = client, gather
        self._gathered = False
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)))

    def refresh(self) -> None:
        """Draw the button until it was pressed."""
        hidden = '<button type="button" id="dio-one-panel" data-do="one panel" hidden></button>'
        self._html.show("" if self._gathered else hidden)

    def _do(self, action: Action) -> None:
        if action.do == "one panel" and not self._gathered:
            self._gathered = True
            self._gather()
