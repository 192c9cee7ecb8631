"""Earlier versions of a project's scene: which are kept, in an order that no clock changes.

`scene-n000012-20261128T035000Z.json` is the twelfth. The number rises whatever the clock does; the time, in UTC, is for
people. Files of earlier programs, `scene-20261122-153000-123456789.json`, are older than all with a number.
"""

from __future__ import annotations

import re
import time
from dataclasses import dataclass
from pathlib import Path

from diorama_core.errors import ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import MAX_JSON_BYTES, read_bytes

MAX_BACKUPS = 20
BACKUP_EVERY_S = 60.0
_NUMBERED = re.compile(r"scene-n(\d{6,20})-\d{8}T\d{6}Z\.json")
_FORMER = re.compile(r"scene-\d{8}-\d{6}-\d{9}\.json")


@dataclass(frozen=True)
class Backups:
    """The folder of one project's earlier scenes."""

    folder: Path

    def paths(self) -> tuple[Path, ...]:
        """Earlier scene files, newest first; no links, and nothing that the program did not write."""
        known = [(number, p) for p in self.folder.glob("scene-*.json") if (number := _number(p)) is not None]
        return tuple(p for _, p in sorted(known, reverse=True) if p.is_file() and not p.is_symlink())

    def keep(self, scene: Path, *, at_once: bool) -> bool:
        """Keep a scene file that is about to be replaced: at most one a minute, and none twice in a row.

        Args:
            scene: the file.
            at_once: keep it also within a minute of the one before.

        Returns:
            Whether there is a new version.

        Raises:
            ProjectError: the scene cannot be read, or the folder cannot be written.
        """
        known = self.paths()
        if known and not at_once and abs(time.time() - known[0].stat().st_mtime) < BACKUP_EVERY_S:
            return False
        content = read_bytes(scene, MAX_JSON_BYTES, ProjectError)
        if known and _holds(known[0], content):
            return False
        number = 1 + max((_number(p) or 0 for p in known), default=0)
        stamp = time.strftime("%Y%m%dT%H%M%SZ", time.gmtime())
        write_atomically(self.folder / f"scene-n{number:06d}-{stamp}.json", content, error=ProjectError)
        self._prune()
        return True

    def _prune(self) -> None:
        """Delete the oldest; in a folder that a link leads to, somebody else's may lie."""
        if not self.folder.is_symlink():
            for old in self.paths()[MAX_BACKUPS:]:
                old.unlink(missing_ok=True)


def _holds(path: Path, content: bytes) -> bool:
    return path.stat().st_size == len(content) and read_bytes(path, MAX_JSON_BYTES, ProjectError) == content


def _number(path: Path) -> int | None:
    """Number of a version, by which they are sorted; None for a file that is none."""
    numbered = _NUMBERED.fullmatch(path.name)
    if numbered is not None:
        return int(numbered[1])
    return 0 if _FORMER.fullmatch(path.name) else None
