"""Stores changes that are not saved to their project yet, so that a crash or a full disk does not lose them.

What cannot be saved is noted and forgotten when the project's own file has it. What a later session finds is what an
earlier one could not save. A note's name holds a digest of the scene that it follows, so that no clock decides which of
them is newer.
"""

from __future__ import annotations

import contextlib
import hashlib
import logging
import os
import time
import uuid
from dataclasses import dataclass
from pathlib import Path

from diorama_core.errors import ProjectError
from diorama_core.io.atomic import remove_leftovers, write_document
from diorama_core.io.bounded import MAX_JSON_BYTES, read_bytes
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.project.storage import Project, read_scene
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.types import Scene

log = logging.getLogger(__name__)

FORGOTTEN_S = 30 * 86400.0
"""Unsaved changes of a project that nobody opened for so long are removed."""
SETTLED_S = 3.0
"""What is younger may be another program's that is about to save it."""
_DIGITS = 16
"""Of a digest, or of what tells sessions apart, in a note's name."""


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

    @property
    def is_settled(self) -> bool:
        """Whether no other program is about to save it."""
        return abs(time.time() - self.at) > SETTLED_S

    def follows(self, saved: str) -> bool:
        """Whether it is what came after the scene of this digest, and not before it."""
        return self.path.stem.split("-")[2:] in ([], [saved])

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
        self._session = uuid.uuid4().hex[:_DIGITS]

    def note(self, project: Project, scene: Scene) -> bool:
        """Remember a change before it is saved; False when it cannot be kept here."""
        path = self._folder / f"{_place(project)}-{self._session}-{_digest(project.scene_path)}.json"
        try:
            write_document(path, scene_to_json(scene).encode(), scene_from_json, ProjectError)
        except Exception as error:  # whatever it is, the thread that saves goes on
            log.warning("unsaved changes cannot be stored in %s (%r)", self._folder, error)
            return False
        self.forget(project, but=path)
        return True

    def forget(self, project: Project, but: Path | None = None) -> None:
        """The project's own file has everything, or one note has."""
        for path in self._folder.glob(f"{_place(project)}-{self._session}*.json"):
            try:
                if path != but:
                    path.unlink(missing_ok=True)
            except OSError as error:
                log.warning("%s cannot be removed (%s)", path, error)

    def find_unsaved(self, project: Project) -> Unsaved | None:
        """The newest change of an earlier session that the project's own file does not have."""
        saved = _digest(project.scene_path)
        candidates = [u for u in self._others(project) if u.is_settled and u.follows(saved)]
        newest = max(candidates, key=lambda u: u.at, default=None)
        return None if newest is None or _digest(newest.path) == saved else newest

    def clean_up(self, project: Project) -> None:
        """Remove what no session will ask for again: what was saved since, or is a month old, and parts of files.

        Only for who has the project's lock: another's unsaved changes are being saved.
        """
        saved = _digest(project.scene_path)
        for unsaved in self._others(project):
            if unsaved.is_settled and not unsaved.follows(saved):
                unsaved.discard()
        for path in self._folder.glob("*.json"):
            with contextlib.suppress(OSError):
                if time.time() - path.stat().st_mtime > FORGOTTEN_S:
                    path.unlink()
        remove_leftovers(self._folder)
        remove_leftovers(project.folder)

    def _others(self, project: Project) -> list[Unsaved]:
        unsaved = []
        for path in self._folder.glob(f"{_place(project)}-*.json"):
            with contextlib.suppress(OSError):  # its session may be removing it
                if path.stem.split("-")[1] != self._session:
                    unsaved.append(Unsaved(path, path.stat().st_mtime))
        return unsaved


def _place(project: Project) -> str:
    return hashlib.sha256(os.fsencode(project.folder.resolve())).hexdigest()[:_DIGITS]


def _digest(path: Path) -> str:
    """Digest of a scene file's content; `none` where it cannot be read."""
    try:
        return hashlib.sha256(read_bytes(path, MAX_JSON_BYTES, ProjectError)).hexdigest()[:_DIGITS]
    except ProjectError:
        return "none"
