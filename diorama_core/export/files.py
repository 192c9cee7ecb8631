"""Writing files whole or not at all: each file is written under a temporary name and renamed when complete."""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import tempfile
import time
import zipfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from diorama_core.errors import ExportError
from diorama_core.io.atomic import LEFTOVER_S

PART = ".diorama-export-"
"""How the names of temporary files begin; what a program that was killed left is removed by a later one."""

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
FAST_DEFLATE = 1
"""Level of compression: higher ones take several times as long for files a tenth smaller."""
_PACKED = (".png", ".jpg")
"""Files that are compressed already."""
Entry = tuple[str, bytes]
"""Name of a file inside a package, with forward slashes, and its content."""


@contextmanager
def whole_file(path: Path, suffix: str | None = None) -> Iterator[Path]:
    """A temporary file beside `path` that takes its place when the block ends well.

    Args:
        path: The file to be; an existing one stays as it was until then, and for good when the block raises.
        suffix: Ending of the temporary name, for libraries that choose the format by it (default: that of `path`).

    Raises:
        ExportError: when the folder is missing, not writable or full.
    """
    path = Path(path)
    temporary: Path | None = None
    _remove_leftovers(path.parent)
    try:
        beside = path.parent / f"{PART}{secrets.token_hex(8)}{suffix or path.suffix}"
        os.close(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))  # the umask decides
        temporary = beside
        yield temporary
        with temporary.open("rb") as file:
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except OSError as error:
        raise _cannot_write(path, error) from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def write_whole(path: Path, content: bytes) -> None:
    """Write one file; see `whole_file`."""
    with whole_file(path) as temporary:
        temporary.write_bytes(content)


def companion_folder(path: Path, kind: str = "files") -> str:
    """Name of the folder beside `path` that holds what a package's main file refers to, told apart by format."""
    return f"{Path(path).stem}_{kind}"


def add_entry(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    """Add a file to a zip, the same bytes at any time; pictures are stored, anything else is compressed."""
    method = zipfile.ZIP_STORED if name.endswith(_PACKED) else zipfile.ZIP_DEFLATED
    archive.writestr(zipfile.ZipInfo(name), content, method, FAST_DEFLATE)


def write_package(path: Path, main: str, entries: Iterable[Entry]) -> None:
    """Write a main file and those it refers to: as one zip where `path` ends in .zip, as a file and a folder otherwise.

    Args:
        path: The zip, or the main file.
        main: Name of the main file, whose entry comes last; the others lie in a folder that `companion_folder` names.
        entries: Names and contents, made one after the other as they are written.

    Raises:
        ExportError: when they cannot be written; nothing half written is left behind.
    """
    path = Path(path)
    if path.suffix.lower() == ".zip":
        with whole_file(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
            for name, content in entries:
                add_entry(archive, name, content)
        return
    _write_beside(path, main, entries)


def _write_beside(path: Path, main: str, entries: Iterable[Entry]) -> None:
    """The companions first, then the main file that refers to them; files of other names there stay."""
    temporary: Path | None = None
    try:
        temporary = Path(tempfile.mkdtemp(prefix=PART, dir=path.parent))
        content, companions = b"", []
        for name, data in entries:
            if name == main:
                content = data
                continue
            companions.append(name)
            (temporary / name).parent.mkdir(parents=True, exist_ok=True)
            (temporary / name).write_bytes(data)
        for name in companions:
            (path.parent / name).parent.mkdir(parents=True, exist_ok=True)
            os.replace(temporary / name, path.parent / name)
        write_whole(path, content)
    except OSError as error:
        raise _cannot_write(path, error) from error
    finally:
        if temporary is not None:
            shutil.rmtree(temporary, ignore_errors=True)


def _remove_leftovers(folder: Path) -> None:
    for left in folder.glob(f"{PART}*"):
        with suppress(OSError):
            if time.time() - left.stat().st_mtime > LEFTOVER_S:
                shutil.rmtree(left) if left.is_dir() else left.unlink()


def _cannot_write(path: Path, error: OSError) -> ExportError:
    reason = error.strerror or str(error)
    remedy = (
        "free some space or choose another disk" if error.errno in _FULL else "choose a writable folder that exists"
    )
    return ExportError(f"cannot write {path}: {reason}; {remedy}")
