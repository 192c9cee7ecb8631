"""The files of what was dropped, by the names that its readings have."""

from __future__ import annotations

import io
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from diorama_app.projects.dropped import MAX_BYTES, DroppedPhoto, is_one_file
from diorama_app.projects.reading_again import with_depth
from diorama_app.projects.uploads import Upload
from diorama_core.io.contained import unpack
from diorama_core.io.file_heads import head_of
from diorama_core.perception.inputs.sorting import Sort
from diorama_core.perception.inputs.source import Source

_NAMES_CLASSES = (".txt", ".names", ".yaml", ".yml", ".json")
"""Endings of files that may name the classes of boxes."""


def files_of(name: str, content: bytes) -> dict[str, bytes]:
    """The files of an archive by the names that readings have; of any other file itself.

    Raises:
        InputError: the archive is damaged.
    """
    if not content.startswith(b"PK\x03\x04"):
        return {Path(name).name: content}
    with tempfile.TemporaryDirectory(prefix="dropped-") as folder:
        path = Path(folder) / (Path(name).name or "file")
        path.write_bytes(content)
        if is_one_file(head_of(path)):
            return {path.name: content}
        with unpack(path, MAX_BYTES) as inside:
            return {p.relative_to(inside).as_posix(): p.read_bytes() for p in inside.rglob("*") if p.is_file()}


def upload_of(photo: DroppedPhoto, files: Mapping[str, bytes]) -> Upload:
    """A photo with the files that belong to it, each with what lies beside it."""
    sources = with_depth(sources_of(photo.beside, files), None)
    return Upload(
        files[photo.file], Path(photo.file).name, sources.get("depth"), sources.get("boxes"), sources.get("masks")
    )


def sources_of(chosen: Sequence[tuple[Sort, str]], files: Mapping[str, bytes]) -> dict[Sort, Source]:
    """Files by their sort; masks in several files are packed into one."""
    masks = [name for sort, name in chosen if sort == "masks"]
    by_sort = {sort: _source(name, files) for sort, name in chosen}
    if len(masks) > 1:
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w") as archive:
            for name in masks:
                archive.writestr(Path(name).name, files[name])
        by_sort["masks"] = Source(packed.getvalue(), "masks.zip")
    return by_sort


def _source(name: str, files: Mapping[str, bytes]) -> Source:
    """A file with the small text files that came with it, which may name its classes."""
    beside = [n for n in files if n != name and Path(n).suffix.lower() in _NAMES_CLASSES]
    return Source(files[name], Path(name).name, companions=tuple(Source(files[n], Path(n).name) for n in beside))
