"""The bundled example: a project made from the project's own photo, copied so that it can be edited."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

from diorama_core.errors import ProjectError
from diorama_core.project.storage import Project

EXAMPLE = Path(__file__).resolve().parents[1] / "assets" / "example"
NAME = "example"


def example_project(projects_dir: Path) -> Project | None:
    """The example in the projects' folder, copied there the first time; None when none is bundled.

    Raises:
        ProjectError: the folder cannot be written.
    """
    target = projects_dir / NAME
    if (target / "scene.json").exists():
        return Project.open(target)
    bundled = next((f for f in (EXAMPLE, EXAMPLE / "project") if (f / "scene.json").exists()), None)
    if bundled is None or not (bundled / "project.json").exists():
        return None
    try:
        projects_dir.mkdir(parents=True, exist_ok=True)
        # Copied beside and renamed, so that a copy cut short is never taken for the project.
        with tempfile.TemporaryDirectory(dir=projects_dir) as part:
            shutil.copytree(bundled, Path(part) / NAME)
            os.replace(Path(part) / NAME, target)
    except OSError as error:
        raise ProjectError(
            f"cannot write in {projects_dir} ({error.strerror}); choose another folder with --projects"
        ) from error
    return Project.open(target)
