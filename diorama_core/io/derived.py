"""Files that can be made again at any time: a folder that cannot be read or written costs time, nothing else."""

from __future__ import annotations

import logging
import os
import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from io import BytesIO
from pathlib import Path

import numpy as np

from diorama_core.io.atomic import write_atomically

log = logging.getLogger(__name__)


def read_derived(path: Path) -> bytes | None:
    """A file's bytes; None when it is absent or cannot be read."""
    try:
        return path.read_bytes()
    except OSError:
        return None


def derived(path: Path, make: Callable[[], bytes]) -> bytes:
    """A file's bytes; made and written when it is absent or cannot be read."""
    data = read_derived(path)
    if data is None:
        data = make()
        write_derived(path, data)
    return data


def write_derived(path: Path, data: bytes, *, limit_bytes: int | None = None) -> None:
    """Write a file, atomically; where that fails, warn in one line and go on.

    Args:
        path: The file.
        data: Its content.
        limit_bytes: Of all files in its folder; the least recently used ones are deleted to make room (see
            `read_arrays`).
    """
    try:
        if limit_bytes is not None:
            _make_room(path.parent, limit_bytes - len(data))
        write_atomically(path, data)
    except OSError as error:
        log.warning("cannot cache files in %s (%s); they are made again each time", path.parent, error)


def read_arrays(path: Path, *names: str, mark_use: bool = False) -> tuple[np.ndarray, ...] | None:
    """Arrays of an `.npz` file; None when it is absent or damaged or lacks one of them.

    Args:
        path: The file.
        names: Of the arrays.
        mark_use: Set the file's time, so that it is not the first to go when its folder is full.
    """
    try:
        with np.load(path, allow_pickle=False) as stored:
            arrays = tuple(stored[name] for name in names)
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
    if mark_use:
        with suppress(OSError):  # another's folder may be read but not touched
            os.utime(path)
    return arrays


def write_arrays(path: Path, arrays: Mapping[str, np.ndarray], *, limit_bytes: int | None = None) -> None:
    """Write an `.npz` file like `write_derived`."""
    data = BytesIO()
    np.savez(data, **dict(arrays))  # type: ignore[arg-type]  # numpy's stub confuses them with its own option
    write_derived(path, data.getvalue(), limit_bytes=limit_bytes)


def _make_room(folder: Path, room_bytes: int) -> None:
    """Delete files that were not used for longest until the others take `room_bytes` at most."""
    if not folder.exists():
        return
    files = sorted((e.stat().st_mtime, e.stat().st_size, e.path) for e in os.scandir(folder) if e.is_file())
    excess = sum(size for _, size, _ in files) - room_bytes
    for _, size, path in files:
        if excess <= 0:
            return
        Path(path).unlink(missing_ok=True)
        excess -= size
