"""The shelf of a person's own models."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_app.commands.insert import insert_shape
from diorama_app.panels.library import LibraryPanel
from diorama_app.panels.own_models import OwnModel, OwnShelf
from diorama_app.web.html import Action
from diorama_core.library.ingest.shaping import pack_shape
from diorama_core.library.record import Assumption, Guess, Shape
from diorama_core.library.user_library import UserLibrary
from diorama_core.scene.types import SceneObject
from tests.app.page import Page
from tests.app.small_room import PlainLibrary


@pytest.fixture
def library(session, client, page: Page, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> UserLibrary:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path / "libraries"))
    made = UserLibrary(PlainLibrary())
    for name in ("case", "vase"):
        shape = Shape(f"my-{name}", "box", name, (1.0, 1.0, 1.0))
        made.own().add(pack_shape(shape, [trimesh.creation.box((0.3, 0.6, 0.3))], None, name, ()))
    session.library = session.shapes._library = made
    page.put(LibraryPanel)
    page.act("shelf", "own")
    return made


def test_models_have_the_names_and_folders_that_people_give(library: UserLibrary, page: Page) -> None:
    page.change("model-name", "Grandma's case", "my-case")
    page.change("model-folder", "Heirlooms", "my-case")
    assert "<h4>Heirlooms</h4>" in page.html
    assert library.own_models.names["my-case"] == "Grandma's case"
    assert page.html.index("my-vase") < page.html.index("Heirlooms") < page.html.index("my-case")


def test_a_deleted_model_is_gone_until_it_is_restored(session, library: UserLibrary, page: Page) -> None:
    page.act("model-delete", "my-case")
    assert not page.shows("insert", "my-case")
    assert page.shows("insert", "my-vase")
    assert session.library.shape("my-case"), "scenes that hold it open as before"
    page.act("model-restore", "my-case")
    assert page.shows("insert", "my-case")


def test_a_model_deleted_is_restored_by_the_toast(client, library: UserLibrary, page: Page) -> None:
    offered = []
    client.offer = lambda message, label, do: offered.append((message, label, do))
    page.act("model-delete", "my-case")
    message, label, do = offered[0]
    assert (message, label) == ("case is deleted.", "Undo")
    do()
    assert library.own_models.deleted == ()


def test_rooms_are_built_of_them_only_where_asked(session, library: UserLibrary, page: Page) -> None:
    assert "my-case" not in {s.id for s in session.offer.shapes()}
    page.act("switch", "in builds")
    assert "my-case" in {s.id for s in session.offer.shapes()}


def test_only_own_models_are_renamed_or_deleted(client, library: UserLibrary) -> None:
    shelf = OwnShelf(client)
    for action in (Action("model-delete", "chair_a", False), Action("model-name", '["chair_a", "Mine"]', False)):
        assert not shelf.do(action)
    assert library.own_models.deleted == ()
    assert library.own_models.names == {}


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
    library.own().add(pack_shape(shape, [trimesh.creation.box((1.8, 0.6, 0.3))], None, "key", ()))
    session.library = session.shapes._library = library
    client.panels = [OwnModel(page, client)]
    insert_shape(client, "my-case")
    return client.selection[-1]


def selected(client) -> SceneObject:
    return client.last_selected


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
