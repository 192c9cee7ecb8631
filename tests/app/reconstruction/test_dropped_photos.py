"""Photos that were dropped together become projects, or one line says why not."""

from __future__ import annotations

import pytest

from diorama_app.projects.dropped import interpret
from diorama_app.reconstruction.dropped_photos import begin_each, build_one_room
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.project.storage import Project
from tests.app.projects.test_dropped import BOXES, PHOTO, packed
from tests.waiting import until


@pytest.fixture
def visited(session: EditorSession, monkeypatch: pytest.MonkeyPatch) -> list[tuple[Project, str]]:
    found: list[tuple[Project, str]] = []
    monkeypatch.setattr(session, "visit", lambda client, project, said: found.append((project, said)))
    return found


def test_each_photo_is_a_project_with_what_belongs_to_it(
    session: EditorSession, client: Client, visited: list[tuple[Project, str]]
) -> None:
    content = packed({"a.jpg": PHOTO, "a.json": BOXES, "b.jpg": PHOTO})
    reading = next(r for r in interpret(content, "drop.zip", None).readings if r.action == "photos")
    begin_each(client, "drop.zip", content, reading)
    until(lambda: bool(visited), seconds=60)
    ((first, said),) = visited
    assert "Each of the 2 photos has its own project" in said
    inputs = first.load_inputs()
    assert inputs is not None
    assert len(inputs.boxes) == 1
    assert len([p for p in session.projects_dir.iterdir() if (p / "project.json").exists()]) >= 2


def test_a_room_of_photos_that_are_none_leaves_no_project(
    session: EditorSession, client: Client, visited: list[tuple[Project, str]]
) -> None:
    content = packed({"a.jpg": PHOTO, "b.jpg": PHOTO})
    reading = next(r for r in interpret(content, "drop.zip", None).readings if r.action == "photos")
    before = set(session.projects_dir.iterdir())
    broken = packed({"a.jpg": b"\xff\xd8\xff no picture", "b.jpg": PHOTO})
    build_one_room(client, "drop.zip", broken, reading)
    until(lambda: session.jobs.status is None, seconds=60)
    assert visited == []
    assert set(session.projects_dir.iterdir()) == before
