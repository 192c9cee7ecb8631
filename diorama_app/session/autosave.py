"""Autosave: every committed scene is in its project's folder within a second."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from diorama_app.session.recovery import Recovery
from diorama_core.errors import DioramaError
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene

SETTLE_S = 0.4
"""Quick edits in a row are written once."""


class Autosave:
    """A thread that writes the newest scene. May be used from any thread."""

    def __init__(self, on_error: Callable[[str], None], recovery: Recovery | None = None) -> None:
        """Start the thread.

        Args:
            on_error: told in one line why something was not saved.
            recovery: where changes lie until they are saved.
        """
        self._on_error = on_error
        self.recovery = recovery or Recovery()
        self._condition = threading.Condition()
        self._waiting: tuple[Project, Scene] | None = None
        self._busy = False
        self._stopping = False
        self.saved_at: float | None = None
        self._thread = threading.Thread(target=self._work, daemon=True, name="autosave")
        self._thread.start()

    def save_soon(self, project: Project, scene: Scene) -> None:
        """Write this scene, unless a newer one comes first."""
        with self._condition:
            if self._waiting is not None and self._waiting[0] != project:
                self._write(*self._waiting)
            self._waiting = (project, scene)
            self._condition.notify_all()

    def flush(self) -> None:
        """Write what waits, now."""
        with self._condition:
            while self._busy:
                self._condition.wait(0.1)
            waiting, self._waiting = self._waiting, None
        if waiting is not None:
            self._write(*waiting)

    def stop(self) -> None:
        """Write what waits and end the thread."""
        self.flush()
        with self._condition:
            self._stopping = True
            self._condition.notify_all()
        self._thread.join(timeout=5.0)

    def _work(self) -> None:
        while True:
            with self._condition:
                while self._waiting is None and not self._stopping:
                    self._condition.wait()
                if self._stopping:
                    return
                newest, self._busy = self._waiting, True
            if newest is not None:
                self.recovery.note(*newest)
            with self._condition:
                self._busy = False
                self._condition.notify_all()
            time.sleep(SETTLE_S)
            with self._condition:
                waiting, self._waiting = self._waiting, None
                self._busy = waiting is not None
            if waiting is not None:
                self._write(*waiting)
            with self._condition:
                self._busy = False
                self._condition.notify_all()

    def _write(self, project: Project, scene: Scene) -> None:
        try:
            project.save_scene(scene)
            self.saved_at = time.time()
            self.recovery.forget(project)
        except DioramaError as error:
            self.recovery.note(project, scene)
            self._on_error(f"not saved: {error}; the changes are kept and offered when the project is opened again")
