from __future__ import annotations

import pytest

from diorama_app.panels.library import LibraryPanel
from diorama_app.session.client import Placing
from tests.app.page import Page


@pytest.fixture
def panel(page: Page, client) -> LibraryPanel:
    made = LibraryPanel(page, client)
    client.panels = [made]
    made.refresh()
    return made


def test_without_words_one_of_every_kind_is_shown(page, panel) -> None:
    for shape_id in ("chair_a", "table_a", "lamp_a", "picture_a"):
        assert page.shows("insert", shape_id)
    assert not page.shows("insert", "chair_b")


def test_words_find_shapes_and_nonsense_says_so(page, panel) -> None:
    page.write("Search", "chair")
    assert page.shows("insert", "chair_b")
    assert not page.shows("insert", "lamp_a")
    page.write("Search", "xyzzy <q>")
    assert "matches “xyzzy &lt;q&gt;”" in page.html


def test_insert_puts_it_in_the_room_and_place_waits_for_a_click(session, client, page, panel) -> None:
    count = len(session.scene.objects)
    page.act("insert", "chair_a")
    assert len(session.scene.objects) == count + 1
    assert session.scene.objects[-1].shape_id == "chair_a"
    page.act("place", "table_a")
    assert client.doing == Placing("table_a")
    assert len(session.scene.objects) == count + 1


def test_the_selected_object_is_offered_as_a_place(client, page, panel) -> None:
    client.select(["table_1"])
    assert "or on the selected dining table" in page.html
