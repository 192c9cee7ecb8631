"""Earlier versions of a scene, whatever the clock says and wherever their folder leads."""

from __future__ import annotations

import os
import time
from dataclasses import replace
from pathlib import Path

import pytest

from diorama_core.project import backups
from diorama_core.project.backups import MAX_BACKUPS
from diorama_core.project.storage import Project, read_scene
from diorama_core.scene.types import Scene
from tests.scene.test_edits import _stack
from tests.somebody_else import delete_first

YEAR_S = 365 * 86400.0


def _numbered(number: int) -> Scene:
    return replace(_stack(), metrics={"number": float(number)})


def _numbers(project: Project) -> list[int]:
    return [int(dict(read_scene(path).metrics)["number"]) for path in project.backups()]


@pytest.fixture
def project(tmp_path: Path) -> Project:
    made = Project.create(tmp_path / "room")
    made.save_scene(_numbered(0))
    return made


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time that programs are told, and files get."""
    now = [float(int(time.time()))]
    monkeypatch.setattr(time, "time", lambda: now[0])
    monkeypatch.setattr(time, "gmtime", lambda at=None, real=time.gmtime: real(now[0] if at is None else at))
    replaced = os.replace

    def replace_and_date(part: Path, path: Path) -> None:
        replaced(part, path)
        os.utime(path, (now[0], now[0]))

    monkeypatch.setattr(os, "replace", replace_and_date)
    return now


def test_versions_are_kept_in_order_while_the_clock_jumps(project: Project, clock: list[float]) -> None:
    """With 20 versions dated later, each new one was the first to be deleted."""
    jumps = [120.0, YEAR_S, -2 * YEAR_S, 3600.0, -3600.0, 61.0, -YEAR_S] * 4
    for number, jump in enumerate(jumps, start=1):
        clock[0] += jump
        assert project.save_scene(_numbered(number)), "each is a version of its own"
        assert _numbers(project)[0] == number - 1, "what was just written is the newest"
    assert _numbers(project) == list(range(len(jumps) - 1, len(jumps) - 1 - MAX_BACKUPS, -1))


def test_versions_of_earlier_programs_are_older_than_all_with_a_number(project: Project, clock: list[float]) -> None:
    folder = project.folder / "backups"
    folder.mkdir()
    for day in range(1, 29):
        (folder / f"scene-209912{day:02d}-120000-{day:09d}.json").write_bytes(project.scene_path.read_bytes())
    clock[0] += YEAR_S
    for number in range(1, 4):
        clock[0] -= 120.0
        project.save_scene(_numbered(number))
    assert [path.name[:13] for path in project.backups()[:2]] == ["scene-n000002", "scene-n000001"]
    assert _numbers(project)[:3] == [2, 1, 0]
    assert len(project.backups()) == MAX_BACKUPS


def test_within_a_minute_no_other_version_is_kept_unless_asked(project: Project, clock: list[float]) -> None:
    kept = backups.Backups(project.folder / "versions")
    assert kept.keep(project.scene_path, at_once=False)
    assert kept.paths()[0].name.startswith("scene-n000001-")
    project.scene_path.write_bytes(project.scene_path.read_bytes() + b" ")
    assert not kept.keep(project.scene_path, at_once=False)
    assert kept.keep(project.scene_path, at_once=True)
    clock[0] += 60.0
    assert not kept.keep(project.scene_path, at_once=False), "it holds the same"
    project.scene_path.write_bytes(project.scene_path.read_bytes() + b" ")
    assert kept.keep(project.scene_path, at_once=False)
    assert [path.name[:13] for path in kept.paths()] == [f"scene-n00000{number}" for number in (3, 2, 1)]


def test_a_version_that_somebody_else_deletes_first_is_gone(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backups, "BACKUP_EVERY_S", 0.0)
    delete_first(monkeypatch)
    for number in range(1, MAX_BACKUPS + 3):
        project.save_scene(_numbered(number))
    assert _numbers(project)[-1] == 2


def test_the_same_scene_is_kept_once(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backups, "BACKUP_EVERY_S", 0.0)
    for _ in range(5):
        project.save_scene(_numbered(1))
    assert _numbers(project) == [1, 0]


@pytest.mark.posix
def test_nothing_is_deleted_in_a_folder_of_somebody_else(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A received project may have a link in place of its folder of versions."""
    monkeypatch.setattr(backups, "BACKUP_EVERY_S", 0.0)
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    names = [f"scene-20200101-000000-{i:09d}.json" for i in range(30)] + ["scene-1.json", "scene-plan.json"]
    for name in names:
        (theirs / name).write_text("theirs")
    (project.folder / "backups").symlink_to(theirs)
    for number in range(1, 5):
        project.save_scene(_numbered(number))
    assert all((theirs / name).read_text() == "theirs" for name in names)


@pytest.mark.posix
def test_files_that_are_no_versions_are_left_alone(
    project: Project, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(backups, "BACKUP_EVERY_S", 0.0)
    folder = project.folder / "backups"
    folder.mkdir()
    (folder / "scene-of-mine.json").write_text("mine")
    (tmp_path / "scene-n000009-20261128T000000Z.json").write_text("elsewhere")
    (folder / "scene-n000009-20261128T000000Z.json").symlink_to(tmp_path / "scene-n000009-20261128T000000Z.json")
    for number in range(1, MAX_BACKUPS + 5):
        project.save_scene(_numbered(number))
    assert len(project.backups()) == MAX_BACKUPS
    assert (folder / "scene-of-mine.json").exists()
    assert (folder / "scene-n000009-20261128T000000Z.json").is_symlink()
