"""A field for edits in words, and the list of what they would do, with Apply and Cancel."""

from __future__ import annotations

import viser

from diorama_app.commands.edit_by_words import WordEdits
from diorama_app.session.client import Client
from diorama_app.web.html import Action, LiveHtml, button, text

EXAMPLE = "make all chairs wooden"


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
            f'<input data-change="ask" style="width:100%;box-sizing:border-box" placeholder="{text(EXAMPLE)}" '
            'aria-label="Edit by words" title="Say what to change, then press Enter: '
            'a rug under the table; move the lamp beside the sofa; remove everything on the desk">'
        )
        self._list.show(self._proposal())

    def _proposal(self) -> str:
        edits = self._edits
        if edits.refused:
            return f'<p class="dim" role="alert">{text(_sentence(edits.refused))}</p>'
        if edits.proposed is None:
            return ""
        lines = "".join(f"<li>{text(_sentence(line))}</li>" for line in edits.proposed.lines)
        notes = "".join(f'<p class="dim">{text(_sentence(note))}</p>' for note in edits.proposed.notes)
        return (
            f'<ul style="margin:4px 0;padding-left:18px" aria-label="Proposed edits">{lines}</ul>{notes}'
            '<div class="bar">'
            + button("Apply", "apply", title="Make these edits; one undo takes them all back", on=True)
            + button("Cancel", "cancel", title="Change nothing")
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


def _sentence(words: str) -> str:
    return f"{words[:1].upper()}{words[1:]}"
