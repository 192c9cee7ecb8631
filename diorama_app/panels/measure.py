"""The measured length, and the field that says what it truly is."""

from __future__ import annotations

import viser

from diorama_app.guest import Guest
from diorama_app.measuring import measured_m, rescale_measured, stop_measuring
from diorama_app.page import Action, LiveHtml, button, text
from diorama_app.units import format_length, parse_length


class Tape:
    """Shown while two points are marked."""

    def __init__(self, gui: viser.GuiApi, guest: Guest) -> None:
        self._guest = guest
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the length, and ask for the true one."""
        length = measured_m(self._guest.doing)
        if length is None:
            self._html.show("")
            return
        shown = text(format_length(length, self._guest.settings.unit))
        self._html.show(
            f'<div class="card"><b>{shown}</b> between the two points.'
            '<div style="display:flex;gap:4px;margin-top:6px;align-items:center">'
            f'<input data-change="true" placeholder="true length, e.g. 2.4 m" aria-label="True length" '
            f'title="Everything is scaled so that this length holds">{button("Done", "done")}</div></div>'
        )

    def _act(self, action: Action) -> None:
        guest = self._guest

        def done() -> None:
            stop_measuring(guest)
            guest.refresh()

        if action.do == "true" and action.pair[1].strip():
            words = action.pair[1]
            guest.post(lambda: rescale_measured(guest, parse_length(words, guest.settings.unit)))
        elif action.do == "done":
            guest.post(done)
