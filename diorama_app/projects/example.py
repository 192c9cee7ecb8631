"""The bundled example: the scene that `scripts/make_example.py` built from its own rendering, copied to be edited."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from pathlib import Path

from diorama_core.errors import ProjectError
from diorama_core.io.assets import asset
from diorama_core.perception.inputs import ReadInputs, read_inputs
from diorama_core.project.storage import Project

EXAMPLE = asset("example")
NAME = "example"
PHOTO_NAME = "rendering.jpg"
"""What the editor calls the picture: it is no photo."""


def example_project(projects_dir: Path) -> Project | None:
    """The example in the projects' folder: the one that is there, or a copy of the bundled project, if any.

    Raises:
        ProjectError: the folder cannot be written.
    """
    target = projects_dir / NAME
    if (target / "scene.json").exists():
        return Project.open(target)
    bundled = EXAMPLE / "project"
    if not (bundled / "scene.json").exists():
        return None
    try:
        projects_dir.mkdir(parents=True, exist_ok=True)
        # Copied beside and renamed, so that a copy cut short is never taken for the project.
        with tempfile.TemporaryDirectory(dir=projects_dir) as part:
            shutil.copytree(bundled, Path(part) / NAME)
            read = example_inputs()
            Project.open(Path(part) / NAME).save_inputs(read.inputs, read.warnings)
            os.replace(Path(part) / NAME, target)
    except OSError as error:
        raise ProjectError(
            f"cannot write in {projects_dir} ({error.strerror}); choose another folder with --projects"
        ) from error
    return Project.open(target)


def example_inputs() -> ReadInputs:
    """The example's rendering with its boxes and camera."""
    k = json.loads((EXAMPLE / "intrinsics.json").read_text(encoding="utf-8"))
    camera = (k["fx"], k["fy"], k["cx"], k["cy"])
    return read_inputs(EXAMPLE / "photo.jpg", boxes=EXAMPLE / "boxes.json", intrinsics=camera, name=PHOTO_NAME)
