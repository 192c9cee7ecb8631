"""Edits in words: proposed in the background, looked at, then made as one undo step or dropped."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_core.errors import EditRefused
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene

if TYPE_CHECKING:
    from diorama_core.text.editing_by_words import ProposedEdits

LABEL_CHARS = 60


@dataclass(eq=False)
class WordEdits:
    """The edits that one client has asked for in words and not yet made."""

    client: Client
    proposed: ProposedEdits | None = None
    refused: str = ""
    """Why the last command cannot be done."""
    _before: Scene | None = None

    def ask(self, words: str) -> None:
        """Work out what a command would do, and show it."""
        from diorama_core.perception.language.client import LmmSettings

        client, session = self.client, self.client.session
        session.need_writable()
        self.cancel()
        request = " ".join(words.split())
        if not request:
            return
        scene, settings = session.scene, LmmSettings.from_environment()

        def work(progress: Progress) -> None:
            from diorama_core.text.editing_by_words import propose_edits  # the page opens without it

            try:
                proposed = propose_edits(
                    request,
                    scene,
                    session.offer,
                    selected=client.selection,
                    language_model=settings,
                    progress=progress,
                )
            except EditRefused as error:
                why = str(error)
                client.post(lambda: self._show(None, why, scene))
                return
            client.post(lambda: self._show(proposed, "", scene))

        session.jobs.start("words", _("Interpreting your request"), work)

    def apply(self) -> None:
        """Make the proposed edits, as one undo step."""
        session, proposed = self.client.session, self.proposed
        if proposed is None:
            raise EditRefused("there are no edits to make; say what to change first")
        if session.scene is not self._before:
            self.ask(proposed.command)
            raise EditRefused("the scene has changed since; look at the edits again")
        self.cancel()
        label = proposed.command if len(proposed.command) <= LABEL_CHARS else f"{proposed.command[:LABEL_CHARS]}…"
        session.edit(label, lambda scene: proposed.scene, by=self.client, selection=proposed.changed, by_hand=True)

    def cancel(self) -> None:
        """Drop the proposed edits."""
        self.proposed, self.refused, self._before = None, "", None
        self.client.refresh()

    def _show(self, proposed: ProposedEdits | None, refused: str, scene: Scene) -> None:
        self.proposed, self.refused, self._before = proposed, refused, scene
        self.client.refresh()
