"""Files that appear whole or not at all, whatever happens while they are written, and documents that are read once
before they replace the older file.
"""

from __future__ import annotations

import json
import os
import secrets
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO, Protocol, runtime_checkable

from diorama_core.errors import DioramaError
from diorama_core.io.bounded import MAX_JSON_BYTES, Kind, megabytes, parse_json, shorten
from diorama_core.io.text import clean_strings

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
        with _delete_on_failure(part):
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
def _delete_on_failure(part: Path) -> Iterator[None]:
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


def write_document(
    path: Path, data: bytes, read: Callable[[bytes], object], error: Kind, *, most: int = MAX_JSON_BYTES
) -> None:
    """Replace a file by a document, whole or not at all, once it is sure that the document can be read again.

    Args:
        path: The file; missing folders above it are made.
        data: Its whole content.
        read: What reads such a file; raises a `DioramaError` where it cannot.
        error: What a failure is raised as.
        most: Bytes that a reader takes.

    Raises:
        error: the document could not be read again, or the disk refuses; the older file stays as it was.
    """
    try:
        if len(data) > most:
            raise error(f"it has more than the {megabytes(most)} that are read")
        read(data)
    except DioramaError as reason:
        why = shorten(str(reason))
        raise error(f"{path} stays as it was, since what was to be written could not be read again: {why}") from reason
    write_atomically(path, data, error=error)


def write_json(
    path: Path, document: Any, error: Kind, *, most: int = MAX_JSON_BYTES, indent: int | None = None
) -> None:
    """Replace a file by a JSON document; strings in it are cleaned, see `clean_text`.

    Args:
        path: The file; missing folders above it are made.
        document: Of dictionaries, lists, strings and finite numbers.
        error: What a failure is raised as.
        most: Bytes that a reader takes.
        indent: Spaces a level; None puts all into one line.

    Raises:
        error: as `write_document`; a number that is not finite cannot be read again.
    """
    try:
        data = json.dumps(clean_strings(document), indent=indent).encode()
    except (ValueError, RecursionError) as reason:
        raise error(f"{path} stays as it was: a value cannot be written ({shorten(str(reason))})") from reason
    write_document(path, data, lambda known: parse_json(known, path.name, error), error, most=most)
