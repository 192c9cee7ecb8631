from __future__ import annotations

import re

import pytest

from diorama_app.commands import edit as editing
from diorama_app.panels.toolbar import SPARE, Toolbar, title_bar
from tests.app.page import Page
from tests.app.people import join


@pytest.fixture
def toolbar(page: Page, client, commands) -> Toolbar:
    return page.put(Toolbar, commands)


def test_undo_and_redo_can_be_pressed_when_there_is_something(session, client, page, toolbar) -> None:
    assert not page.shows("run", "undo")
    client.select(["chair_1"])
    editing.delete_selected(client)
    assert "Undo: delete" in page.html
    page.act("run", "undo")
    assert session.scene.has_object("chair_1")
    page.act("run", "redo")
    assert not session.scene.has_object("chair_1")


def test_switches_show_their_state(client, page, toolbar) -> None:
    def is_on(command: str) -> bool:
        at = page.html.index(f'data-arg="{command}"')
        return re.search(r'class="[a-z ]*\bon"', page.html[page.html.rindex("<button", 0, at) : at]) is not None

    for name in ("snap", "slide", "names", "planes"):
        before = is_on(name)
        page.act("run", name)
        assert is_on(name) is not before
    page.act("run", "gizmo_size")
    assert client.preferences.gizmo == "size"
    assert (is_on("gizmo_size"), is_on("gizmo_floor")) == (True, False)


def test_what_needs_a_photo_is_greyed_out_without_one(session, client, page, toolbar) -> None:
    assert page.shows("run", "view_photo")
    session.document.open(type(session.scene)(objects=session.scene.objects))
    session.refresh()
    assert not page.shows("run", "view_photo")
    assert not page.shows("run", "masks")


def test_a_command_that_does_not_exist_is_ignored(session, page, toolbar) -> None:
    before = session.scene
    hidden = next(h for kind, label, h in page.made if label == "·")
    page.send(hidden, "run", "format_disk")
    assert session.scene is before


def test_the_title_says_what_is_open_and_who_is_here(session, client) -> None:
    assert "<b>demo</b>" in title_bar(client)
    assert "also has this project open" not in title_bar(client)
    other = join(session, 1)
    assert other.name in title_bar(client)


def test_every_tool_of_the_row_that_may_be_left_out_is_in_the_menu(page: Page, toolbar) -> None:
    menu = page.html[page.html.index('<div class="menu">') :]
    for command in (c for group in SPARE for c in group):
        assert page.html.count(f'data-arg="{command}"') == 2
        assert f'data-arg="{command}"' in menu
