"""What was guessed about a model of one's own is put right."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_app.commands.import_model import FIXES, correct_model, is_own_model
from diorama_app.commands.insert import insert_shape
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.errors import EditRefused, InputError
from diorama_core.library.ingest.shaping import pack_shape
from diorama_core.library.record import Shape
from diorama_core.library.user_library import UserLibrary
from diorama_core.scene.types import SceneObject
from tests.app.people import join
from tests.app.small_room import PlainLibrary


@pytest.fixture
def session_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> UserLibrary:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path / "libraries"))
    user_library = UserLibrary(PlainLibrary())
    lying = trimesh.creation.box((1.8, 0.6, 0.3))  # a bookcase that was read lying on its back
    user_library.own().add(pack_shape(Shape("my-case", "box", "my case", (1.0, 1.0, 1.0)), [lying], None, "key", ()))
    return user_library


@pytest.fixture
def client(session: EditorSession) -> Client:
    client = join(session)
    insert_shape(client, "my-case")
    return client


def inserted(session: EditorSession) -> SceneObject:
    return session.scene.objects[-1]


def test_a_lying_model_is_stood_up_and_named(session: EditorSession, client: Client) -> None:
    before = inserted(session)
    assert np.allclose(before.size_m, (1.8, 0.6, 0.3))
    correct_model(client, before.id, FIXES["tip"])
    stood = inserted(session)
    assert stood.id == before.id
    assert np.allclose(stood.size_m, (0.3, 0.6, 1.8), atol=1e-6)
    assert stood.pose.position[2] - stood.size_m[2] / 2 == pytest.approx(0.0, abs=1e-6)
    correct_model(client, before.id, category="bookcase")
    assert session.library.shape(inserted(session).shape_id).category == "bookshelf"
    assert is_own_model(session, inserted(session).shape_id)
    session.undo(client)
    session.undo(client)
    assert inserted(session) == before


def test_sizes_read_in_the_wrong_unit(session: EditorSession, client: Client) -> None:
    correct_model(client, inserted(session).id, FIXES["inches"])
    assert np.allclose(inserted(session).size_m, np.array((1.8, 0.6, 0.3)) * 2.54, atol=1e-5)


@pytest.mark.parametrize("name", sorted(FIXES.keys() - {"metres"}))
def test_every_fix_is_a_turn_or_a_size(session: EditorSession, client: Client, name: str) -> None:
    correct_model(client, inserted(session).id, FIXES[name])
    shape = session.library.shape(inserted(session).shape_id)
    assert sorted(shape.size_m) == pytest.approx(sorted(FIXES[name].scale * np.array((1.8, 0.6, 0.3))), rel=1e-4)


def test_absurd_sizes_are_refused_and_leave_nothing_behind(session: EditorSession, client: Client) -> None:
    known = session.library.shapes()
    with pytest.raises(EditRefused, match="180 x 60 x 30 m"):
        correct_model(client, inserted(session).id, FIXES["metres"])
    assert session.library.shapes() == known


def test_what_is_not_ones_own_or_not_known_is_refused(session: EditorSession, client: Client) -> None:
    chair = session.scene.object("chair_1")
    assert not is_own_model(session, chair.shape_id)
    with pytest.raises(EditRefused, match="you uploaded"):
        correct_model(client, chair.id, FIXES["flip"])
    before = session.scene
    with pytest.raises(InputError):
        correct_model(client, inserted(session).id, category="")
    assert session.scene == before
