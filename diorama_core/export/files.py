"""Writing files whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from diorama_core.errors import ExportError


def write_whole(path: Path, content: bytes) -> None:
    """Write beside the target and rename, so that the target is never half a file.

    Raises:
        ExportError: when the folder is missing, not writable or full; an older file at `path` stays as it was.
    """
    temporary: str | None = None
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except OSError as error:
        if temporary is not None and os.path.exists(temporary):
            os.unlink(temporary)
        reason = error.strerror or str(error)
        raise ExportError(f"cannot write {path}: {reason}; choose a folder that exists and is writable") from error
