"""Scene files read in a process of their own: what crashes a reader, or unpacks to too much, ends in one line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from diorama_core.importing.opening import Opened
from diorama_core.importing.scene_import import Imported, import_scene, read_scene
from diorama_core.io.limited import LimitedProcess
from diorama_core.progress import Progress

MAX_MEMORY = 4_000_000_000
"""Address space of the process: models, pictures, and what they are compared with."""
MAX_QUIET_S = 90.0
"""How long it may work on one part of a file."""
R = TypeVar("R")


def import_apart(
    path: Path, shapes: Path, library_name: str | None, progress: Progress, unit_m: float | None = None
) -> Imported:
    """`import_scene` in a process of its own; it raises the same, and `InputError` where that process had to end.

    Args:
        path: the file.
        shapes: the project's folder of shapes, made where shapes come out of the file.
        library_name: of the library where shapes are looked up first; None takes the one that the file names.
        progress: reports and cancellation.
        unit_m: metres in one unit of the file; None believes the file.
    """
    return _apart(path, _import, path, shapes, library_name, unit_m, progress=progress)


def read_apart(path: Path, shapes: Path, known: frozenset[str], progress: Progress) -> Opened:
    """`read_scene` in a process of its own; it raises the same, and `InputError` where that process had to end.

    Args:
        path: the file.
        shapes: the project's folder of shapes, made where shapes come out of the file.
        known: ids of the shapes that are there already.
        progress: reports and cancellation.
    """
    return _apart(path, read_scene, path, shapes, known, progress=progress)


def _import(path: Path, shapes: Path, library_name: str | None, unit_m: float | None, progress: Progress) -> Imported:
    return import_scene(path, shapes, library_name=library_name, unit_m=unit_m, progress=progress)


def _apart(path: Path, read: Callable[..., R], *args: Any, progress: Progress) -> R:
    process = LimitedProcess(memory=MAX_MEMORY, seconds=MAX_QUIET_S)
    try:
        return process.work(path.name, read, *args, progress=progress)
    finally:
        process.close()
