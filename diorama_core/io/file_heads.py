"""The beginning of a file, or the names in a folder or an archive: what tells its form before anything reads it."""

from __future__ import annotations

import os
import zipfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from diorama_core.errors import InputError

HEAD_BYTES = 65_536
MAX_NAMES = 20_000
MAX_DEPTH = 4
"""Folders below the one that is named."""


@dataclass(frozen=True)
class FileHead:
    """What can be known of a file or folder without reading it whole."""

    path: Path
    head: bytes = b""
    """Its first bytes; none of a folder."""
    names: tuple[str, ...] = ()
    """Files within a folder or a zip archive, with slashes."""
    size: int = 0

    @property
    def suffix(self) -> str:
        """Ending of its name, in small letters."""
        return self.path.suffix.lower()

    @property
    def is_folder(self) -> bool:
        """Whether it is a folder."""
        return self.path.is_dir()

    @property
    def is_zip(self) -> bool:
        """Whether it is a zip archive, whatever it is called."""
        return self.head[:4] in (b"PK\x03\x04", b"PK\x05\x06")

    @cached_property
    def text(self) -> str:
        """The first bytes as text; empty where they are none."""
        if b"\0" in self.head:
            return ""
        return self.head.decode("utf-8-sig", "replace").lstrip()

    def has(self, *endings: str) -> bool:
        """Whether a name within ends so: a path's last parts, or only an ending."""
        lower = tuple(e.lower() for e in endings)
        return any(f"/{name.lower()}".endswith(lower) for name in self.names)


def head_of(path: Path) -> FileHead:
    """The head of a file or a folder.

    Raises:
        InputError: there is no such file, or it cannot be opened.
    """
    try:
        if path.is_dir():
            return FileHead(path, names=_names_in(path))
        with path.open("rb") as stream:
            head = stream.read(HEAD_BYTES)
        file_head = FileHead(path, head, size=path.stat().st_size)
        return FileHead(path, head, _members(path), file_head.size) if file_head.is_zip else file_head
    except OSError as error:
        if not path.exists():
            raise InputError(f"{path} does not exist; check the path") from error
        raise InputError(f"{path} cannot be opened ({error.strerror or error})") from error


def _names_in(folder: Path) -> tuple[str, ...]:
    names: list[str] = []
    for here, folders, files in os.walk(folder):
        within = Path(here).relative_to(folder)
        if len(within.parts) >= MAX_DEPTH:
            folders.clear()
        folders[:] = sorted(f for f in folders if not f.startswith("."))
        names += [(within / name).as_posix() for name in sorted(files) if not name.startswith(".")]
        if len(names) >= MAX_NAMES:
            break
    return tuple(names[:MAX_NAMES])


def _members(path: Path) -> tuple[str, ...]:
    try:
        with zipfile.ZipFile(path) as archive:
            names = [i.filename for i in archive.infolist()[:MAX_NAMES] if not i.is_dir()]
    except (zipfile.BadZipFile, OSError, NotImplementedError, ValueError):
        return ()
    return tuple(n for n in names if not n.startswith("__MACOSX/") and not n.rsplit("/", 1)[-1].startswith("."))
