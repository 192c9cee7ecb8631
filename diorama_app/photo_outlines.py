"""The outlines of what was found in the open project's photo, worked out once when somebody wants to see them."""

from __future__ import annotations

from diorama_app.guest import Guest
from diorama_app.room import Room
from diorama_core.artefacts import DetectedObject, Inputs
from diorama_core.errors import EditRefused
from diorama_core.progress import Progress


class PhotoOutlines:
    """Used from the desk's thread only."""

    def __init__(self, room: Room) -> None:
        self._room = room
        self._of: Inputs | None = None
        self._found: tuple[DetectedObject, ...] = ()

    @property
    def found(self) -> tuple[DetectedObject, ...] | None:
        """What was outlined in the photo that is open; None while that is not known."""
        return self._found if self._of is not None and self._of.photo is self._room.photo else None

    def find(self, guest: Guest) -> None:
        """Outline what is in the photo as the build did, from the project's saved results where they are."""
        room = self._room
        project, inputs = room.project, room.document.inputs
        if project is None or inputs is None:
            raise EditRefused("this scene has no photo; upload one in the Photo panel")
        if inputs is self._of:
            return

        def work(progress: Progress) -> None:
            from diorama_core.pipeline.perceive import perceived
            from diorama_core.pipeline.profiles import stages_for
            from diorama_core.pipeline.runner import Runner

            stages, runner = stages_for("auto", inputs, room.library), Runner(project.stages_folder)
            seen = perceived(inputs, stages, runner, progress.part(0.0, 0.2)).of_any_camera
            found = runner.run("objects", stages.objects, stages.objects.segment, (seen,), progress.part(0.2, 1.0))

            def keep() -> None:
                self._of, self._found = inputs, found
                room.refresh_panels()

            guest.post(keep)

        room.jobs.start("look", "Outlining what is in the photo", work)
