"""Messages, dialogs and questions over the page."""

from __future__ import annotations

import pytest

from diorama_app.commands import edit as editing
from diorama_app.panels.messages import Toasts, ask_depth, ask_which, dialog
from diorama_app.projects.dropped import Dropped, Reading
from diorama_app.session.client import Client, Measuring, Placing
from diorama_core.perception.inputs.depth.scale import AmbiguousDepthError, DepthAnswer
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
    monkeypatch.setattr("diorama_app.panels.messages.SHOWN_S", 0.01)
    toasts.say("Reading huge.jpg…", False)
    until(lambda: "Reading huge.jpg" not in page.html, "a page that is drawn anew does not show it")


def test_an_offer_is_not_replaced_by_the_line_of_its_own_step(client, page) -> None:
    client.panels = [Toasts(page, client)]
    client.to_say = ("delete table", True)
    client.offer("what stood on it is lower now", "Delete it too", lambda: None)
    client.refresh()
    assert "what stood on it is lower now" in page.html


def test_one_dialog_at_a_time(client: Client, page: Page) -> None:
    client.viser_client.gui = page
    with dialog(client, "First") as close_first:
        assert client.dialog is close_first
    with dialog(client, "Second") as close_second:
        page.add_button("Inside")
    assert client.dialog is close_second
    first, second = (handle for kind, _, handle in page.made if kind == "modal")
    modals = page.gui._modal_handle_from_uuid
    assert first._uuid not in modals
    assert second._uuid in modals
    client.dialog()
    assert client.dialog is None
    assert second._uuid not in modals


def test_what_a_file_is(client: Client, page: Page) -> None:
    client.viser_client.gui = page
    found, taken = (Reading("photo", "a photo"), Reading("inputs", "a depth map")), []
    ask_which(client, "a.zip", Dropped(found, ("notes.txt",)), taken.append)
    assert "<p>Left out: notes.txt.</p>" in page.html
    assert ("modal", "What is a.zip?") in {made[:2] for made in page.made}
    page.press("A depth map")
    assert taken == [found[1]]
    assert client.dialog is None


def test_which_unit(client: Client, page: Page) -> None:
    client.viser_client.gui = page
    choices, taken = (DepthAnswer("1/5000 m", 5000.0), DepthAnswer("1/4000 m", 4000.0)), []
    ask_depth(client, AmbiguousDepthError("d.png: things have 4.5 times their size; give", choices), taken.append)
    assert "4.5 times" in page.html
    page.press("1/4000 m")
    assert taken == [choices[1]]
    with pytest.raises(AmbiguousDepthError):
        ask_depth(client, AmbiguousDepthError("x"), taken.append)
