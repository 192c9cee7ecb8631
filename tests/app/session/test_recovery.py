from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from diorama_app.session import autosave as autosave_module
from diorama_app.session import recovery
from diorama_app.session.autosave import Autosave
from diorama_app.session.recovery import Recovery, Unsaved
from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import ProjectError, SceneError
from diorama_core.project.further_photos import load_photos
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene, make_project, plain_photo
from tests.somebody_else import delete_first
from tests.waiting import until


@pytest.fixture
def project(tmp_path: Path) -> Project:
    made = make_project(tmp_path / "demo")
    age(made.scene_path, 60.0)
    return made


def renamed() -> Scene:
    return edits.rename(furnished_scene(), "chair_1", "throne")


class Saves:
    """The scenes that a project is asked to save, and what happens then."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *failures: Exception) -> None:
        self.scenes: list[Scene] = []
        self.meanwhile: Callable[[], None] = lambda: None
        self.failures, really_save = list(failures), Project.save_scene

        def save(project: Project, scene: Scene) -> bool:
            self.scenes.append(scene)
            self.meanwhile()
            if self.failures:
                raise self.failures.pop(0)
            return really_save(project, scene)

        monkeypatch.setattr(Project, "save_scene", save)


FULL = (ProjectError("the disk is full"),) * 1000


@pytest.fixture
def autosave(tmp_path: Path) -> Autosave:
    """One of which only the test writes anything."""
    made = Autosave(lambda line: None, Recovery(tmp_path / "unsaved"), retry_s=600.0)
    made.stop()
    return made


def note_of(folder: Path, aged_s: float = 0.0) -> Path:
    """The only note of what is unsaved, made older."""
    (note,) = (folder / "unsaved").glob("*.json")
    age(note, aged_s)
    return note


def age(path: Path, by_s: float) -> None:
    os.utime(path, (time.time() - by_s,) * 2)


def check_offered(recovery: Recovery, project: Project) -> Unsaved:
    found = recovery.find_unsaved(project)
    assert found is not None
    assert found.scene() == renamed()
    return found


def test_what_a_crash_left_is_offered_to_the_next_session_only(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recovery, "SETTLED_S", -1.0)
    crashed, later = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    crashed.note(project, renamed())
    assert crashed.find_unsaved(project) is None
    found = check_offered(later, project)
    assert time.strptime(found.when, "%d %b %H:%M").tm_mon == time.localtime(found.at).tm_mon
    for _ in range(2):  # another page may have been quicker
        found.discard()
    assert later.find_unsaved(project) is None


def test_what_is_unsaved_of_one_project_is_not_offered_for_another(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recovery, "SETTLED_S", -1.0)
    copy = make_project(tmp_path / "copy")
    Recovery(tmp_path / "unsaved").note(copy, renamed())
    later = Recovery(tmp_path / "unsaved")
    assert later.find_unsaved(copy) is not None
    assert later.find_unsaved(project) is None, "a project of the same scene"


def test_a_note_that_somebody_else_deletes_first_is_gone(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    here = Recovery(tmp_path / "unsaved")
    here.note(project, renamed())
    delete_first(monkeypatch)
    here.forget(project)
    assert list((tmp_path / "unsaved").glob("*.json")) == []
    assert caplog.records == []


def test_what_is_saved_is_not_offered(project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recovery, "SETTLED_S", -1.0)
    crashed, later = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    crashed.note(project, furnished_scene())
    assert later.find_unsaved(project) is None, "the project's own file says the same"
    crashed.note(project, renamed())
    crashed.forget(project)
    assert later.find_unsaved(project) is None


def test_the_young_may_still_be_saved_by_somebody_else(project: Project, tmp_path: Path) -> None:
    other, here = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    other.note(project, renamed())
    assert here.find_unsaved(project) is None


def test_what_is_saved_is_written_once(project: Project, tmp_path: Path) -> None:
    told: list[str] = []
    autosave = Autosave(told.append, Recovery(tmp_path / "unsaved"))
    autosave.save_soon(project, renamed())
    until(lambda: project.load_scene() == renamed())
    autosave.stop()
    assert not (tmp_path / "unsaved").exists()
    assert told == []


def test_what_cannot_be_saved_is_retained(project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recovery, "SETTLED_S", -1.0)
    Saves(monkeypatch, *FULL)
    told: list[str] = []
    autosave = Autosave(told.append, Recovery(tmp_path / "unsaved"))
    autosave.save_soon(project, renamed())
    autosave.stop()
    assert "the disk is full" in told[0]
    assert "stored beside the project" in told[0]
    check_offered(Recovery(tmp_path / "unsaved"), project)


def test_what_could_not_be_saved_is_saved_as_soon_as_there_is_space(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    saves = Saves(monkeypatch, *FULL)
    told: list[str] = []
    autosave = Autosave(told.append, Recovery(tmp_path / "unsaved"), on_saved=told.append, retry_s=0.1)
    autosave.save_soon(project, renamed())
    until(lambda: autosave.trouble)
    assert "the disk is full" in autosave.trouble
    saves.failures.clear()
    until(lambda: not autosave.trouble)
    assert project.load_scene() == renamed()
    assert [line.partition(":")[0] for line in told] == ["Not saved", "All changes are saved now."], "once each"
    assert list((tmp_path / "unsaved").glob("*.json")) == []
    autosave.stop()


def test_the_page_is_told_when_there_is_an_earlier_version(project: Project, tmp_path: Path) -> None:
    versions: list[int] = []
    autosave = Autosave(
        pytest.fail, Recovery(tmp_path / "unsaved"), on_version=lambda: versions.append(len(project.backups()))
    )
    for _ in range(2):  # at most one version a minute
        autosave.save_soon(project, renamed())
        autosave.flush()
    autosave.stop()
    assert versions == [1]


def test_nothing_is_promised_when_nothing_can_be_retained(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "unsaved").write_text("a file where the folder would be")
    Saves(monkeypatch, *FULL)
    told: list[str] = []
    autosave = Autosave(told.append, Recovery(tmp_path / "unsaved"))
    autosave.save_soon(project, renamed())
    autosave.flush()
    assert "only in memory" in told[0]
    assert "kept" not in told[0]
    autosave.stop()


def test_a_scene_that_cannot_be_written_does_not_end_the_thread(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    really_save = Project.save_scene

    def save(self: Project, scene: Scene) -> None:
        if scene == furnished_scene():
            raise ZeroDivisionError("a bug")
        really_save(self, scene)

    monkeypatch.setattr(Project, "save_scene", save)
    told: list[str] = []
    autosave = Autosave(told.append, Recovery(tmp_path / "unsaved"), retry_s=0.05)
    autosave.save_soon(project, furnished_scene())
    autosave.flush()
    assert "a bug" in told[0]
    autosave.save_soon(project, renamed())
    until(lambda: project.load_scene() == renamed())
    autosave.stop()


def test_a_note_that_cannot_be_made_does_not_end_the_thread(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_memory(scene: Scene) -> str:
        raise MemoryError

    autosave = Autosave(lambda message: None, Recovery(tmp_path / "unsaved"), retry_s=0.05)
    with monkeypatch.context() as short:
        short.setattr("diorama_app.session.recovery.scene_to_json", no_memory)
        autosave.save_soon(project, furnished_scene())
        until(lambda: project.has_scene and project.load_scene() == furnished_scene())
    autosave.save_soon(project, renamed())
    until(lambda: project.load_scene() == renamed())
    autosave.stop()


def test_leftovers_are_removed_when_their_time_is_over(project: Project, tmp_path: Path) -> None:
    old, here = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    old.note(project, renamed())
    superseded = note_of(tmp_path, 86400.0)
    project.save_scene(edits.rename(furnished_scene(), "chair_1", "stool"))
    names = ("demo/.scene.json.abc.part", "demo/stages/.x.zip.abc.part", "unsaved/.abc.part")
    parts = [tmp_path / name for name in names]
    for part in parts:
        part.write_bytes(b"half")
        age(part, 86400.0)
    fresh = project.folder / ".scene.json.now.part"
    fresh.write_bytes(b"being written")
    here.clean_up(project)
    assert not superseded.exists()
    assert not any(part.exists() for part in parts)
    assert fresh.exists()


def test_a_damaged_unsaved_copy_is_not_in_the_way(project: Project, tmp_path: Path) -> None:
    old, here = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    old.note(project, renamed())
    damaged = note_of(tmp_path)
    damaged.write_bytes(b"\xff\xfe[[[")
    age(damaged, 30.0)
    found = here.find_unsaved(project)
    assert found is not None
    with pytest.raises(SceneError):
        found.scene()


@pytest.mark.parametrize("ahead_s", [-10 * 365 * 86400.0, -3600.0, 3600.0, 10 * 365 * 86400.0])
def test_no_clock_decides_what_is_newer(project: Project, tmp_path: Path, ahead_s: float) -> None:
    """After a flight west the scene's time lay ahead, and the copy of what was not saved was deleted."""
    crashed, later = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    crashed.note(project, renamed())
    noted = note_of(tmp_path, 60.0)
    age(project.scene_path, -ahead_s)
    later.clean_up(project)
    check_offered(later, project)
    project.save_scene(edits.rename(furnished_scene(), "chair_1", "stool"))
    age(project.scene_path, -ahead_s)
    assert later.find_unsaved(project) is None, "something newer is saved"
    later.clean_up(project)
    assert not noted.exists()


def test_a_session_keeps_one_note_of_a_project(project: Project, tmp_path: Path) -> None:
    here = Recovery(tmp_path / "unsaved")
    for number in range(3):
        project.save_scene(edits.rename(furnished_scene(), "chair_1", f"stool {number}"))
        here.note(project, renamed())
    assert note_of(tmp_path)
    here.forget(project)
    assert not list((tmp_path / "unsaved").glob("*.json"))


def test_notes_of_earlier_programs_are_found(project: Project, tmp_path: Path) -> None:
    old, here = Recovery(tmp_path / "unsaved"), Recovery(tmp_path / "unsaved")
    old.note(project, renamed())
    noted = note_of(tmp_path, 30.0)
    noted.rename(noted.with_name("-".join(noted.stem.split("-")[:2]) + ".json"))
    check_offered(here, project)


def test_notes_of_other_projects_go_after_a_month(project: Project, tmp_path: Path) -> None:
    here = Recovery(tmp_path / "unsaved")
    other = make_project(tmp_path / "other")
    Recovery(tmp_path / "unsaved").note(other, renamed())
    note = note_of(tmp_path)
    here.clean_up(project)
    assert note.exists()
    age(note, recovery.FORGOTTEN_S + 60.0)
    here.clean_up(project)
    assert not note.exists()


def test_a_scene_that_is_saved_is_written_again_only_where_it_is_gone(
    project: Project, autosave: Autosave, monkeypatch: pytest.MonkeyPatch
) -> None:
    saves, scene = Saves(monkeypatch), renamed()
    assert autosave.saved_at is None
    for count, removed in ((1, False), (1, False), (2, True)):
        if removed:
            project.scene_path.unlink()
        autosave.save_soon(project, scene)
        autosave.flush()
        assert len(saves.scenes) == count
    assert project.load_scene() == scene
    assert autosave.saved_at is not None
    autosave.save_soon(project, furnished_scene())
    autosave.flush()
    assert project.load_scene() == furnished_scene()


def test_what_is_said_of_photos_is_saved_without_a_scene(
    project: Project, autosave: Autosave, monkeypatch: pytest.MonkeyPatch
) -> None:
    saves = Saves(monkeypatch)
    project.update_info(warnings=["blurred"])
    inputs, one, two = Inputs(plain_photo(64, 48)), *(FurtherPhoto(n, Inputs(plain_photo())) for n in ("one", "two"))
    autosave.save_soon(project, None, inputs, (one,))
    autosave.flush()
    assert project.load_inputs() == inputs
    assert project.info()["warnings"] == ["blurred"]
    path = project.folder / "photos" / "one.zip"
    before = path.stat().st_mtime_ns
    autosave.save_soon(project, None, None, (one, two))
    autosave.flush()
    assert [photo.name for photo in load_photos(project)[0]] == ["one", "two"]
    assert path.stat().st_mtime_ns == before, "it is saved already"
    assert saves.scenes == []


def test_what_is_newer_wins_over_what_could_not_be_saved(
    project: Project, autosave: Autosave, monkeypatch: pytest.MonkeyPatch
) -> None:
    saves = Saves(monkeypatch, ProjectError("the disk is full"))
    newer = edits.rename(furnished_scene(), "chair_1", "newer")
    saves.meanwhile = lambda: autosave.save_soon(project, newer)
    autosave.save_soon(project, renamed())
    autosave.flush()
    saves.meanwhile = lambda: None
    autosave.flush()
    assert project.load_scene() == newer
    assert saves.scenes[1:] == [newer]


def test_a_defect_is_logged_and_a_full_disk_is_not(
    project: Project, autosave: Autosave, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    Saves(monkeypatch, ProjectError("the disk is full"), ZeroDivisionError("a defect"))
    for count in (0, 1):
        autosave.save_soon(project, renamed())
        autosave.flush()
        assert len(caplog.records) == count
    assert "the scene cannot be written (a defect)" in autosave.trouble


def test_photos_that_cannot_be_saved_are_only_in_memory(
    project: Project, autosave: Autosave, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Project, "save_inputs", lambda *about: (_ for _ in ()).throw(ProjectError("the disk is full")))
    autosave.save_soon(project, None, Inputs(plain_photo()))
    autosave.flush()
    assert "only in memory" in autosave.trouble


def test_what_cannot_be_saved_is_tried_again_at_its_time_and_the_thread_ends(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(autosave_module, "SETTLE_S", 0.001)
    saves = Saves(monkeypatch, *FULL)
    made = Autosave(lambda line: None, Recovery(tmp_path / "unsaved"), retry_s=600.0)
    made.save_soon(project, renamed())
    until(lambda: made.trouble)
    time.sleep(0.2)  # a thread that does not wait tries many times in so long
    assert len(saves.scenes) == 1
    assert made._thread.daemon
    made.stop()
    assert not made._thread.is_alive()
