from __future__ import annotations

from pathlib import Path

import pytest

from diorama_app.http_api.job import MAX_LINE, Job, build_job, line_of
from diorama_core.errors import InputError, ProjectError
from diorama_core.progress import Progress
from diorama_core.project.storage import Project
from tests.app.small_room import PlainLibrary


def test_a_project_that_lost_its_photo_is_not_built(tmp_path: Path) -> None:
    Project.create(tmp_path / "room")
    with pytest.raises(ProjectError, match="room has no photo any more; send it again"):
        build_job(Job("room", "now"), tmp_path / "room", PlainLibrary(), Progress())


def test_why_a_build_failed_is_one_line(caplog: pytest.LogCaptureFixture) -> None:
    assert line_of(InputError("no\nphoto " + "x" * 9000), "room") == "no photo " + "x" * (MAX_LINE - 10) + "…"
    assert not caplog.records
    assert line_of(ZeroDivisionError("half \ud800"), "room") == "internal error (ZeroDivisionError: half ?)"
    assert "the build of room failed" in caplog.text
