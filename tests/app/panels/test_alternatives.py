from __future__ import annotations

import numpy as np
import pytest

from diorama_app.commands import edit as editing
from diorama_app.commands.insert import insert_shape
from diorama_app.panels.alternatives import Alternatives, shape_caption
from tests.app.page import Page


@pytest.fixture
def panel(page: Page, client) -> Alternatives:
    return page.put(Alternatives)


def test_nothing_is_offered_for_nothing(page, panel) -> None:
    assert not page.field("Swap for").visible
    assert "Alternatives" not in page.html


def test_its_own_alternatives_swap_by_a_click(session, client, page, panel) -> None:
    client.select(["chair_1"])
    assert page.shows("swap", "chair_b")
    assert "in use" in page.html
    page.act("swap", "chair_b")
    assert session.scene.object("chair_1").shape_id == "chair_b"
    session.undo(client)
    assert session.scene.object("chair_1").shape_id == "chair_a"


def test_what_was_inserted_by_hand_has_alternatives_of_its_kind(session, client, page, panel) -> None:
    insert_shape(client, "chair_a")
    session.ui_thread.wait()
    (inserted,) = client.selection
    assert session.scene.object(inserted).candidates == ()
    for shape in ("chair_b", "chair_c"):
        assert page.shows("swap", shape)
    assert not page.shows("swap", "table_a")
    page.act("swap", "chair_c")
    assert session.scene.object(inserted).shape_id == "chair_c"


def test_words_search_the_whole_library_and_another_object_starts_anew(client, page, panel) -> None:
    client.select(["chair_1"])
    page.write("Swap for", "lamp")
    assert page.shows("swap", "lamp_a")
    page.write("Swap for", "xyzzy")
    assert "Try another word" in page.html
    client.select(["chair_2"])
    assert page.field("Swap for").value == ""
    assert page.shows("swap", "chair_a")


def test_pointing_shows_a_shape_without_taking_it(session, client, page, panel) -> None:
    client.select(["chair_1"])
    before, mesh = session.scene, session.viewport.mesh_name("chair_1")
    page.act("peek", "chair_c", kind="peek")
    assert session.scene is before
    assert session.viewport.mesh_name("chair_1") != mesh
    page.act("peek", "", kind="peek")
    assert session.scene is before


def test_how_size_and_colour_are_taken_is_remembered(session, client, page, panel) -> None:
    client.select(["chair_1"])
    editing.set_colour(client, ["chair_1"], (1.0, 0.0, 0.0))
    before = session.scene.object("chair_1").size_m
    page.act("size", "same box")
    if not client.preferences.keep_colour:
        page.act("keep")
    page.act("swap", "chair_c")
    after = session.scene.object("chair_1")
    np.testing.assert_allclose(after.size_m, before)
    assert after.colour == (1.0, 0.0, 0.0)
    page.act("size", "catalogue")
    page.act("swap", "chair_b")
    np.testing.assert_allclose(session.scene.object("chair_1").size_m, session.library.shape("chair_b").size_m)


def test_all_alike_are_swapped_together(session, client, page, panel) -> None:
    client.select(["chair_2"])
    page.act("swap", "chair_a")
    page.act("alike")
    page.act("swap", "chair_c")
    assert {session.scene.object(i).shape_id for i in ("chair_1", "chair_2")} == {"chair_c"}


def test_a_shape_without_a_record_is_called_missing(session) -> None:
    assert shape_caption(session, "chair_a") == "chair a"
    assert shape_caption(session, "gone") == "missing shape"
