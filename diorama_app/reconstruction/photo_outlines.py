"""Masks of the objects in the open project's photo, computed on first use."""

from __future__ import annotations

from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.strings import _
from diorama_core.artefacts import DetectedObject, Inputs
from diorama_core.errors import EditRefused
from diorama_core.progress import Progress


class PhotoOutlines:
    """Used from the UI thread only."""

    def __init__(self, session: EditorSession) -> None:
        self._session = session
        self._of: Inputs | None = None
        self._found: tuple[DetectedObject, ...] = ()

    @property
    def objects(self) -> tuple[DetectedObject, ...] | None:
        """What was outlined in the photo that is open; None while that is not known."""
        return self._found if self._of is not None and self._of.photo is self._session.photo else None

    def find(self, client: Client) -> None:
        """Outline what is in the photo as the build did, from the project's saved results where they are."""
        session = self._session
        project, inputs = session.project, session.document.inputs
        if project is None or inputs is None:
            raise EditRefused("this scene has no photo; upload one in the Photo tab")
        if inputs is self._of:
            return

        def work(progress: Progress) -> None:
            from diorama_core.pipeline.fallback import with_usable_networks
            from diorama_core.pipeline.plan import evaluate
            from diorama_core.pipeline.presets import stages_for
            from diorama_core.pipeline.runner import Runner

            runner = Runner(project.stages_folder)
            outlined, _unused = with_usable_networks(
                lambda store: stages_for("auto", inputs, session.offer, store=store),
                lambda stages: evaluate(stages, {"given": inputs}, ("objects",), runner, progress)["objects"],
            )

            def keep() -> None:
                self._of, self._found = inputs, outlined
                session.refresh_panels()

            client.post(keep)

        session.jobs.start("outline", _("Segmenting the photo"), work)
