"""A field for edits in words, and the list of what they would do, with Apply and Cancel."""

from __future__ import annotations

import viser

from diorama_app.commands.edit_by_words import WordEdits
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, library_text, text

EXAMPLE = N_("make all chairs wooden")
HINT = N_(
    "Type what to change, then press Enter. For example: a rug under the table; move the lamp beside the sofa; "
    "remove everything on the desk"
)


class EditByWords:
    """One line of text above the list of objects."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._edits = WordEdits(client)
        self._field = LiveHtml(gui, self._act)
        self._list = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the field and what is proposed."""
        session = self._client.session
        if not session.scene.objects and not session.scene.architecture.planes:
            self._field.show("")
            self._list.show("")
            return
        self._field.show(
            f'<input data-change="ask" style="width:100%;box-sizing:border-box" placeholder="{text(_(EXAMPLE))}" '
            f'aria-label="{text(_("Edit by words"))}" title="{text(_(HINT))}">'
        )
        self._list.show(self._proposal())

    def _proposal(self) -> str:
        edits = self._edits
        if edits.refused:
            return f'<p class="dim" role="alert">{library_text(edits.refused)}</p>'
        if edits.proposed is None:
            return ""
        lines = "".join(f"<li>{library_text(line)}</li>" for line in edits.proposed.lines)
        notes = "".join(f'<p class="dim">{library_text(note)}</p>' for note in edits.proposed.notes)
        return (
            f'<ul style="margin:4px 0;padding-left:18px" aria-label="{text(_("Proposed edits"))}">{lines}</ul>{notes}'
            '<div class="bar">'
            + button(_("Apply"), "apply", title=_("Make these edits; one undo reverts them all"), on=True)
            + button(_("Cancel"), "cancel", title=_("Change nothing"))
            + "</div>"
        )

    def _act(self, action: Action) -> None:
        if action.do == "ask":
            words = action.pair[1]
            self._client.post(lambda: self._edits.ask(words))
        elif action.do == "apply":
            self._client.post(self._edits.apply)
        elif action.do == "cancel":
            self._client.post(self._edits.cancel)
