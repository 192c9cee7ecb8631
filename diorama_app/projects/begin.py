"""A new project: a folder of its own, from the moment when a photo is there."""

from __future__ import annotations

import re
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from jaxtyping import UInt8

from diorama_core.errors import InputError
from diorama_core.perception.inputs import ReadInputs
from diorama_core.project.storage import Project
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
    folder = fresh_folder(projects_dir, file_name)
    project = Project.create(folder, name=Path(file_name).stem)
    try:
        project.save_upload("photo", content)
        project.save_inputs(read.inputs, read.warnings)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    return project


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
) -> Project:
    """Make a project of a scene that no photo shows. None is left behind when it cannot be saved.

    Args:
        projects_dir: where projects are.
        name: what people call the project.
        scene: with which it begins.
        textures: the pictures that the scene names.
        notes: how the scene was made.

    Raises:
        ProjectError: the folder cannot be written.
    """
    folder = fresh_folder(projects_dir, name)
    project = Project.create(folder, name=name)
    try:
        project.update_info(notes=list(notes))
        project.save_textures(textures)
        project.save_scene(scene)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    return project
