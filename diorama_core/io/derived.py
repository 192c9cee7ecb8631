"""Files that can be made again at any time: a folder that cannot be read or written costs time, nothing else."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

import numpy as np

from diorama_core.errors import InputError
from diorama_core.io.arrays import arrays_of, npz_bytes
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_bytes, shorten

log = logging.getLogger(__name__)

T = TypeVar("T")
MAX_DERIVED_BYTES = 400_000_000


def read_derived(path: Path) -> bytes | None:
    """A file's bytes; None when it is absent, cannot be read, or is larger than any real one."""
    try:
        return read_bytes(path, MAX_DERIVED_BYTES, InputError)
    except InputError:
        return None


def derive(path: Path, make: Callable[[], bytes], value_of: Callable[[bytes], T]) -> T:
    """The value in a file, which is made and written when it is absent or damaged.

    Args:
        path: The file.
        make: Makes its content.
        value_of: Reads the content; raises anything when it is damaged.
    """
    known = _value_in(path, value_of)
    if known is not None:
        return known
    data = make()
    write_derived(path, data)
    return value_of(data)


def _value_in(path: Path, value_of: Callable[[bytes], T]) -> T | None:
    """The value in a file; None when it is absent or damaged."""
    data = read_derived(path)
    if data is None:
        return None
    try:
        return value_of(data)
    except Exception as error:  # damaged bytes raise almost anything, and all of it means the same
        log.warning("%s is damaged (%s); it is made again", path, shorten(str(error)) or type(error).__name__)
        return None


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
    arrays = _value_in(path, lambda content: arrays_of(content, names))
    if arrays is not None and mark_use:
        with suppress(OSError):  # another's folder may be read but not touched
            os.utime(path)
    return arrays


def write_arrays(path: Path, arrays: Mapping[str, np.ndarray], *, limit_bytes: int | None = None) -> None:
    """Write an `.npz` file like `write_derived`."""
    write_derived(path, npz_bytes(arrays), limit_bytes=limit_bytes)


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
