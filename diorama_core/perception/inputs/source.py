"""Files and uploads as bytes with a name, the files that lie beside or within them, and the forms by which they are
recognised and read.
"""

from __future__ import annotations

import io
import stat
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from diorama_core.errors import InputError

MAX_FILE_MB = 200
MAX_FILES = 600
"""Files of a folder: somewhat more than the objects of the fullest scene."""
MAX_BESIDE_BYTES = 64_000_000
"""Size of a file beside another: the largest is a COCO data set with its categories."""


@dataclass(frozen=True)
class Source:
    """A file or an upload: its bytes and what to call it in messages."""

    data: bytes
    name: str
    path: Path | None = None
    """Where it lies; None for an upload."""
    companions: tuple[Source, ...] = ()
    """Files that were uploaded with it."""

    @property
    def suffix(self) -> str:
        """The end of its name in lower case, as ".png"."""
        return Path(self.name).suffix.lower()

    def sibling_files(self, *patterns: str) -> tuple[Source, ...]:
        """Small files that lie beside it and whose names match one of the patterns, in the order of the patterns."""
        files = [c for pattern in patterns for c in self.companions if Path(c.name).match(pattern)]
        if self.path is not None:
            for pattern in patterns:
                files += [s for p in sorted(self.path.parent.glob(pattern)) if (s := _small(p, self.path)) is not None]
        return tuple(files)


@dataclass(frozen=True)
class Folder:
    """Several files that belong together: a folder, or a zip archive."""

    name: str
    files: tuple[Source, ...]


def read_source(given: Path | bytes | Source, what: str, name: str | None = None) -> Source:
    """Bytes of a path or an upload; a source stays as it is.

    Raises:
        InputError: when the file is missing, unreadable, empty or larger than `MAX_FILE_MB`.
    """
    if isinstance(given, Source):
        _check_size(given.name, len(given.data))
        return given
    label = name or (given.name if isinstance(given, Path) else f"the uploaded {what}")
    if isinstance(given, Path):
        _check_size(label, _file_size(given, what))
        try:
            data = given.read_bytes()
        except OSError as error:
            raise InputError(f"{given}: the {what} cannot be read ({error.strerror}); check the path") from error
    else:
        data = bytes(given)
    _check_size(label, len(data))
    return Source(data, label, given if isinstance(given, Path) else None)


def read_folder(given: Path | bytes | Source, what: str) -> Folder | Source:
    """The files of a folder or of a zip archive in the order of their names; any other file as `read_source` has it.

    Raises:
        InputError: unreadable, empty, or too large; of an archive also when it is damaged.
    """
    if isinstance(given, Path) and given.is_dir():
        try:
            paths = sorted(p for p in given.rglob("*") if p.is_file() and not p.name.startswith("."))
        except OSError as error:
            raise InputError(f"{given}: the folder cannot be read ({error.strerror}); check the path") from error
        _check_count(given.name, len(paths))
        if sum(p.stat().st_size for p in paths) > MAX_FILE_MB * 1_000_000:
            raise InputError(
                f"{given.name}: holds more than the {MAX_FILE_MB} MB accepted; keep the {what} of this photo"
            )
        return Folder(given.name, tuple(Source(p.read_bytes(), p.name, p) for p in paths if p.stat().st_size))
    source = read_source(given, what)
    return _unzip(source) if source.data.startswith(b"PK\x03\x04") and source.suffix != ".npz" else source


def _unzip(source: Source) -> Folder | Source:
    try:
        with zipfile.ZipFile(io.BytesIO(source.data)) as archive:
            members = sorted((m for m in archive.infolist() if not m.is_dir()), key=lambda m: m.filename)
            if members and all(m.filename.endswith(".npy") for m in members):
                return source  # numpy's own archive
            members = [m for m in members if not Path(m.filename).name.startswith((".", "__"))]
            _check_count(source.name, len(members))
            if sum(m.file_size for m in members) > MAX_FILE_MB * 1_000_000:
                raise InputError(f"{source.name}: unpacks to more than the {MAX_FILE_MB} MB accepted; reduce it first")
            files = tuple(Source(archive.read(m), Path(m.filename).name) for m in members)
    except InputError:
        raise
    except Exception as error:  # a damaged archive raises almost anything; each means the same to the user
        raise InputError(f"{source.name}: the zip archive is damaged or locked; pack it again") from error
    return Folder(source.name, tuple(f for f in files if f.data))


def _small(path: Path, other: Path) -> Source | None:
    """A file beside another; None for that file itself, and for what is no readable file of a small size."""
    try:
        if path == other or not path.is_file() or path.stat().st_size > MAX_BESIDE_BYTES:
            return None
        return Source(path.read_bytes(), path.name, path)
    except OSError:
        return None


def _file_size(path: Path, what: str) -> int:
    if path.is_dir():
        raise InputError(f"{path}: is a folder; give the {what} file itself")
    try:
        about = path.stat()
        if not stat.S_ISREG(about.st_mode):
            raise InputError(f"{path}: is not a file; give the {what} file itself")
        return about.st_size
    except OSError as error:
        raise InputError(f"{path}: the {what} cannot be read ({error.strerror}); check the path") from error


def _check_size(label: str, size: int) -> None:
    if size == 0:
        raise InputError(f"{label}: the file is empty (0 bytes); choose another file")
    if size > MAX_FILE_MB * 1_000_000:
        raise InputError(f"{label}: {size / 1e6:.0f} MB is more than the {MAX_FILE_MB} MB accepted; reduce it first")


def _check_count(name: str, count: int) -> None:
    if not count:
        raise InputError(f"{name}: holds no file; choose another")
    if count > MAX_FILES:
        raise InputError(f"{name}: {count} files are more than the {MAX_FILES} accepted; keep those of this photo")


Content = TypeVar("Content")
Read = TypeVar("Read")


@dataclass(frozen=True)
class Form(Generic[Content, Read]):
    """One row of a table of forms, and of the page *What goes in*."""

    name: str
    """What people call it, as in "COCO results"."""
    written_by: str
    """Programs and devices that write it."""
    understood: str
    """What is read of it and what is not, in one sentence for the page."""
    recognises: Callable[[Content], bool]
    """Whether content is of this form; never raises."""
    read: Callable[[Content], Read]
    """The values; raises `InputError` where content of this form is damaged."""


def form_of(forms: Sequence[Form[Content, Read]], content: Content) -> Form[Content, Read] | None:
    """The first form that recognises the content, or None."""
    return next((form for form in forms if form.recognises(content)), None)
