"""Writing documents that can be read back: what is written is read before it replaces the older file."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from diorama_core.errors import DioramaError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import MAX_JSON_BYTES, Kind, megabytes, parse_json, shortened
from diorama_core.io.text import clean_strings


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
        why = shortened(str(reason))
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
        raise error(f"{path} stays as it was: a value cannot be written ({shortened(str(reason))})") from reason
    write_document(path, data, lambda known: parse_json(known, path.name, error), error, most=most)
