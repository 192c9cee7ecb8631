"""A file as a scene whose shapes are at hand: those the library lacks are taken out of the file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from diorama_core.errors import InputError, LibraryError
from diorama_core.importing.foreign import open_foreign, take_missing_shapes
from diorama_core.importing.marked import MarkedFile
from diorama_core.importing.measured_room import MeasuredRoom, opened_room
from diorama_core.importing.opening import USD_SUFFIXES, Opened, marked_file, open_marked
from diorama_core.importing.point_files import CLOUD_SUFFIXES, is_scan_folder, read_points
from diorama_core.importing.roomplan import read_room_plan
from diorama_core.library.boards import base_id
from diorama_core.library.store import create_library, open_library, stored_libraries
from diorama_core.library.user_library import OWN
from diorama_core.progress import Progress


@dataclass(frozen=True, eq=False)
class Imported:
    """A scene and the name of the library that has its shapes."""

    opened: Opened
    library_name: str


def import_scene(path: Path, *, library_name: str | None = None, progress: Progress | None = None) -> Imported:
    """Open a file as a scene.

    Args:
        path: The file; one of another program becomes a scene of objects, its models join the user's own.
        library_name: Where shapes are looked up first; None takes the library the file names, or the built-in one.
        progress: Where it is reported and cancelling is noticed.

    Raises:
        InputError: the file cannot be read.
        UnavailableError: an optional library is missing.
        LibraryError: no shape library of that name, or models cannot be kept.
    """
    progress = progress or Progress()
    progress.report(0.0, f"reading {path.name}")
    if _holds_points(path):
        name = library_name or "built-in"
        return Imported(_room_of_points(path, name), name)
    marked = marked_file(path)
    if marked is None:
        name = library_name or "built-in"
        library = open_library(name)
        measured = measured_room(path)
        if measured is not None:
            return Imported(opened_room(measured, library), name)
        return Imported(open_foreign(path, create_library(OWN), progress), _with_own(name))
    name = library_name or _known(str(marked.provenance.get("library", "built-in")))
    library = open_library(_with_own(name) if OWN in stored_libraries() else name)
    known = frozenset(s.id for s in library.shapes())
    opened = _with_shapes(path, marked, known, progress)
    complete = {base_id(o.shape_id) for o in opened.scene.objects} <= known
    return Imported(opened, name if complete else _with_own(name))


def read_scene(path: Path, known: frozenset[str], progress: Progress) -> Opened:
    """Open a file as a scene for a library that is open already; shapes it lacks join the user's own.

    Args:
        path: The file.
        known: Ids of the shapes that the library has.
        progress: Where it is reported and cancelling is noticed.

    Raises:
        InputError: the file cannot be read.
        UnavailableError: an optional library is missing.
        LibraryError: models cannot be kept.
    """
    progress.report(0.0, f"reading {path.name}")
    if _holds_points(path):
        return _room_of_points(path, "built-in")
    marked = marked_file(path)
    if marked is None:
        measured = measured_room(path)
        if measured is not None:
            return opened_room(measured, open_library("built-in"))
        return open_foreign(path, create_library(OWN), progress)
    return _with_shapes(path, marked, known, progress)


def _holds_points(path: Path) -> bool:
    return (path.is_file() and path.suffix.lower() in CLOUD_SUFFIXES) or is_scan_folder(path)


def measured_room(path: Path) -> MeasuredRoom | None:
    """The room in a file that holds measurements; None for a file with models.

    Raises:
        InputError: the file cannot be read.
    """
    suffix = path.suffix.lower()
    room = read_room_plan(path) if suffix in (*USD_SUFFIXES, ".json") else None
    if room is None and suffix == ".json":
        raise InputError(f"{path.name} is no scan of RoomPlan (there are no walls in it); export the scan again")
    return room


def _with_shapes(path: Path, marked: MarkedFile, known: frozenset[str], progress: Progress) -> Opened:
    """What Diorama wrote; the shapes that are not known are taken out of the file."""
    opened = open_marked(marked)
    missing = {o.shape_id for o in opened.scene.objects if base_id(o.shape_id) not in known}
    if missing:
        take_missing_shapes(path, marked, opened.scene, missing, create_library(OWN), progress)
    return opened


def _with_own(name: str) -> str:
    return name if OWN in name.split("+") else f"{name}+{OWN}"


def _known(name: str) -> str:
    """The library of that name where this machine has it; otherwise the built-in one, and shapes come from the file."""
    try:
        open_library(name)
    except LibraryError:
        return "built-in"
    return name


def _room_of_points(path: Path, library: str) -> Opened:
    # OpenCV and SciPy: the editor starts without them.
    from diorama_core.importing.measured_cloud import measured_cloud
    from diorama_core.importing.scanned_kinds import with_scanned_kinds

    shapes = open_library(library)
    return opened_room(with_scanned_kinds(measured_cloud(read_points(path)), shapes), shapes)
