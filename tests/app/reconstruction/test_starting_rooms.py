from __future__ import annotations

import pytest

from diorama_app.reconstruction.starting_rooms import open_example, start_empty_room
from diorama_core.errors import EditRefused, InputError
from diorama_core.synthesis import example_rooms
from tests.app.people import settle
from tests.app.small_room import furnished_scene


def test_an_empty_room_is_a_project_of_its_own_and_a_bad_one_is_none(session, client) -> None:
    before = session.project.folder
    with pytest.raises(EditRefused):
        start_empty_room(client, 0.1, 4.0, 2.5)
    assert session.project.folder == before
    start_empty_room(client, 3.0, 4.0, 2.5)
    assert session.project.folder != before
    assert (before / "scene.json").exists()
    assert session.project.load_scene() == session.scene


def test_an_example_is_furnished_in_the_background(session, client, monkeypatch) -> None:
    monkeypatch.setattr(example_rooms, "example_room", lambda room, library: furnished_scene())
    with pytest.raises(InputError, match="no such example"):
        open_example(client, "castle")
    open_example(client, "study")
    settle(session)
    assert session.project.name == "Study"
    assert session.scene.objects == furnished_scene().objects
