from __future__ import annotations

import pytest

from diorama_app.panels.library import LibraryPanel
from diorama_app.session.client import Placing
from diorama_core.scene.room_edits import move_plane
from tests.app.page import Page
from tests.waiting import until


@pytest.fixture
def panel(page: Page, client) -> LibraryPanel:
    return page.put(LibraryPanel)


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
    assert "or a small one on the selected dining table" in page.html


def test_filters_and_shelves_narrow_what_is_shown(client, page, panel) -> None:
    page.change("category", "chair")
    assert page.shows("insert", "chair_b")
    assert not page.shows("insert", "table_a")
    page.change("size", "large")
    assert "Nothing in the library passes these filters" in page.html
    page.change("size", "")
    page.change("category", "")
    page.act("shelf", "favourites")
    assert "No favourites yet" in page.html
    page.act("shelf", "all")
    page.act("favourite", "lamp_a")
    page.act("shelf", "favourites")
    assert page.shows("insert", "lamp_a")
    assert not page.shows("insert", "chair_a")
    page.act("favourite", "lamp_a")
    assert not page.shows("insert", "lamp_a")


def test_what_was_inserted_is_recent_the_last_first(session, client, page, panel) -> None:
    page.act("insert", "chair_a")
    page.act("insert", "table_a")
    assert client.preferences.recent == ("table_a", "chair_a")
    page.act("shelf", "recent")
    assert page.html.index('data-arg="table_a"') < page.html.index('data-arg="chair_a"')


def test_what_is_too_large_for_the_room_says_so_and_is_left_out_on_request(session, client, page, panel) -> None:
    page.write("Search", "table")
    assert "too large" not in page.html
    session.edit("narrower", lambda s: move_plane(move_plane(s, "wall_1", 0.0), "wall_2", -3.6), by=client)
    client.refresh()
    until(lambda: "too large" in page.html)  # the edit has the panel drawn by another thread, too
    page.act("fitting")
    assert not page.shows("insert", "table_b")
