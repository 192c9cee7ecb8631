"""`scripts/load.py` presses what the page really has: its people see their own edits."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from diorama_app.serve import Running, start
from scripts import load
from tests.app.small_room import PlainLibrary, make_project


@pytest.fixture
def running(tmp_path: Path) -> Iterator[Running]:
    project = make_project(tmp_path / "projects" / "demo", load.room_of(12))
    made = start(project=project.folder, projects_dir=tmp_path / "projects", low_graphics=True, library=PlainLibrary())
    yield made
    made.stop()


def test_a_person_hides_and_shows_an_object_and_sees_it(running: Running) -> None:
    person, other = load.Person(running.port), load.Person(running.port)
    for _ in range(2):
        person.edit("more_3")
        other.edit("lamp_1")
    assert person.lost == other.lost == 0
    assert len(person.latencies) == len(other.latencies) == 2
    assert not running.session.scene.object("lamp_1").hidden, "hidden and shown again"
    person.page.close()
    other.page.close()
