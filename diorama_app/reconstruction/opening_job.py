"""A file that somebody uploads becomes a project of its own: what Diorama exported comes back as it was."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from diorama_app.projects.begin import new_project
from diorama_app.projects.packing import SUFFIX, unpack_project
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.strings import _, plural
from diorama_core.errors import InputError
from diorama_core.importing.forms import SUFFIXES
from diorama_core.importing.opening import Opened
from diorama_core.importing.scene_import import read_apart, read_scene
from diorama_core.io.atomic import write_atomically
from diorama_core.library.library_names import BUILT_IN
from diorama_core.library.user_library import ProjectShapes
from diorama_core.progress import Progress
from diorama_core.project.storage import Project

MAX_NOTES = 40


def open_file(client: Client, name: str, content: bytes) -> None:
    """Read a scene file beside everything else and open it as a new project.

    Args:
        client: who uploaded it.
        name: the file's name; its ending says what it is.
        content: the file.

    Raises:
        InputError: files of this kind are not read.
    """
    session = client.session
    file_name = Path(name.replace("\\", "/")).name[:100]
    if Path(file_name).suffix.lower() == SUFFIX:
        open_packed(client, file_name, content)
        return
    if Path(file_name).suffix.lower() not in SUFFIXES:
        message = _("{file} cannot be opened as a scene; choose a file of one of these kinds: {kinds}")
        raise InputError(message.format(file=file_name, kinds=", ".join(SUFFIXES)))

    def work(progress: Progress) -> None:
        with tempfile.TemporaryDirectory(prefix="upload-") as folder:
            shapes = Path(folder) / "shapes"
            opened = _read(session, Path(folder) / file_name, shapes, content, progress.part(0.0, 0.9))
            progress.report(0.9, "saving the project")
            project = _save(session, file_name, opened, shapes)
        client.post(lambda: _show(client, project, file_name))

    session.jobs.start("import", _("Opening {file}").format(file=file_name), work)


def open_packed(client: Client, name: str, content: bytes) -> None:
    """Make a project of a packed one beside everything else, and open it.

    Args:
        client: who uploaded it.
        name: the file's name, after which the folder is named.
        content: the file.
    """
    session, file_name = client.session, Path(name.replace("\\", "/")).name[:100]

    def work(progress: Progress) -> None:
        with tempfile.TemporaryDirectory(prefix="upload-") as folder:
            path = Path(folder) / file_name
            write_atomically(path, content, error=InputError)
            project = unpack_project(path, session.projects_dir)
        message = _("Opened {name} from {file}.").format(name=project.name, file=file_name)
        client.post(lambda: session.visit(client, project, message))

    session.jobs.start("import", _("Opening {file}").format(file=file_name), work)


def _read(session: EditorSession, path: Path, shapes: Path, content: bytes, progress: Progress) -> Opened:
    """The scene in a file, read in a process of its own with limited memory."""
    library = session.library
    shared = library.shared if isinstance(library, ProjectShapes) else library
    write_atomically(path, content, error=InputError)
    return read_apart(read_scene, path, shapes, frozenset(shape.id for shape in shared.shapes()), progress=progress)


def _save(session: EditorSession, file_name: str, opened: Opened, shapes: Path) -> Project:
    """A new project with the scene and its shapes; none is left behind when it cannot be saved."""
    stem = Path(file_name).stem
    with new_project(session.projects_dir, stem, name=stem, library=session.library) as project:
        notes = [f"opened from {file_name}", *opened.changes[:MAX_NOTES]]
        if shapes.is_dir():
            shutil.copytree(shapes, project.shapes_folder)
        # Commands find the shapes where those of the open project are.
        project.update_info(library=BUILT_IN if session.project is None else session.project.shared_library_name)
        project.update_info(notes=notes)
        project.save_textures(opened.textures)
        if opened.inputs is not None:
            project.save_inputs(opened.inputs)
        project.save_scene(opened.scene)
    return project


def _show(client: Client, project: Project, file_name: str) -> None:
    count = len(project.load_scene().objects)
    objects = plural("{count} object", "{count} objects", count)
    message = _("Opened {file} as a new project with {objects}.").format(file=file_name, objects=objects)
    client.session.visit(client, project, message)
