from __future__ import annotations

import html

from diorama_app.panels.page import STORED_AS, Address, PanelLayout, Tabs
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


def test_the_page_is_told_its_tabs(page: Page) -> None:
    Tabs(page, ("Scene", "Photo", "Object"))
    script = html.unescape(page.html)
    assert '["Scene", "Photo", "Object"]' in script
    assert f'"{STORED_AS}"' in script


def test_asking_for_the_same_tab_again_runs_again(page: Page) -> None:
    tabs = Tabs(page, ("Scene", 'It\'s "quoted"'))
    seen = []
    for _ in range(2):
        tabs.open('It\'s "quoted"')
        seen.append(html.unescape(page.made[-1][2].content))
    assert seen[0] != seen[1]
    assert all(r'window.__dioOpenTab("It' in s and r"\"quoted\"" in s for s in seen)


def test_the_page_asks_once(client, page) -> None:
    asked: list[int] = []
    widened: list[int] = []
    panel = page.put(PanelLayout, lambda: asked.append(1), lambda: widened.append(1))
    page.act("two panels")
    assert not page.shows("two panels")
    page.act("one panel")
    assert (asked, widened) == ([1], [1])
    panel.refresh()
    assert not page.shows("one panel")
