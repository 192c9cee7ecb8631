from __future__ import annotations

import pytest

from diorama_app.commands import edit as editing
from diorama_app.panels.toast import Toasts
from diorama_app.session.client import Measuring, Placing
from tests.app.page import Page
from tests.waiting import until


@pytest.fixture
def toasts(page: Page, client) -> Toasts:
    return Toasts(page, client)


def test_an_edit_is_said_with_a_button_that_takes_it_back(session, client, page, toasts) -> None:
    client.select(["chair_1"])
    editing.rename(client, "chair_1", "<i>throne</i>")
    editing.set_locked(client, ["chair_1"], True)
    assert "&lt;i&gt;throne" in page.html
    assert "<i>throne" not in page.html
    editing.set_locked(client, ["chair_1"], False)
    before = session.scene
    editing.delete_selected(client)
    page.act("undo")
    assert session.scene == before


def test_what_a_click_does_is_said_until_it_is_stopped(session, client, page, toasts) -> None:
    for doing, words in (
        (Placing("chair_a"), "Click where to place it"),
        (Measuring(), "Click the first point"),
        (Measuring(((0.0, 0.0, 0.0),)), "Click the second point"),
    ):
        client.doing = doing
        toasts.refresh()
        assert words in page.html
        page.act("stop")
        assert client.doing is None
        toasts.refresh()
        assert words not in page.html


def test_a_message_ends_on_the_server_too(client, page, toasts, monkeypatch) -> None:
    monkeypatch.setattr("diorama_app.panels.toast.SHOWN_S", 0.01)
    toasts.say("Reading huge.jpg…", False)
    until(lambda: "Reading huge.jpg" not in page.html, "a page that is drawn anew does not show it")


def test_an_offer_is_not_replaced_by_the_line_of_its_own_step(client, page) -> None:
    client.panels = [Toasts(page, client)]
    client.to_say = ("delete table", True)
    client.offer("what stood on it is lower now", "Delete it too", lambda: None)
    client.refresh()
    assert "what stood on it is lower now" in page.html
