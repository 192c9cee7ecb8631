"""The bundled example: the project's own photo with boxes, built into a project the first time it is wanted."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from pathlib import Path

from diorama_app.drafts import Draft
from diorama_core.errors import ProjectError
from diorama_core.perception.inputs import read_inputs
from diorama_core.project.storage import Project

EXAMPLE = Path(__file__).resolve().parents[1] / "assets" / "example"
NAME = "example"


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
            draft = example_draft()
            if draft is not None:
                Project.open(Path(part) / NAME).save_inputs(draft.inputs, draft.warnings)
            os.replace(Path(part) / NAME, target)
    except OSError as error:
        raise ProjectError(
            f"cannot write in {projects_dir} ({error.strerror}); choose another folder with --projects"
        ) from error
    return Project.open(target)


def example_draft() -> Draft | None:
    """The example's photo with its boxes, ready to be built; None when none is bundled."""
    photo, boxes, camera = EXAMPLE / "photo.jpg", EXAMPLE / "boxes.json", EXAMPLE / "intrinsics.json"
    if not photo.exists() or not boxes.exists():
        return None
    given = json.loads(camera.read_text()) if camera.exists() else None
    intrinsics = None if given is None else (given["fx"], given["fy"], given["cx"], given["cy"])
    read = read_inputs(photo, boxes=boxes, intrinsics=intrinsics)
    files = {"photo": photo.read_bytes(), "boxes": boxes.read_bytes()}
    return Draft(read.inputs, read.inputs.boxes, warnings=read.warnings, files=files, name=NAME)
