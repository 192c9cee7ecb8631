"""A new project: a folder of its own, from the moment when a photo is there."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import cast, get_args

import numpy as np
from jaxtyping import UInt8

from diorama_app.projects.uploads import Upload
from diorama_core.errors import InputError, LibraryError, ProjectError
from diorama_core.library.library_names import BUILT_IN
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.store import CombinedLibrary, StoredLibrary
from diorama_core.library.user_library import OWN, ShapeRecords, UserLibrary
from diorama_core.perception.inputs import ReadInputs
from diorama_core.perception.inputs.depth.confidence import is_map
from diorama_core.perception.inputs.depth.kinds import DepthKind
from diorama_core.perception.inputs.depth.scale import DepthAnswer
from diorama_core.perception.inputs.source import Source
from diorama_core.project.lock import ProjectLock
from diorama_core.project.storage import OWN_SHAPES, Project
from diorama_core.scene.types import Scene


def begin_project(projects_dir: Path, file_name: str, read: ReadInputs, content: bytes) -> Project:
    """Make a project of an uploaded photo; it has no scene yet. None is left behind when it cannot be saved.

    Args:
        projects_dir: where projects are.
        file_name: the photo's name, which names the project.
        read: the photo as it was read.
        content: the file as it came.

    Raises:
        ProjectError: the folder cannot be written.
    """
    with new_project(projects_dir, file_name, name=Path(file_name).stem) as project:
        project.save_upload("photo", content)
        project.save_inputs(read.inputs, read.warnings)
    return project


@contextmanager
def new_project(
    projects_dir: Path, file_name: str, *, name: str, library: ShapeLibrary | None = None
) -> Iterator[Project]:
    """A new project, to be filled inside the block. None is left behind when that fails or it would not open again.

    Args:
        projects_dir: where projects are.
        file_name: after which the folder is named.
        name: what people call the project.
        library: where the scene's shapes are, besides the project's own; not looked at when None.

    Raises:
        ProjectError, SceneError: the folder cannot be written, or what was written cannot be opened.
    """
    folder = fresh_folder(projects_dir, file_name)
    try:
        project = Project.create(folder, name=name)
        with ProjectLock(folder, "the editor"):
            yield project
            if library is not None:
                _note_library(project, library)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise


def _note_library(project: Project, library: ShapeLibrary) -> None:
    """Note where the shapes of a project's scene are, all of which must be there."""
    shapes = {o.shape_id for o in project.load_scene().objects}
    project_shapes = StoredLibrary(project.shapes_folder) if project.shapes_folder.is_dir() else None
    known = ShapeRecords(library if project_shapes is None else CombinedLibrary([project_shapes, library]))
    for shape_id in shapes:
        try:
            known.shape(shape_id)
        except LibraryError as error:
            raise ProjectError(f"{project.name} is not saved, since it would not open again: {error}") from error
    names = str(project.info().get("library", BUILT_IN)).split("+")
    uploads = {s.id for s in library.uploads()} if isinstance(library, UserLibrary) else set()
    names += [] if uploads.isdisjoint(shapes) else [OWN]
    names += [] if project_shapes is None else [OWN_SHAPES]
    project.update_info(library="+".join(dict.fromkeys(names)))


def keep_given(project: Project, upload: Upload) -> None:
    """Keep depth and masks as they came, and what was said of the depth, for when the photo is read again."""
    if upload.depth is not None:
        project.save_upload("depth", _content(upload.depth))
        project.update_info(depth_scale=upload.depth_scale, depth_kind=upload.depth_kind)
        companions = upload.depth.companions if isinstance(upload.depth, Source) else ()
        confidence = next((c.data for c in companions if is_map(c)), None)
        project.save_upload("confidence", confidence)
    if upload.masks is not None:
        project.save_upload("masks", _content(upload.masks))


def depth_answer(project: Project) -> DepthAnswer:
    """What was said of the project's depth."""
    info, kinds = project.info(), cast("tuple[DepthKind, ...]", get_args(DepthKind))
    kind: DepthKind = next((k for k in kinds if k == info.get("depth_kind")), "auto")
    return DepthAnswer("", info.get("depth_scale"), kind)


def _content(given: bytes | Source) -> bytes:
    return given.data if isinstance(given, Source) else given


def fresh_folder(projects_dir: Path, name: str) -> Path:
    """A folder for a new project, named after its photo or file; it does not exist yet."""
    stem = re.sub(r"[^A-Za-z0-9._-]+", "-", Path(name).stem).strip("-.")[:60] or "room"
    for number in range(1, 10_000):
        folder = projects_dir / (stem if number == 1 else f"{stem}-{number}")
        if not folder.exists():
            return folder
    raise InputError(f"{projects_dir} holds too many projects called {stem}; rename the file")


def begin_with_scene(
    projects_dir: Path,
    name: str,
    scene: Scene,
    textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]],
    notes: Sequence[str],
    library: ShapeLibrary,
) -> Project:
    """Make a project of a scene that no photo shows. None is left behind when it cannot be saved.

    Args:
        projects_dir: where projects are.
        name: what people call the project.
        scene: with which it begins.
        textures: the pictures that the scene names.
        notes: how the scene was made.
        library: where its shapes are.

    Raises:
        ProjectError, SceneError: the folder cannot be written, or the scene would not open again.
    """
    with new_project(projects_dir, name, name=name, library=library) as project:
        project.update_info(notes=list(notes))
        project.save_textures(textures)
        project.save_scene(scene)
    return project
