"""What was guessed about a model of one's own is put right."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_app.guest import Guest
from diorama_app.importing import FIXES, correct_model, is_own_model
from diorama_app.inserting import insert_shape
from diorama_app.room import Room
from diorama_app.shelf import Shelf
from diorama_app.viser_adapter import Visitors, create_server, stop_server
from diorama_core.errors import EditRefused, InputError
from diorama_core.library.ingest.shaping import packed_shape
from diorama_core.library.record import Shape
from diorama_core.scene.types import SceneObject
from tests.app.people import join
from tests.app.small_room import PlainLibrary, make_project


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Room]:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path / "libraries"))
    shelf = Shelf(PlainLibrary())
    lying = trimesh.creation.box((1.8, 0.6, 0.3))  # a bookcase that was read lying on its back
    shelf.own().add(packed_shape(Shape("my-case", "box", "my case", (1.0, 1.0, 1.0)), [lying], None, "key", ()))
    server = create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1"))
    made = Room(server, shelf, tmp_path / "projects")
    made.checker.look_at = lambda scene: None  # type: ignore[method-assign]  # its thread would post to the desk
    made.open_project(make_project(tmp_path / "projects" / "demo"))
    yield made
    made.close()
    stop_server(server)


@pytest.fixture
def guest(room: Room) -> Guest:
    guest = join(room)
    insert_shape(guest, "my-case")
    return guest


def inserted(room: Room) -> SceneObject:
    return room.scene.objects[-1]


def test_a_lying_model_is_stood_up_and_named(room: Room, guest: Guest) -> None:
    before = inserted(room)
    assert np.allclose(before.size_m, (1.8, 0.6, 0.3))
    correct_model(guest, before.id, FIXES["tip"])
    stood = inserted(room)
    assert stood.id == before.id
    assert np.allclose(stood.size_m, (0.3, 0.6, 1.8), atol=1e-6)
    assert stood.pose.position[2] - stood.size_m[2] / 2 == pytest.approx(0.0, abs=1e-6)
    correct_model(guest, before.id, category="bookcase")
    assert room.library.shape(inserted(room).shape_id).category == "bookshelf"
    assert is_own_model(room, inserted(room).shape_id)
    room.undo(guest)
    room.undo(guest)
    assert inserted(room) == before


def test_sizes_read_in_the_wrong_unit(room: Room, guest: Guest) -> None:
    correct_model(guest, inserted(room).id, FIXES["inches"])
    assert np.allclose(inserted(room).size_m, np.array((1.8, 0.6, 0.3)) * 2.54, atol=1e-5)


@pytest.mark.parametrize("name", sorted(FIXES.keys() - {"metres"}))
def test_every_fix_is_a_turn_or_a_size(room: Room, guest: Guest, name: str) -> None:
    correct_model(guest, inserted(room).id, FIXES[name])
    shape = room.library.shape(inserted(room).shape_id)
    assert sorted(shape.size_m) == pytest.approx(sorted(FIXES[name].scale * np.array((1.8, 0.6, 0.3))), rel=1e-4)


def test_absurd_sizes_are_refused_and_leave_nothing_behind(room: Room, guest: Guest) -> None:
    known = room.library.shapes()
    with pytest.raises(EditRefused, match="180 x 60 x 30 m"):
        correct_model(guest, inserted(room).id, FIXES["metres"])
    assert room.library.shapes() == known


def test_what_is_not_ones_own_or_not_known_is_refused(room: Room, guest: Guest) -> None:
    chair = room.scene.object("chair_1")
    assert not is_own_model(room, chair.shape_id)
    with pytest.raises(EditRefused, match="your own"):
        correct_model(guest, chair.id, FIXES["flip"])
    before = room.scene
    with pytest.raises(InputError):
        correct_model(guest, inserted(room).id, category="")
    assert room.scene == before
