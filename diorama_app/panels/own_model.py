"""Corrections of what was guessed about an uploaded model: orientation, unit, category."""

from __future__ import annotations

import viser

from diorama_app.commands.import_model import FIXES, correct_model, is_own_model
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.library.record import Shape


class OwnModel:
    """Shown for objects with an uploaded shape."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw what was guessed about the selected object's model, and ways to correct it."""
        item = self._client.selected
        if item is None or not is_own_model(self._client.session, item.shape_id):
            self._html.show("")
            return
        shape = self._client.session.library.shape(item.shape_id)
        fixes = "".join(button(_(fix.name), "fix", name, title=_(fix.hint)) for name, fix in FIXES.items())
        self._html.show(
            f'<h4>{text(_("Your model"))}</h4><div class="dim">{text(_guessed(shape))}</div>'
            f'<div class="bar tight">{fixes}</div>'
            '<div style="display:flex;gap:4px;margin-bottom:4px">'
            f'<input data-change="is" aria-label="{text(_("What the model is"))}" value="{text(_(shape.category))}" '
            f'title="{text(_("Type what the model is and press Enter"))}"></div>'
        )

    def _act(self, action: Action) -> None:
        client = self._client
        if action.do == "fix" and action.arg in FIXES:
            client.post(lambda: correct_model(client, client.need_selected(), FIXES[action.arg]))
        elif action.do == "is":
            client.post(lambda: correct_model(client, client.need_selected(), category=action.pair[1]))


def _guessed(shape: Shape) -> str:
    """The guesses as a sentence."""
    if shape.guess is None:
        return _("Guessed: {category}.").format(category=_(shape.category))
    sure = round(100 * min(shape.guess.up.confidence, shape.guess.front.confidence))
    unit = shape.guess.unit.value
    return _("Guessed: {category}; one unit is {unit} m; {sure} % sure which side is up. Correct it here.").format(
        category=_(shape.category), unit=unit, sure=sure
    )
