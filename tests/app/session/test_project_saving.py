"""A project's folder follows its document, in as much as it differs."""

from __future__ import annotations

from pathlib import Path

import pytest

from diorama_app.session.document import Document
from diorama_app.session.project_saving import ProjectSaving
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from tests.app.small_room import PlainLibrary, make_project


@pytest.fixture
def project(tmp_path: Path) -> Project:
    return make_project(tmp_path / "demo")


def test_what_differs_is_written_and_the_folder_let_go(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    saving, document = ProjectSaving(lambda line, _: said.append(line), lambda: None), Document()
    saving.take(project)
    document.open(project.load_scene(), project.load_inputs(), ())
    saving.is_saved(document)
    document.commit("remove", edits.remove(document.scene, ("lamp_1",)))
    monkeypatch.setattr(Project, "save_inputs", lambda *_: pytest.fail("the photo's corrections are there already"))
    saving.save_soon(project, document, PlainLibrary())
    other = ProjectSaving(lambda *_: None, lambda: None)
    other.take(project)
    assert "nothing can be changed here" in other.access.read_only
    saving.close()
    assert not project.load_scene().has_object("lamp_1")
    other.take(project)
    assert other.access.read_only == ""
    other.close()
    assert said == []
