"""Changes that are not in their project's folder yet lie here, so that neither a crash nor a full disk loses them.

Every change is noted at once and forgotten when the project's own file has it, less than a second later. What a later
session finds is what an earlier one could not save.
"""

from __future__ import annotations

import hashlib
import logging
import time
import uuid
from dataclasses import dataclass
from pathlib import Path

from diorama_core.errors import DioramaError
from diorama_core.io.atomic import write_atomically
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.project.storage import Project
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.types import Scene

log = logging.getLogger(__name__)

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
        return scene_from_json(self.path.read_text())

    def discard(self) -> None:
        """Forget it."""
        self.path.unlink(missing_ok=True)


class Recovery:
    """The unsaved changes of one session. May be used from any thread."""

    def __init__(self, folder: Path | None = None) -> None:
        """Use a folder beside no project; by default one in the cache folder."""
        self._folder = folder or default_cache_dir() / "unsaved"
        self._session = uuid.uuid4().hex[:12]

    def note(self, project: Project, scene: Scene) -> None:
        """Remember a change before it is saved."""
        try:
            write_atomically(self._path(project, self._session), scene_to_json(scene).encode())
        except (OSError, DioramaError) as error:
            log.warning("unsaved changes cannot be kept in %s (%s)", self._folder, error)

    def forget(self, project: Project) -> None:
        """The project's own file has everything."""
        try:
            self._path(project, self._session).unlink(missing_ok=True)
        except OSError as error:
            log.warning("%s cannot be removed (%s)", self._path(project, self._session), error)

    def left_behind(self, project: Project) -> Unsaved | None:
        """The newest change of an earlier session that the project's own file does not have."""
        saved_at = project.scene_path.stat().st_mtime if project.scene_path.exists() else 0.0
        found = []
        for path in self._folder.glob(self._path(project, "*").name):
            at = path.stat().st_mtime
            if path != self._path(project, self._session) and saved_at < at < time.time() - SETTLED_S:
                found.append(Unsaved(path, at))
        newest = max(found, key=lambda u: u.at, default=None)
        if newest is None or not project.scene_path.exists():
            return newest
        return None if newest.path.read_bytes() == project.scene_path.read_bytes() else newest

    def _path(self, project: Project, session: str) -> Path:
        place = hashlib.sha256(str(project.folder.resolve()).encode()).hexdigest()[:16]
        return self._folder / f"{place}-{session}.json"
