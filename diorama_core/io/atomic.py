"""Files that appear whole or not at all, whatever happens while they are written."""

from __future__ import annotations

import os
import secrets
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO, Protocol, runtime_checkable

from diorama_core.errors import DioramaError

LEFTOVER_S = 3600.0
"""A part older than this belongs to a program that was killed."""


@runtime_checkable
class ByteSink(Protocol):
    """Where bytes are written: a binary file, memory, or a member of an archive."""

    def write(self, data: bytes | bytearray, /) -> object:
        """Append bytes."""
        ...


def write_atomically(path: Path, data: bytes, *, error: type[DioramaError] | None = None) -> None:
    """Replace a file by `data`; see `open_atomically`.

    Args:
        path: The file; missing folders above it are made.
        data: Its whole content.
        error: What a failure is raised as; see `open_atomically`.
    """
    with open_atomically(path, error=error) as stream:
        stream.write(data)


@contextmanager
def open_atomically(path: Path, *, error: type[DioramaError] | None = None) -> Iterator[BinaryIO]:
    """A binary stream whose content becomes the file when the block ends without an exception.

    The content is written beside the target, flushed to the disk and renamed over the target, so that a reader, a crash
    and a full disk see the old file or the new one. The file's mode follows the umask, as that of any new file. When
    the block or the disk fails, the part that was written is deleted and an older file stays as it was.

    Args:
        path: The file; missing folders above it are made.
        error: Class that an `OSError` is translated into, with one line of advice; None passes the `OSError` on, for
            callers that have better advice.

    Raises:
        OSError: when the folder or the disk refuses and no `error` is given; else `error`.
    """
    try:
        part = _new_part(path)
    except OSError as cause:
        if error is None:
            raise
        raise error(f"cannot write in {path.parent} ({_reason(cause)}); choose a folder you may write to") from cause
    try:
        with _deleted_on_failure(part):
            with part.open("wb") as stream:
                yield stream
                stream.flush()
                os.fsync(stream.fileno())
            os.replace(part, path)
    except OSError as cause:
        if error is None:
            raise
        raise error(f"cannot write {path} ({_reason(cause)}); free some space or choose another folder") from cause


def _new_part(path: Path) -> Path:
    """An empty file beside the target, under a name that no other writer has."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.parent / f".{secrets.token_hex(8)}.part"
    # Not `tempfile`: its files are their owner's only, and libraries and caches may be shared.
    os.close(os.open(part, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    return part


@contextmanager
def _deleted_on_failure(part: Path) -> Iterator[None]:
    try:
        yield
    except BaseException:
        with suppress(OSError):
            part.unlink()
        raise


def _reason(cause: OSError) -> str:
    return cause.strerror or str(cause)


def remove_leftovers(folder: Path, older_s: float = LEFTOVER_S) -> int:
    """Remove the parts that killed programs left below a folder; returns how many."""
    removed = 0
    for part in folder.rglob(".*.part"):
        with suppress(OSError):
            if time.time() - part.stat().st_mtime > older_s:
                part.unlink()
                removed += 1
    return removed
