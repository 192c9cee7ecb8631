from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_app.commands.insert import insert_shape
from diorama_app.panels.own_model import OwnModel
from diorama_core.library.ingest.shaping import packed_shape
from diorama_core.library.record import Assumption, Guess, Shape
from diorama_core.library.user_library import UserLibrary
from diorama_core.scene.types import SceneObject
from tests.app.page import Page
from tests.app.small_room import PlainLibrary

GUESS = Guess(
    Assumption("+y", 0.9, "usual"),
    Assumption("+x", 0.6, "unsure"),
    Assumption("0.01", 1.0, "said"),
    Assumption("box", 0.5, ""),
)


@pytest.fixture
def model(session, client, page: Page, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The id of an object made of a person's own model, a case that lies on its back."""
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path / "libraries"))
    library = UserLibrary(PlainLibrary())
    shape = Shape("my-case", "box", "my case", (1.0, 1.0, 1.0), guess=GUESS)
    library.own().add(packed_shape(shape, [trimesh.creation.box((1.8, 0.6, 0.3))], None, "key", ()))
    session.library = session.shapes._library = library
    client.panels = [OwnModel(page, client)]
    insert_shape(client, "my-case")
    return client.selection[-1]


def selected(client) -> SceneObject:
    return client.selected


def test_only_own_models_are_offered_for_correction(client, page: Page, model) -> None:
    page.settle()
    assert "Guessed: box; one unit is 0.01 m; 60 % sure which side is up" in page.html
    client.select(["chair_1"])
    page.settle()
    assert "Your model" not in page.html


def test_a_lying_model_is_stood_up_and_named(session, client, page: Page, model) -> None:
    page.act("fix", "tip")
    np.testing.assert_allclose(selected(client).size_m, (0.3, 0.6, 1.8), atol=1e-6)
    page.change("is", "bookcase")
    assert session.library.shape(selected(client).shape_id).category == "bookshelf"
    page.change("is", "flying saucer of the third kind")
    assert session.library.shape(selected(client).shape_id).category == "bookshelf"
    assert client.viser_client.told
