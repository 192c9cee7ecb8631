"""The measured length, and a field for the true length."""

from __future__ import annotations

import viser

from diorama_app.commands.measure import measured_m, rescale_measured, stop_measuring
from diorama_app.session.client import Client
from diorama_app.session.units import format_length, parse_length
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, button, text


class Tape:
    """Shown while two points are marked."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the length, and ask for the true one."""
        length = measured_m(self._client.doing)
        if length is None:
            self._html.show("")
            return
        shown = text(format_length(length, self._client.preferences.unit))
        self._html.show(
            f'<div class="card">{_("<b>{length}</b> between the two points.").format(length=shown)}'
            '<div style="display:flex;gap:4px;margin-top:6px;align-items:center">'
            f'<input data-change="true" placeholder="{text(_("true length, such as 2.4 m"))}" '
            f'aria-label="{text(_("True length"))}" '
            f'title="{text(_("Rescale the scene to this length"))}">{button(_("Done"), "done")}</div></div>'
        )

    def _act(self, action: Action) -> None:
        client = self._client

        def done() -> None:
            stop_measuring(client)
            client.refresh()

        if action.do == "true" and action.pair[1].strip():
            words = action.pair[1]
            client.post(lambda: rescale_measured(client, parse_length(words, client.preferences.unit)))
        elif action.do == "done":
            client.post(done)
