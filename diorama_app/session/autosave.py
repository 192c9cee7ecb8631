"""Autosave: every committed scene is in its project's folder within a second, or as soon as that is possible."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

from diorama_app.session.recovery import Recovery
from diorama_app.strings import N_, _
from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import DioramaError
from diorama_core.project.further_photos import save_photos
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene

log = logging.getLogger(__name__)

SETTLE_S = 0.15
"""Delay so that edits are displayed first; quick successive ones are written once."""
RETRY_S = 5.0
"""Interval between retries of a failed save."""

Told = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Unwritten:
    """What is to be written of one project."""

    scene: Scene | None = None
    inputs: Inputs | None = None
    further: tuple[FurtherPhoto, ...] | None = None

    def with_newer(self, newer: Unwritten) -> Unwritten:
        """The newer of each."""
        return Unwritten(
            self.scene if newer.scene is None else newer.scene,
            self.inputs if newer.inputs is None else newer.inputs,
            self.further if newer.further is None else newer.further,
        )


KEPT_BESIDE = N_(
    "Not saved: {reason}. The changes are stored beside the project and will be saved as soon as that is possible."
)
IN_MEMORY = N_(
    "Not saved: {reason}. The changes are only in memory: keep Diorama running, and free space or export the scene."
)


class Autosave:
    """A thread that writes the newest scene. May be used from any thread."""

    def __init__(
        self,
        on_error: Told,
        recovery: Recovery | None = None,
        *,
        on_saved: Told = lambda message: None,
        on_version: Callable[[], None] = lambda: None,
        retry_s: float = RETRY_S,
    ) -> None:
        """Start the thread.

        Args:
            on_error: told in one line why something was not saved, once until it is, or is no longer stored elsewhere.
            recovery: where changes lie until they are saved.
            on_saved: told in one line when something that could not be saved has been.
            on_version: told when a scene that was overwritten became an earlier version.
            retry_s: how often that is tried.
        """
        self._on_error, self._on_saved, self._on_version, self._retry_s = on_error, on_saved, on_version, retry_s
        self.recovery = recovery or Recovery()
        self.trouble = ""
        """Why saving fails at the moment; empty when it succeeds."""
        self._is_retained = False
        """Whether what could not be saved last lies beside the project."""
        self._condition = threading.Condition()
        self._writing = threading.RLock()
        """Locked from dequeuing until written, so that an older scene never overwrites a newer one."""
        self._waiting: dict[Project, Unwritten] = {}
        self._photos_saved: dict[Project, tuple[FurtherPhoto, ...]] = {}
        """Further photos as they are on disk."""
        self._scenes_saved: dict[Project, Scene] = {}
        """Scenes as they are on disk: what was saved is not written again when it is shown."""
        self._new = self._stopping = False
        self.saved_at: float | None = None
        self._thread = threading.Thread(target=self._work, daemon=True, name="autosave")
        self._thread.start()

    def save_soon(
        self,
        project: Project,
        scene: Scene | None,
        inputs: Inputs | None = None,
        further: tuple[FurtherPhoto, ...] | None = None,
    ) -> None:
        """Write this scene and what is said of the photo, unless newer ones of the same project come first.

        Args:
            project: where.
            scene: None where nothing was built yet.
            inputs: None where they are saved already.
            further: the other photos of the room; None where they are saved already.
        """
        with self._condition:
            waiting = self._waiting.get(project, Unwritten())
            self._waiting[project] = waiting.with_newer(Unwritten(scene, inputs, further))
            self._new = True
            self._condition.notify_all()

    def flush(self) -> None:
        """Write pending scenes now."""
        with self._writing:
            with self._condition:
                waiting, self._waiting = self._waiting, {}
            for project, unwritten in waiting.items():
                if not self._write(project, unwritten):
                    with self._condition:
                        self._waiting[project] = unwritten.with_newer(self._waiting.get(project, Unwritten()))

    def stop(self) -> None:
        """Write pending scenes and end the thread."""
        self.flush()
        with self._condition:
            self._stopping = True
            self._condition.notify_all()
        self._thread.join(timeout=5.0)

    def _work(self) -> None:
        while True:
            with self._condition:
                self._condition.wait_for(lambda: self._new or self._stopping, self._retry_s if self._waiting else None)
                if self._stopping:
                    return
                self._new = False
                self._condition.wait_for(lambda: self._stopping, SETTLE_S)
                if self._stopping:
                    return
            self.flush()

    def _write(self, project: Project, unwritten: Unwritten) -> bool:
        scene, new_version = unwritten.scene, False
        try:
            if unwritten.inputs is not None:
                project.save_inputs(unwritten.inputs, project.info().get("warnings", ()))
            if unwritten.further is not None:
                save_photos(project, unwritten.further, self._photos_saved.get(project, ()))
                self._photos_saved[project] = unwritten.further
            if scene is not None and not (scene is self._scenes_saved.get(project) and project.has_scene):
                new_version = project.save_scene(scene)
                self._scenes_saved[project] = scene
        except Exception as error:  # whatever it is, the work must be retained and tried again
            if not isinstance(error, DioramaError):
                log.exception("the scene of %s cannot be written", project.folder)
            reason = str(error) if isinstance(error, DioramaError) else f"the scene cannot be written ({error})"
            self._not_saved(reason, retained=scene is not None and self.recovery.note(project, scene))
            return False
        self.saved_at = time.time()
        self.recovery.forget(project)
        if new_version:
            self._on_version()
        if self.trouble:
            self.trouble = ""
            self._on_saved(_("All changes are saved now."))
        return True

    def _not_saved(self, reason: str, *, retained: bool) -> None:
        untold, told_retained = not self.trouble, self._is_retained
        self._is_retained = retained
        # The reason may name a file that has the time in its name: at each retry it is another one.
        self.trouble = _(KEPT_BESIDE if retained else IN_MEMORY).format(reason=_(reason))
        if untold or retained != told_retained:
            self._on_error(self.trouble)
