"""A model file that somebody uploads: checked, put the right way up, sized, kept in a library of one's own, placed."""

from __future__ import annotations

import tempfile
from pathlib import Path

from diorama_app.guest import Guest
from diorama_app.inserting import start_placing
from diorama_app.shelf import OWN, Shelf
from diorama_core.errors import EditRefused, InputError
from diorama_core.progress import Progress
from diorama_core.project.storage import Project


def import_model(guest: Guest, name: str, content: bytes) -> None:
    """Take a model file into the library of one's own models; the next click in the view puts it there."""
    room = guest.room
    shelf = room.library
    if not isinstance(shelf, Shelf):
        raise EditRefused("this library cannot take models in")
    file_name = Path(name).name or "model.glb"

    def work(progress: Progress) -> None:
        shape_id = _taken_in(shelf, file_name, content, progress)

        def show() -> None:
            if room.project is not None:
                _note_library(room.project)
            guest.toast(f"{file_name} is in the library", False)
            start_placing(guest, shape_id)

        guest.post(show)

    room.jobs.start("import", f"Reading {file_name}", work)


def _taken_in(shelf: Shelf, name: str, content: bytes, progress: Progress) -> str:
    from diorama_core.library.ingest.adding import add_models, model_files, sources
    from diorama_core.library.ingest.guess import Given
    from diorama_core.workers import workers

    with tempfile.TemporaryDirectory(prefix="upload-") as folder:
        (Path(folder) / name).write_bytes(content)
        paths, skipped = model_files(Path(folder))
        if not paths:
            reason = (
                skipped[0].reason if skipped else "this is no model that can be read; upload a GLB, OBJ, PLY or STL"
            )
            raise InputError(f"{name}: {reason}")
        found = sources(Path(folder), paths, Given(), {})
        library = shelf.own()
        report = add_models(found, library, workers(None, 1), progress=progress)
        if report.failed:
            raise InputError(f"{name}: {report.failed[0].reason}")
        return report.added[0] if report.added else found[0].id


def _note_library(project: Project) -> None:
    """Commands that open this project must find the shape too."""
    named = str(project.info().get("library", "built-in"))
    if OWN not in named.split("+"):
        project.update_info(library=f"{named}+{OWN}")
