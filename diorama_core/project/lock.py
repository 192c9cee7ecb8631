"""One program at a time changes a project; the others see who it is.

The lock is the operating system's, so that it ends with the program, however that ends. Who has it lies beside it.
"""

from __future__ import annotations

import contextlib
import getpass
import os
import socket
import time
from pathlib import Path
from types import TracebackType

from filelock import FileLock, Timeout

from diorama_core.errors import ProjectError
from diorama_core.io.atomic import write_json
from diorama_core.io.bounded import read_json, shorten

LOCK = ".diorama.lock"
OWNER = ".diorama-owner.lock"
MAX_OWNER, MAX_OWNER_BYTES = 150, 10_000


class ProjectLockedError(ProjectError):
    """Another program has the project open for changes."""


class ProjectLock:
    """The right to change a project, until `release`. Also a context manager."""

    def __init__(self, folder: Path, what: str = "Diorama") -> None:
        """Take the lock.

        Args:
            folder: the project's.
            what: who says so to others, such as "the editor".

        Raises:
            ProjectLockedError: another program has it; the message says which.
            ProjectError: the folder cannot be written.
        """
        self.folder = folder
        self._lock = FileLock(folder / LOCK, timeout=0)
        try:
            self._lock.acquire()
        except Timeout:
            raise ProjectLockedError(
                f"{folder.name} is open in {owner(folder)}; close it there, or work on a copy"
            ) from None
        except (OSError, NotImplementedError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise ProjectError(f"{folder} cannot be changed ({reason}); copy it where you may write") from error
        about = {
            "what": what,
            "who": _user(),
            "host": socket.gethostname(),
            "process": os.getpid(),
            "since": time.strftime("%d %b %H:%M"),
        }
        try:
            write_json(folder / OWNER, about, ProjectError, most=MAX_OWNER_BYTES)
        except ProjectError:
            self._lock.release()
            raise

    def release(self) -> None:
        """Let others change the project. Doing it twice does nothing."""
        if not self._lock.is_locked:
            return
        with contextlib.suppress(OSError):
            (self.folder / OWNER).unlink()
        with contextlib.suppress(OSError):
            self._lock.release()

    def __enter__(self) -> ProjectLock:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.release()


def owner(folder: Path) -> str:
    """Who has a project's lock, in words."""
    try:
        about = read_json(folder / OWNER, ProjectError, most=MAX_OWNER_BYTES)
        words = f"{about['what']} of {about['who']} on {about['host']} (process {about['process']}, {about['since']})"
        return shorten(words, MAX_OWNER)
    except (ProjectError, LookupError, TypeError):
        return "another program"


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):
        return "somebody"
