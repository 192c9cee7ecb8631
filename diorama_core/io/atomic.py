"""Writing files so that a crash or a full disk never leaves half of one."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from diorama_core.errors import ProjectError


def write_atomically(path: Path, data: bytes) -> None:
    """Write beside the target and rename over it.

    Raises:
        ProjectError: when the folder cannot be written; the old file is untouched.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, part = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
    except OSError as error:
        raise ProjectError(
            f"cannot write in {path.parent} ({error.strerror}); choose a folder you may write to"
        ) from error
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(part, path)
    except OSError as error:
        Path(part).unlink(missing_ok=True)
        raise ProjectError(
            f"cannot write {path} ({error.strerror}); free some space or choose another folder"
        ) from error
