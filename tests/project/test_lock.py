"""One program at a time changes a project."""

from __future__ import annotations

import getpass
import subprocess
import sys
from pathlib import Path

import pytest

from diorama_core.errors import ProjectError
from diorama_core.project.lock import ProjectLock, ProjectLockedError
from diorama_core.project.storage import Project
from tests.waiting import until

TAKE = """
import sys, time
from pathlib import Path
from diorama_core.project.lock import ProjectLock
lock = ProjectLock(Path(sys.argv[1]), "the editor")
print("taken", flush=True)
time.sleep(60)
"""


def test_the_second_is_told_who_has_it(tmp_path: Path) -> None:
    folder = Project.create(tmp_path / "room").folder
    with ProjectLock(folder, "the editor") as lock:
        assert lock.folder == folder
        with pytest.raises(
            ProjectLockedError, match=rf"room is open in the editor of {getpass.getuser()} on .* \(process \d+"
        ) as told:
            ProjectLock(folder, "diorama build")
        assert "\n" not in str(told.value)
    ProjectLock(folder).release()


def can_be_locked(folder: Path) -> bool:
    try:
        ProjectLock(folder).release()
    except ProjectLockedError:
        return False
    return True


def test_a_lock_ends_with_the_program_that_has_it(tmp_path: Path) -> None:
    folder = Project.create(tmp_path / "room").folder
    other = subprocess.Popen([sys.executable, "-c", TAKE, str(folder)], stdout=subprocess.PIPE, text=True)
    try:
        assert other.stdout is not None
        assert other.stdout.readline() == "taken\n"
        with pytest.raises(ProjectLockedError, match=f"process {other.pid}"):
            ProjectLock(folder)
    finally:
        other.kill()
        other.wait()
        assert other.stdout is not None
        other.stdout.close()
    until(lambda: can_be_locked(folder), "the lock ends with its holder")


def test_who_has_it_may_say_anything_of_itself(tmp_path: Path) -> None:
    folder = Project.create(tmp_path / "room").folder
    with ProjectLock(folder, "the editor"):
        (folder / ".diorama-owner.lock").write_bytes(b"\xff[[")
        with pytest.raises(ProjectLockedError, match="another program"):
            ProjectLock(folder)


def test_a_folder_that_is_none_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(ProjectError, match=r"cannot be changed \((File exists|Not a directory)\)"):
        ProjectLock(tmp_path / "file")


def test_a_lock_and_parts_are_no_other_files(tmp_path: Path) -> None:
    (tmp_path / ".project.json.1234.part").write_bytes(b"half")
    ProjectLock(tmp_path).release()
    assert Project.create(tmp_path).name == tmp_path.name
