"""Files kept within one folder: those that a document refers to, and those of a zip archive. No name leads out of it,
no link is followed, and an archive unpacks to a bounded size.
"""

from __future__ import annotations

import lzma
import os
import re
import stat
import tempfile
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

from diorama_core.errors import InputError
from diorama_core.io.bounded import Kind, megabytes, read_bytes, shorten

_ADDRESS = re.compile(r"^[a-zA-Z][a-zA-Z0-9+.-]+://")
_ABSOLUTE = re.compile(r"^(/|[a-zA-Z][a-zA-Z0-9+.-]*:)")
"""Also names of drives, and what an address begins with."""
_MAX_SHOWN = 80


@dataclass(frozen=True)
class ContainedFiles:
    """The regular files below one folder, by names that came from elsewhere.

    A name may be relative to a folder within the root and may climb, but never out of the root. The root itself may be
    reached by a link, since a person named it; nothing below it may be one.
    """

    root: Path
    """The folder that a person named, or one that was made for a container's content; nothing outside is read."""
    error: Kind
    """What a refusal is raised as."""

    def path(self, name: str, folder: Path | None = None) -> Path:
        """The regular file of a name.

        Args:
            name: as the document has it, with forward or backward slashes, percent-encoded or not.
            folder: what the name is relative to; the root where None.

        Raises:
            error: it is no name, an address, absolute, outside the root, behind a link, missing or no regular file.
        """
        plain = self._plain(name)
        if _ABSOLUTE.match(plain):
            raise self.error(f"{quote(name)} points outside the folder that was added")
        return self.check((folder or self.root) / plain, name)

    def path_or_beside(self, name: str, folder: Path) -> Path:
        """As `path`, or of a name that leads nowhere the file of the same last part in the folder itself.

        Many exporters write the path of the author's own disk.

        Raises:
            error: as `path`.
        """
        plain = self._plain(name)
        try:
            return self.path(name, folder)
        except self.error:
            beside = folder / plain.rpartition("/")[2]
            if not self.holds(beside):
                raise
            return beside

    def check(self, path: Path, name: str | None = None) -> Path:
        """A path of the document's folder, as `path` gives it.

        Args:
            path: absolute, or relative to the working folder.
            name: what to call it in messages; the path where None.

        Raises:
            error: as `path`.
        """
        shown_name = quote(str(path) if name is None else name)
        inside = self._relative_to_root(path)
        if inside is None:
            raise self.error(f"{shown_name} points outside the folder that was added")
        try:
            here = self.root
            for part in inside.parts:
                here = here / part
                mode = os.lstat(here).st_mode
                if stat.S_ISLNK(mode):
                    raise self.error(f"{shown_name} is behind a link, which is not followed; copy the file there")
        except (OSError, ValueError) as reason:
            raise self.error(f"{shown_name} is missing") from reason
        if not stat.S_ISREG(mode):
            raise self.error(f"{shown_name} is no regular file")
        return here

    def read(self, name: str, most: int, folder: Path | None = None) -> bytes:
        """The bytes of a file of at most `most` bytes.

        Args:
            name: as for `path`.
            most: bytes.
            folder: as for `path`.

        Raises:
            error: as `path`, or it is larger or cannot be read.
        """
        return read_bytes(self.path(name, folder), most, self.error, "reduce it, or leave it out")

    def holds(self, path: Path) -> bool:
        """Whether a path is a regular file that may be read."""
        try:
            self.check(path)
        except self.error:
            return False
        return True

    def _plain(self, name: str) -> str:
        """The name with forward slashes; refuses what is no name of a file."""
        plain = unquote(name).replace("\\", "/").strip()
        if "\0" in plain or plain.rpartition("/")[2] in ("", ".", ".."):
            raise self.error(f"{quote(name)} is no file name")
        if _ADDRESS.match(plain):
            raise self.error(f"{quote(name)} is a web address; nothing is downloaded")
        return plain

    def _relative_to_root(self, path: Path) -> Path | None:
        """The path below the root with every `..` taken out, before any link is looked at; None outside."""
        try:
            plain = Path(os.path.abspath(path)).relative_to(os.path.abspath(self.root))
        except ValueError:
            return None
        return plain if plain.parts else None


def quote(name: str) -> str:
    """A foreign name, safe and short enough for one line."""
    plain = "".join(c if c.isprintable() else "?" for c in name)
    return f"'{plain if len(plain) <= _MAX_SHOWN else plain[: _MAX_SHOWN - 3] + '...'}'"


MAX_UNPACKED = 4_000_000_000
MAX_MEMBERS = 50_000


@contextmanager
def unpack(path: Path, most: int = MAX_UNPACKED) -> Iterator[Path]:
    """A folder with an archive's files, for the time of the context.

    Args:
        path: The archive.
        most: Bytes that it may unpack to.

    Raises:
        InputError: it is damaged, encrypted, or unpacks to too much.
    """
    with tempfile.TemporaryDirectory(prefix="unpacked-") as folder:
        try:
            with zipfile.ZipFile(path) as archive:
                members = [m for m in archive.infolist() if not m.filename.startswith("__MACOSX/")]
                size = sum(m.file_size for m in members)
                if size > most or len(members) > MAX_MEMBERS:
                    raise InputError(
                        f"{path.name} unpacks to {len(members)} files of {megabytes(size)}; unpack a part of it"
                    )
                for member in members:
                    archive.extract(member, folder)  # zipfile keeps names inside the folder
        except (zipfile.BadZipFile, zlib.error, OSError, RuntimeError, NotImplementedError, EOFError, ValueError,
                lzma.LZMAError) as error:  # fmt: skip
            raise InputError(f"{path.name} cannot be unpacked ({shorten(str(error))}); save it again") from error
        yield Path(folder)


def content_of(folder: Path) -> Path:
    """Where an unpacked folder's content begins: archives often hold one folder, or one file, with everything in it."""
    while True:
        inside = [p for p in folder.iterdir() if not p.name.startswith(".")]
        if len(inside) != 1:
            return folder
        if inside[0].is_file():
            return inside[0]
        if inside[0].name == "keyframes":  # the name tells what it is
            return folder
        folder = inside[0]
