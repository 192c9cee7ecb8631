"""A project as one file, to send: a zip archive that ends in `.diorama`, without earlier versions and locks."""

from __future__ import annotations

import io
import os
import shutil
import tempfile
import zipfile
from pathlib import Path

from diorama_app.projects.begin import fresh_folder
from diorama_app.projects.manage import not_copied
from diorama_core.errors import InputError, ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.contained import content_of, unpack
from diorama_core.library.library_names import BUILT_IN
from diorama_core.project.storage import OWN_SHAPES, Project

SUFFIX = ".diorama"
MAX_UNPACKED = 2_000_000_000
"""Bytes; a project of a large photo with depth and its own shapes has a tenth."""
STORED = frozenset({".jpg", ".jpeg", ".png", ".webp", ".zip", ".npz", ".glb"})
"""Endings of files that are compressed already."""


def pack_project(project: Project, target: Path) -> Path:
    """Write a project as one file, whole or not at all; an existing one is replaced.

    Raises:
        ProjectError: a file of the project cannot be read, or the target cannot be written.
    """
    content = io.BytesIO()
    try:
        with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
            for folder, folders, files in os.walk(project.folder):
                left_out = not_copied(folder, [*folders, *files])
                folders[:] = sorted(set(folders) - left_out)
                for name in sorted(set(files) - left_out):
                    path = Path(folder, name)
                    kind = zipfile.ZIP_STORED if path.suffix.lower() in STORED else zipfile.ZIP_DEFLATED
                    archive.write(path, path.relative_to(project.folder).as_posix(), kind)
    except (OSError, ValueError) as error:  # zip archives know no time before 1980
        raise ProjectError(f"{project.folder} cannot be packed ({error}); look at its files") from error
    write_atomically(target, content.getvalue(), error=ProjectError)
    return target


def is_packed(names: tuple[str, ...]) -> bool:
    """Whether the names of an archive are those of a project, in a folder of its own or not."""
    tops = {name.rpartition("/")[0] for name in names if name.rpartition("/")[2] == "project.json"}
    return any(top.count("/") == 0 and (f"{top}/scene.json" if top else "scene.json") in names for top in tops)


def unpack_project(file: Path, projects_dir: Path, *, folder: Path | None = None) -> Project:
    """A new project of a packed one, under its file's name (and a number where that is taken) or in a given folder.

    None is left behind when it would not open.

    Raises:
        InputError: it is no packed project, or damaged.
        ProjectError, SceneError: what is in it cannot be opened, or the folder cannot be written.
    """
    if folder is not None and folder.exists():
        raise ProjectError(f"{folder} exists already; choose a new folder")
    with unpack(file, MAX_UNPACKED) as inside:
        contents = content_of(inside)
        if not (contents / "project.json").is_file():
            raise InputError(
                f"{file.name} is not a packed project (it has no project.json); make one with 'project zip'"
            )
        received = Project.open(contents)
        if received.has_scene:
            received.load_scene()
        # What comes from elsewhere names no folders of this machine.
        parts = str(received.info().get("library", BUILT_IN)).split("+")
        plain = [p for p in parts if p == OWN_SHAPES or not {"/", "\\"} & set(p)]
        received.update_info(library="+".join(plain) or BUILT_IN)
        try:
            target = folder or fresh_folder(projects_dir, file.name)
            target.parent.mkdir(parents=True, exist_ok=True)
            # Copied beside and renamed, so that a copy cut short is never taken for a project.
            with tempfile.TemporaryDirectory(prefix=".copy-", dir=target.parent) as part:
                shutil.copytree(contents, Path(part) / target.name, ignore=not_copied)
                (Path(part) / target.name).rename(target)
        except OSError as error:
            raise ProjectError(f"cannot write {target} ({error.strerror or error}); free some space") from error
    return Project.open(target)
