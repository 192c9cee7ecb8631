"""Zip archives unpacked for as long as they are read: bounded, and nothing outside their folder."""

from __future__ import annotations

import lzma
import tempfile
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from diorama_core.errors import InputError
from diorama_core.io.bounded import megabytes, shortened

MAX_UNPACKED = 4_000_000_000
MAX_MEMBERS = 50_000


@contextmanager
def unpacked(path: Path, most: int = MAX_UNPACKED) -> Iterator[Path]:
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
            raise InputError(f"{path.name} cannot be unpacked ({shortened(str(error))}); save it again") from error
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
