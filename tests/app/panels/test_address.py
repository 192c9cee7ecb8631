from __future__ import annotations

from diorama_app.panels.address import Address
from tests.app.page import Page


def test_the_page_is_sent_on_even_twice_to_the_same_project(page: Page) -> None:
    address = Address(page)
    address.go_to("living-room")
    first = page.html
    assert "window.__dioGoTo(&quot;living-room&quot;)" in first
    address.go_to("living-room")
    assert page.html != first, "the page runs it again"


def test_names_cannot_leave_their_quotes(page: Page) -> None:
    Address(page).go_to('a"); alert("')
    assert '"); alert(' not in page.html
