"""A project's folder follows its document, in as much as it differs."""

from __future__ import annotations

from pathlib import Path

import pytest

from diorama_app.session.document import Document
from diorama_app.session.project_saving import ProjectAccess, ProjectSaving
from diorama_core.errors import EditRefused, ProjectError
from diorama_core.project import lock
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from tests.app.small_room import PlainLibrary, make_project


@pytest.fixture
def project(tmp_path: Path) -> Project:
    return make_project(tmp_path / "demo")


def test_the_first_to_come_may_change_the_project_and_the_second_reads_why_not(project) -> None:
    first, second = ProjectAccess(), ProjectAccess()
    assert first.take(project)
    first.need_writable()
    assert not second.take(project)
    with pytest.raises(EditRefused, match="open in the editor of"):
        second.need_writable()
    first.release()
    assert second.take(project)
    assert second.read_only == ""
    second.release()


def test_opening_the_same_project_again_keeps_the_lock(project) -> None:
    access = ProjectAccess()
    assert access.take(project)
    assert not access.take(project)
    assert not ProjectAccess().take(project)
    access.release()


def test_another_project_gives_the_first_one_free(project, tmp_path) -> None:
    access, other = ProjectAccess(), ProjectAccess()
    access.take(project)
    assert access.take(make_project(tmp_path / "second"))
    assert other.take(project)
    access.release()
    other.release()


def test_a_folder_that_cannot_be_locked_is_opened_all_the_same(project, monkeypatch) -> None:
    def full(*given) -> None:
        raise ProjectError("the disk is full")

    monkeypatch.setattr("diorama_app.session.project_saving.ProjectLock", full)
    access = ProjectAccess()
    assert not access.take(project)
    access.need_writable()
    assert access.unwritable == "changes will not be saved: the disk is full"
    assert lock.LOCK not in {p.name for p in project.folder.iterdir()}


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
