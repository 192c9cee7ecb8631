from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from diorama_app.session import recovery
from diorama_app.session.autosave import Autosave
from diorama_app.session.recovery import Recovery
from diorama_core.errors import ProjectError
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene, make_project


@pytest.fixture
def project(tmp_path: Path) -> Project:
    made = make_project(tmp_path / "demo")
    long_ago = time.time() - 60.0
    os.utime(made.scene_path, (long_ago, long_ago))
    return made


def renamed() -> Scene:
    return edits.rename(furnished_scene(), "chair_1", "throne")


def test_what_a_crash_left_is_offered_to_the_next_session_only(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recovery, "SETTLED_S", -1.0)
    crashed, later = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    crashed.note(project, renamed())
    assert crashed.left_behind(project) is None
    found = later.left_behind(project)
    assert found is not None
    assert found.scene() == renamed()
    found.discard()
    assert later.left_behind(project) is None


def test_what_is_saved_is_not_offered(project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recovery, "SETTLED_S", -1.0)
    crashed, later = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    crashed.note(project, furnished_scene())
    assert later.left_behind(project) is None, "the project's own file says the same"
    crashed.note(project, renamed())
    crashed.forget(project)
    assert later.left_behind(project) is None


def test_the_young_may_still_be_saved_by_somebody_else(project: Project, tmp_path: Path) -> None:
    other, here = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    other.note(project, renamed())
    assert here.left_behind(project) is None


def test_the_saver_notes_at_once_and_forgets_when_it_has_saved(project: Project, tmp_path: Path) -> None:
    told: list[str] = []
    autosave = Autosave(told.append, Recovery(tmp_path / "unsaved"))
    autosave.save_soon(project, renamed())
    deadline = time.monotonic() + 10.0
    while not list((tmp_path / "unsaved").glob("*.json")) and time.monotonic() < deadline:
        time.sleep(0.01)
    assert project.load_scene() == furnished_scene(), "noted before it is saved"
    autosave.stop()
    assert project.load_scene() == renamed()
    assert list((tmp_path / "unsaved").glob("*.json")) == []
    assert told == []


def test_what_cannot_be_saved_is_retained(project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(self: Project, scene: Scene) -> None:
        raise ProjectError("the disk is full")

    monkeypatch.setattr(recovery, "SETTLED_S", -1.0)
    monkeypatch.setattr(Project, "save_scene", full)
    told: list[str] = []
    autosave = Autosave(told.append, Recovery(tmp_path / "unsaved"))
    autosave.save_soon(project, renamed())
    autosave.stop()
    assert "the disk is full" in told[0]
    found = Recovery(tmp_path / "unsaved").left_behind(project)
    assert found is not None
    assert found.scene() == renamed()
