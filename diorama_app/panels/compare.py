"""A slider at the foot of the view that fades between the model and the photo."""

from __future__ import annotations

import viser

from diorama_app.commands.camera_presets import Views
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, text

STEP = 5
_LIVE = "this.dispatchEvent(new Event('change',{bubbles:true}))"
"""Tells every step while the slider is being pulled, not only where it is let go."""


class Compare:
    """Looks through the photo's camera and lays the photo over the model: 0 shows the model, 100 the photo."""

    def __init__(self, gui: viser.GuiApi, client: Client, views: Views) -> None:
        self._client, self._views = client, views
        self._html = LiveHtml(gui, self._act, floating="dio-compare")
        self._drawn: int | None = None
        """What the slider was last drawn with; None: it is not there."""

    def refresh(self) -> None:
        """Offer it where there is a photo to compare with; show all or nothing where something else asked."""
        canvas = self._client.view.canvas
        if None in self._client.looked_through or canvas.is_open or self._client.plan:
            self._drawn = None
            self._html.show("")
            return
        shown = round(100 * self._client.view.photo.opacity)
        if self._drawn is None or (shown in (0, 100) and shown != self._drawn):
            self._drawn = shown
            self._html.show(_slider(shown), again=True)

    def _act(self, action: Action) -> None:
        words = action.pair[1]
        if action.do != "over" or not words.isdecimal():
            return
        share = min(int(words), 100)

        def fade() -> None:
            self._drawn = share  # a value in the hand is left alone
            self._views.overlay(self._client, share / 100)

        self._client.post(fade, key="over")


def _slider(value: int) -> str:
    return (
        f'<label title="{text(_("Fade between the model and the photo in the photo view"))}">'
        f"<span>{text(_('Model'))}</span>"
        f'<input type="range" min="0" max="100" step="{STEP}" value="{value}" data-change="over" oninput="{_LIVE}" '
        f'aria-label="{text(_("Opacity of the photo over the model"))}"><span>{text(_("Photo"))}</span></label>'
    )
