from __future__ import annotations

from diorama_app.panels.one_panel import OnePanel


def test_the_page_asks_once(client, page) -> None:
    asked: list[int] = []
    panel = OnePanel(page, client, lambda: asked.append(1))
    client.panels = [panel]
    panel.refresh()
    page.act("one panel")
    assert asked == [1]
    panel.refresh()
    assert not page.shows("one panel")
