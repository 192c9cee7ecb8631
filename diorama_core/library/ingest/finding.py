"""Models of a folder before any is read: which files they are, their ids, and what a table says of them."""

from __future__ import annotations

import csv
import hashlib
import io
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from diorama_core.errors import InputError
from diorama_core.io.bounded import read_bytes, shorten
from diorama_core.io.file_heads import OtherFile, head_of, what_else
from diorama_core.library.ingest.given import Given
from diorama_core.library.ingest.models import SUFFIXES, form_of
from diorama_core.library.ingest.shaping import ModelSource

REVISION = 2
"""Version of what ingestion makes of a file: raise it when results change; a repeated run takes files in anew."""
MAX_TABLE_BYTES = 64_000_000
BESIDE = frozenset({
    ".mtl", ".bin", ".png", ".jpg", ".jpeg", ".tga", ".bmp", ".webp", ".tif", ".tiff", ".gif", ".dds", ".ktx2", ".txt",
    ".md", ".csv", ".json", ".html", ".pdf", ".url", ".psd", ".license", ".py", ".xml",
})  # fmt: skip
"""What lies beside models: pictures and texts, which nobody takes for a model."""
_COLUMNS = ("file", "up", "front", "unit", "category", "caption", "licence")


@dataclass(frozen=True)
class Trouble:
    """A file that was not taken in, and why."""

    path: Path
    reason: str


def model_files(folder: Path) -> tuple[tuple[Path, ...], tuple[Trouble, ...]]:
    """Models under a folder, in a stable order, and those in formats that are not read. Links are not followed.

    Raises:
        InputError: when the folder cannot be read.
    """
    if not folder.is_dir():
        raise InputError(f"{folder} is no folder; name the folder that holds the models")
    paths: list[Path] = []
    skipped: list[Trouble] = []
    for here, folders, names in os.walk(folder):
        folders[:] = sorted(f for f in folders if not f.startswith("."))
        for name in sorted(names):
            path = Path(here, name)
            if name.startswith(".") or path.is_symlink():
                continue
            if path.suffix.lower() in (*SUFFIXES, ".zip"):
                paths.append(path)
            else:
                other = _other(path)
                skipped += [Trouble(path, f"{other.name}: {other.advice}")] if other is not None else []
    return tuple(paths), tuple(skipped)


def _other(path: Path) -> OtherFile | None:
    """What a file is that is no model, where people may have meant it as one."""
    if path.suffix.lower() in BESIDE:
        return None
    try:
        return what_else(head_of(path))
    except InputError:
        return None


def members_of(path: Path) -> tuple[str, ...]:
    """Models in a zip archive, of several formats of one model the first that is read; nothing of another file."""
    head = head_of(path)
    if path.suffix.lower() != ".zip" or not head.is_zip or form_of(head) is not None:
        return ()
    order = {suffix: k for k, suffix in enumerate(SUFFIXES)}
    best: dict[str, str] = {}
    for name in sorted(head.names):
        stem, suffix = str(Path(name).with_suffix("")), Path(name).suffix.lower()
        if suffix in order and order[suffix] < order.get(Path(best.get(stem, "")).suffix.lower(), len(order)):
            best[stem] = name
    return tuple(best.values())


def sources(
    folder: Path, paths: Sequence[Path], given: Given, table: Mapping[str, Given], ids: Mapping[Path, str] | None = None
) -> tuple[ModelSource, ...]:
    """What to take in: an id for each file, and what is known of it.

    Args:
        folder: That the user named; ids follow from the paths within it.
        paths: Models in it.
        given: What holds for all of them.
        table: What holds for single files, by their path within the folder.
        ids: Ids that a data set gives its models; others are made from the path.
    """
    taken: set[str] = set()
    made = []
    for path in paths:
        within = path.relative_to(folder).as_posix()
        members = members_of(path)
        for member in members or ("",):
            stem = within.rsplit(".", 1)[0]
            named = f"{stem}/{Path(member).with_suffix('').as_posix()}" if len(members) > 1 else stem
            target = (ids or {}).get(path) or slug(named)
            shape_id = next(i for i in _variants(target, path.suffix[1:].lower()) if i not in taken)
            taken.add(shape_id)
            known = table[within].override(given) if within in table else given
            key = _key(path, f"{within}{member}", shape_id, known)
            made.append(ModelSource(path, folder, shape_id, key, known, member))
    return tuple(made)


def read_table(path: Path) -> dict[str, Given]:
    """A CSV with a column `file` (path within the folder) and any of the others of `_COLUMNS`; units in metres.

    Raises:
        InputError: when it cannot be read, or a value makes no sense; names the line.
    """
    data = read_bytes(path, MAX_TABLE_BYTES, InputError, "name a CSV file")
    try:
        reader = csv.DictReader(io.StringIO(data.decode("utf-8-sig"), newline=""))
        if "file" not in (reader.fieldnames or ()):
            raise InputError(f"{path}: the first line must name the columns, with 'file' among {', '.join(_COLUMNS)}")
        return {row["file"]: _row(path, reader.line_num, row) for row in reader if row.get("file")}
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path} cannot be read as CSV ({error})") from error


def _row(path: Path, line: int, row: Mapping[str, str | None]) -> Given:
    value = {k: (row.get(k) or "").strip() for k in _COLUMNS}
    try:
        return Given(
            up=value["up"] or None,
            front=value["front"] or None,
            unit_m=float(value["unit"]) if value["unit"] else None,
            category=value["category"] or None,
            caption=value["caption"],
            licence=value["licence"],
            reason=f"{path.name}",
        )
    except (InputError, ValueError) as error:
        raise InputError(f"{path}, line {line}: {shorten(str(error))}") from error


def slug(text: str) -> str:
    """A text as an id: small letters, digits and hyphens."""
    return re.sub(r"[^a-z0-9]+", "-", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "-", text).lower()).strip("-")[:120] or "shape"


def _variants(target: str, suffix: str) -> Iterator[str]:
    yield target
    yield f"{target}-{suffix}"
    number = 2
    while True:
        yield f"{target}-{number}"
        number += 1


def _key(path: Path, within: str, shape_id: str, given: Given) -> str:
    try:
        state = path.stat()
        stamp = f"{state.st_size} {state.st_mtime_ns}"
    except OSError:
        stamp = "unreadable"
    return hashlib.sha256(f"{REVISION} {within} {shape_id} {stamp} {given}".encode()).hexdigest()[:32]
