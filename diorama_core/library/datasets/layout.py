"""What a data set says of its models."""

from __future__ import annotations

import csv
import gzip
import io
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import megabytes, parse_json, read_bytes
from diorama_core.library import taxonomy
from diorama_core.library.ingest.finding import sources
from diorama_core.library.ingest.given import Given
from diorama_core.library.ingest.shaping import ModelSource

MAX_METADATA_BYTES = 600_000_000
"""Bytes of one file of a data set, unpacked; the largest published ones have a tenth of it."""
_ADVICE = "download it again"


@dataclass(frozen=True)
class DatasetEntry:
    """One model of a data set."""

    path: Path
    id: str
    words: tuple[str, ...]
    """What the data set calls it, the most telling first: 'dining chair', 'Chair/Stool'."""
    given: Given
    """Axes and unit, licence and caption; the category follows from the words."""


@dataclass(frozen=True)
class Dataset:
    """How one data set is laid out."""

    name: str
    marks: tuple[str, ...]
    """Files or folders (patterns) of its layout; a folder that has one of them is taken for it."""
    entries: Callable[[Path], Iterator[DatasetEntry]]
    """Its models under a folder, in a stable order; those whose files are absent are left out."""


def as_sources(dataset: Dataset, folder: Path, given: Given) -> tuple[ModelSource, ...]:
    """The models of a local copy, ready to be taken in; `given` (flags of the user) goes before what the set says.

    Raises:
        InputError: when no model is found, or its metadata cannot be read.
    """
    entries = list(dataset.entries(folder))
    if not entries:
        raise InputError(f"{folder}: no model of {dataset.name} lies there; name the folder that it was unpacked to")
    known = {e.path.relative_to(folder).as_posix(): given.over(_named(e, dataset)) for e in entries}
    ids = {e.path: e.id for e in entries}
    return sources(folder, [e.path for e in entries], Given(), known, ids)


def _named(entry: DatasetEntry, dataset: Dataset) -> Given:
    """What the set says, with the category that its words mean; its own words become synonyms."""
    category = next((c for w in entry.words for c in [taxonomy.resolve(w)] if w and c.exact), None)
    name = category.category.name if category is not None else taxonomy.UNKNOWN.name
    words = tuple(dict.fromkeys(w.lower() for w in entry.words if w and w.lower() != name))
    caption = entry.given.caption or (words[0] if words else name)
    return replace(
        entry.given,
        category=name if entry.words else None,
        caption=caption,
        synonyms=words,
        source=dataset.name,
        reason=dataset.name,
    )


def read_json(path: Path) -> Any:
    """A JSON file, gzipped or not; raises `InputError` when it cannot be read."""
    return json_from(path, read_text(path))


def json_from(path: Path, text: str) -> Any:
    """JSON out of a file's text; raises `InputError` naming the file."""
    return parse_json(text, str(path), InputError, advice=_ADVICE, finite=False)


def read_text(path: Path) -> str:
    """A text file, gzipped or not; raises `InputError` when it cannot be read."""
    data = read_bytes(path, MAX_METADATA_BYTES, InputError, _ADVICE)
    try:
        return (_unzipped(data) if path.suffix == ".gz" else data).decode("utf-8-sig")
    except (OSError, EOFError, ValueError, zlib.error) as error:
        raise InputError(f"{path} cannot be read ({error}); {_ADVICE}") from error


def _unzipped(data: bytes) -> bytes:
    """The content of a gzip file, of at most `MAX_METADATA_BYTES`."""
    with gzip.GzipFile(fileobj=io.BytesIO(data)) as stream:
        content = stream.read(MAX_METADATA_BYTES + 1)
    if len(content) > MAX_METADATA_BYTES:
        raise ValueError(f"it would unpack to more than {megabytes(MAX_METADATA_BYTES)}")
    return content


def read_rows(path: Path) -> list[dict[str, str]]:
    """A CSV, gzipped or not, with its first line as names (lower case)."""
    rows = csv.reader(read_text(path).splitlines())
    names = [name.strip().lower() for name in next(rows, [])]
    return [dict(zip(names, (value.strip() for value in row), strict=False)) for row in rows if row]


def first(folder: Path, *patterns: str) -> Path | None:
    """The first file that a pattern finds."""
    return next((p for pattern in patterns for p in sorted(folder.glob(pattern))), None)


def spoken(word: str) -> str:
    """`coffee_table`, `KITCHEN_STOOL` and `Lounge Chair / Cafe Chair` as people say it."""
    return " ".join(word.replace("_", " ").split("/")[0].split("(")[0].lower().split())
