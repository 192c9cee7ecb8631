from __future__ import annotations

import io
import os
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_app.projects.pictures import SIZE, project_picture
from diorama_core.editing.plan_edits import empty_room
from diorama_core.project.storage import Project


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Project:
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path / "cache"))
    made = Project.create(tmp_path / "room")
    made.save_scene(empty_room(3.0, 4.0, 2.5))
    return made


def test_a_scene_is_drawn_once_after_each_change(project: Project) -> None:
    first = project_picture(project.folder)
    assert first is not None
    picture = np.asarray(Image.open(io.BytesIO(first)))
    assert picture.shape[:2] == SIZE[::-1]
    assert picture.std() > 5, "something is seen"
    assert project_picture(project.folder) is not None
    (cached,) = (project.folder.parent / "cache" / "projects").iterdir()
    drawn = cached.stat().st_mtime_ns
    later = time.time() + 5
    os.utime(project.scene_path, (later, later))
    assert project_picture(project.folder) is not None
    assert cached.stat().st_mtime_ns > drawn


def test_a_project_without_scene_and_photo_has_none(tmp_path: Path) -> None:
    assert project_picture(Project.create(tmp_path / "empty").folder) is None
