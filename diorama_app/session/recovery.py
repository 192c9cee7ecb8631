"""Stores changes that are not saved to their project yet, so that a crash or a full disk does not lose them.

Every change is noted at once and forgotten when the project's own file has it, less than a second later. What a later
session finds is what an earlier one could not save.
"""

from __future__ import annotations

import contextlib
import hashlib
import logging
import time
import uuid
from dataclasses import dataclass
from pathlib import Path

from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.atomic import remove_leftovers, write_atomically
from diorama_core.io.bounded import MAX_JSON_BYTES, read_bytes
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.project.storage import Project, read_scene
from diorama_core.scene.schema import scene_to_json
from diorama_core.scene.types import Scene

log = logging.getLogger(__name__)

FORGOTTEN_S = 30 * 86400.0
"""Unsaved changes of a project that nobody opened for so long are removed."""
SETTLED_S = 3.0
"""What is younger may be another program's that is about to save it."""


@dataclass(frozen=True)
class Unsaved:
    """A scene that an earlier session could not save."""

    path: Path
    at: float
    """Seconds since the epoch."""

    @property
    def when(self) -> str:
        """The time, for people."""
        return time.strftime("%d %b %H:%M", time.localtime(self.at))

    def scene(self) -> Scene:
        """What was unsaved; raises `SceneError` when it cannot be read."""
        return read_scene(self.path)

    def discard(self) -> None:
        """Forget it."""
        self.path.unlink(missing_ok=True)


class Recovery:
    """The unsaved changes of one session. May be used from any thread."""

    def __init__(self, folder: Path | None = None) -> None:
        """Use a folder beside no project; by default one in the cache folder."""
        self._folder = folder or default_cache_dir() / "unsaved"
        self._session = uuid.uuid4().hex[:12]

    def note(self, project: Project, scene: Scene) -> bool:
        """Remember a change before it is saved; False when it cannot be kept here."""
        try:
            write_atomically(self._path(project, self._session), scene_to_json(scene).encode())
        except (OSError, ValueError, DioramaError) as error:
            log.warning("unsaved changes cannot be stored in %s (%s)", self._folder, error)
            return False
        return True

    def forget(self, project: Project) -> None:
        """The project's own file has everything."""
        try:
            self._path(project, self._session).unlink(missing_ok=True)
        except OSError as error:
            log.warning("%s cannot be removed (%s)", self._path(project, self._session), error)

    def left_behind(self, project: Project) -> Unsaved | None:
        """The newest change of an earlier session that the project's own file does not have."""
        try:
            saved_at = project.scene_path.stat().st_mtime if project.scene_path.exists() else 0.0
            saved = read_bytes(project.scene_path, MAX_JSON_BYTES, ProjectError) if saved_at else b""
        except (OSError, ProjectError):
            saved_at, saved = 0.0, b""
        found = [u for u in self._of_others(project) if saved_at < u.at < time.time() - SETTLED_S]
        newest = max(found, key=lambda u: u.at, default=None)
        try:
            return newest if newest is None or read_bytes(newest.path, MAX_JSON_BYTES, ProjectError) != saved else None
        except ProjectError:
            return None

    def clean_up(self, project: Project) -> None:
        """Remove what no session will ask for again: older than what is saved, or a month old, and parts of files.

        Only for who has the project's lock: another's unsaved changes are being saved.
        """
        saved_at = project.scene_path.stat().st_mtime if project.scene_path.exists() else 0.0
        now = time.time()
        for unsaved in self._of_others(project):
            if unsaved.at < saved_at and now - unsaved.at > SETTLED_S:
                unsaved.discard()
        for path in self._folder.glob("*.json"):
            with contextlib.suppress(OSError):
                if now - path.stat().st_mtime > FORGOTTEN_S:
                    path.unlink()
        remove_leftovers(self._folder)
        remove_leftovers(project.folder)

    def _of_others(self, project: Project) -> list[Unsaved]:
        found = []
        for path in self._folder.glob(self._path(project, "*").name):
            with contextlib.suppress(OSError):  # its session may be removing it
                if path != self._path(project, self._session):
                    found.append(Unsaved(path, path.stat().st_mtime))
        return found

    def _path(self, project: Project, session: str) -> Path:
        place = hashlib.sha256(str(project.folder.resolve()).encode()).hexdigest()[:16]
        return self._folder / f"{place}-{session}.json"
