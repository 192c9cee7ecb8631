"""Projects as folders in the projects' folder: recent ones, duplicate, rename, the bin, earlier versions."""

from __future__ import annotations

import os
import shutil
import stat
import tempfile
import time
from pathlib import Path

from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.bounded import shorten
from diorama_core.io.text import clean_text, file_label
from diorama_core.project.storage import Project, read_scene
from diorama_core.scene.types import Scene

BIN = ".bin"
"""Deleted projects stay here until the folder is emptied by hand."""
MAX_NAME = 80
"""Characters of a name that a person gives."""
MAX_VERSIONS = 6
"""Earlier scenes of a project that are listed."""
MAX_COPIES = 10_000
"""Copies of one project; each is a folder with a number."""


def recent_projects(projects_dir: Path) -> list[Path]:
    """Folders of projects that have a scene or a photo, last touched first."""
    try:
        folders = [f for f in projects_dir.iterdir() if not f.name.startswith(".") and _is_listed(f)]
    except OSError:
        return []
    return sorted(folders, key=mtime, reverse=True)


def _is_listed(folder: Path) -> bool:
    return (folder / "project.json").exists() and _has_content(Project(folder))


def find_project(projects_dir: Path, name: str) -> Path | None:
    """The folder of a listed project by its name; None for any other, as the name comes from an address."""
    return next((folder for folder in recent_projects(projects_dir) if address_of(folder) == name), None)


def address_of(folder: Path) -> str:
    """What a project is called in an address and by pages: its folder's name as text, whatever bytes that is."""
    return file_label(folder.name)


def mtime(folder: Path) -> float:
    """When the project's scene, or what is said of its photo, was last written."""
    return max(_mtime(folder / "scene.json"), _mtime(folder / "stages" / "inputs.zip"))


def _has_content(project: Project) -> bool:
    return project.has_scene or project.has_photo


def _mtime(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except OSError:  # somebody else removed it just now
        return 0.0


def name_of(folder: Path) -> str:
    """Display name of a project."""
    try:
        return Project.open(folder).name
    except DioramaError:
        return address_of(folder)


def rename_project(project: Project, name: str) -> None:
    """Rename a project; its folder does not change."""
    words = shorten(clean_text(name), MAX_NAME)
    if not words:
        raise ProjectError("a project needs a name; type at least one character")
    project.update_info(name=words)


def duplicate_project(folder: Path, projects_dir: Path) -> Project:
    """A copy beside it, under the next free name."""
    number = next((n for n in range(2, MAX_COPIES) if not (projects_dir / f"{folder.name}-{n}").exists()), None)
    if number is None:
        raise ProjectError(f"there are {MAX_COPIES} copies of {address_of(folder)}; rename or delete some of them")
    target = projects_dir / f"{folder.name}-{number}"
    try:
        # Copied beside and renamed, so that a copy cut short is never taken for a project.
        with tempfile.TemporaryDirectory(prefix=".copy-", dir=projects_dir) as part:
            made = Path(part) / target.name
            shutil.copytree(folder, made, ignore=not_copied)
            copy = Project.open(made)
            for path in (copy.scene_path, copy.stages_folder / "inputs.zip"):
                if path.exists():
                    path.touch()
            rename_project(copy, f"{name_of(folder)} {number}")
            made.rename(target)
    except OSError as error:  # `shutil.Error` has a list of reasons and no `strerror`
        reason = error.strerror or "some of its files cannot be read"
        raise ProjectError(f"cannot copy to {target} ({reason}); free some space") from error
    return Project.open(target)


def not_copied(folder: str, names: list[str]) -> set[str]:
    """What no copy has: earlier versions, hidden files, and what is neither file nor folder: links, pipes, devices."""
    kinds = {name: os.lstat(os.path.join(folder, name)).st_mode for name in names}
    odd = {name for name, mode in kinds.items() if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))}
    return odd | {name for name in names if name == "backups" or name.startswith(".")}


def to_bin(folder: Path, projects_dir: Path) -> Path:
    """Move a project's folder into the bin; returns its new path."""
    place = projects_dir / BIN / f"{folder.name}-{time.time_ns() // 1_000_000}"
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        folder.rename(place)
    except OSError as error:
        raise ProjectError(f"cannot move {folder} to the bin ({error.strerror})") from error
    return place


def projects_in_bin(projects_dir: Path) -> tuple[Path, ...]:
    """Folders of projects in the bin, the last deleted first."""
    places = [p for p in (projects_dir / BIN).glob("*") if (p / "project.json").exists()]
    return tuple(sorted(places, key=lambda p: p.name.rpartition("-")[2], reverse=True))


def out_of_bin(place: Path, projects_dir: Path) -> Path:
    """Put a project from the bin back where it was."""
    folder = projects_dir / place.name.rpartition("-")[0]
    if folder.exists():
        raise ProjectError(f"{folder.name} exists again; rename or delete it first")
    try:
        place.rename(folder)
    except OSError as error:
        raise ProjectError(f"{folder.name} cannot be taken out of the bin ({error.strerror})") from error
    return folder


def earlier_versions(project: Project) -> tuple[tuple[str, str], ...]:
    """(file name, when, in words) of stored earlier scenes, newest first."""
    return tuple(
        (p.name, time.strftime("%d %b %H:%M", time.localtime(_mtime(p)))) for p in project.backups()[:MAX_VERSIONS]
    )


def earlier_scene(project: Project, name: str) -> Scene:
    """One of the stored earlier scenes."""
    for path in project.backups():
        if path.name == name:
            return read_scene(path)
    raise ProjectError("that version no longer exists; choose another")
