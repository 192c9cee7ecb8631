"""A file as a scene whose shapes are at hand: those the library lacks are taken out of the file.

Reading is done here or in a process of its own, in which what crashes a reader, or unpacks to too much, ends in one
line.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

from diorama_core.errors import LibraryError
from diorama_core.importing.foreign import scene_of_parts, take_missing_shapes
from diorama_core.importing.forms import Content, SceneParts, open_form
from diorama_core.importing.marked import MarkedFile
from diorama_core.importing.measured_room import open_room
from diorama_core.importing.measured_types import MeasuredRoom
from diorama_core.importing.opening import Opened, open_marked
from diorama_core.importing.point_cloud import PointCloud
from diorama_core.io.limited import LimitedProcess
from diorama_core.library.catalogue import base_id
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.store import StoredLibrary, list_libraries, open_library
from diorama_core.library.user_library import OWN
from diorama_core.progress import SILENT, Progress
from diorama_core.project.storage import OWN_SHAPES

MAX_MEMORY = 4_000_000_000
"""Address space of the process: models, pictures, and what they are compared with."""
MAX_QUIET_S = 90.0
"""How long it may work on one part of a file."""
R = TypeVar("R")


@dataclass(frozen=True, eq=False)
class Imported:
    """A scene and the name of the library that has its shapes."""

    opened: Opened
    library_name: str
    """As `project.json` keeps it: `OWN_SHAPES` are those that were taken out of the file."""


def import_scene(
    path: Path,
    shapes: Path | None = None,
    library_name: str | None = None,
    unit_m: float | None = None,
    progress: Progress = SILENT,
) -> Imported:
    """Open a file as a scene.

    Args:
        path: The file; one of another program becomes a scene of objects, its models become shapes of the project.
        shapes: The project's folder of shapes (`Project.shapes_folder`), made where shapes come out of the file; None
            where there can be none.
        library_name: Where shapes are looked up first; None takes the library the file names, or the built-in one.
        unit_m: Metres in one unit of the file; None believes the file, or takes what makes it as large as rooms are.
        progress: Where it is reported and cancelling is noticed.

    Raises:
        InputError: the file cannot be read, or says its unit itself and another is given.
        UnavailableError: an optional library is missing.
        LibraryError: no shape library of that name, or models cannot be kept.
    """
    with _read(path, progress, unit_m) as (place, content):
        if isinstance(content, MarkedFile):
            return _import_mark(place, shapes, content, library_name, progress)
        name = library_name or "built-in"
        opened = _open(place, content, shapes, name, progress)
    return Imported(opened, f"{name}+{OWN_SHAPES}" if isinstance(content, SceneParts) else name)


def read_scene(path: Path, shapes: Path, known: frozenset[str], progress: Progress) -> Opened:
    """Open a file as a scene for a library that is open already.

    Args:
        path: The file.
        shapes: Folder of a library for the shapes that are taken out of the file; made where there are any.
        known: Ids of the shapes that the library has.
        progress: Where it is reported and cancelling is noticed.

    It raises as `import_scene`.
    """
    with _read(path, progress) as (place, content):
        if isinstance(content, MarkedFile):
            return _with_shapes(place, shapes, content, known, progress)
        return _open(place, content, shapes, "built-in", progress)


def read_apart(read: Callable[..., R], path: Path, *more: Any, progress: Progress) -> R:
    """What `import_scene` or `read_scene` makes of a file and all its further arguments, in a process of its own.

    It raises the same, and `InputError` where that process had to end.
    """
    process = LimitedProcess(memory=MAX_MEMORY, seconds=MAX_QUIET_S)
    try:
        return process.work(path.name, read, path, *more, progress=progress)
    finally:
        process.close()


@contextmanager
def _read(path: Path, progress: Progress, unit_m: float | None = None) -> Iterator[tuple[Path, Content]]:
    """Where a file lies, unpacked where it was an archive, and what is in it."""
    progress.report(0.0, f"reading {path.name}")
    with open_form(path) as (form, place):
        progress.report(0.0, f"{path.name} is read as {form.name}")
        yield place, form.read(place, progress, unit_m)


def _open(path: Path, content: Content, shapes: Path | None, library_name: str, progress: Progress) -> Opened:
    """A scene of what another program wrote or a scanner measured."""
    if isinstance(content, SceneParts):
        opened = scene_of_parts(content.parts, path, _sink(shapes), progress)
        return replace(opened, changes=(*content.notes, *opened.changes))
    library = open_library(library_name)
    if isinstance(content, PointCloud):
        return _room_of_points(content, library)
    assert isinstance(content, MeasuredRoom)
    return open_room(content, library)


def _import_mark(
    path: Path, shapes: Path | None, marked: MarkedFile, library_name: str | None, progress: Progress
) -> Imported:
    """The scene that Diorama wrote, and the names of the libraries that have its shapes."""
    name = library_name or _library_name(str(marked.provenance.get("library", "built-in")))
    known, of_person = _ids(name), _ids(OWN) if OWN in list_libraries() else frozenset[str]()
    opened = _with_shapes(path, shapes, marked, known | of_person, progress)
    used = {base_id(o.shape_id) for o in opened.scene.objects}
    also = [OWN] if (used - known) & of_person and OWN not in name.split("+") else []
    also += [OWN_SHAPES] if used - known - of_person else []
    return Imported(opened, "+".join([name, *also]))


def _with_shapes(
    path: Path, shapes: Path | None, marked: MarkedFile, known: frozenset[str], progress: Progress
) -> Opened:
    """What Diorama wrote; the shapes that are not known are taken out of the file."""
    opened = open_marked(marked)
    missing = {o.shape_id for o in opened.scene.objects if base_id(o.shape_id) not in known}
    if missing:
        take_missing_shapes(path, marked, opened.scene, missing, _sink(shapes), progress)
    return opened


def _sink(shapes: Path | None) -> StoredLibrary:
    if shapes is None:
        raise LibraryError("shapes come out of the file: name a folder for them")
    return StoredLibrary(shapes, create=True)


def _ids(library: str) -> frozenset[str]:
    return frozenset(s.id for s in open_library(library).shapes())


def _library_name(name: str) -> str:
    """The library of that name where this machine has it; otherwise the built-in one, and shapes come from the file."""
    try:
        open_library(name)
    except LibraryError:
        return "built-in"
    return name


def _room_of_points(cloud: PointCloud, library: ShapeLibrary) -> Opened:
    # OpenCV and SciPy: the editor starts without them.
    from diorama_core.importing.measured_cloud import measure_cloud
    from diorama_core.importing.scanned_kinds import with_scanned_kinds

    return open_room(with_scanned_kinds(measure_cloud(cloud), library), library)
