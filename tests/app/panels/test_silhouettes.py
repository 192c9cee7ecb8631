from __future__ import annotations

from diorama_app.panels.silhouettes import Silhouettes
from tests.app.page import Page


def test_the_page_is_told_outlines_and_names(session, client, page: Page) -> None:
    panel = Silhouettes(page, client)
    client.panels = [panel]
    client.select(("lamp_1",))
    session.ui_thread.wait()
    node = session.viewport.node_name("lamp_1")
    assert f"[[&quot;{node}&quot;,&quot;#ff7a1a&quot;,3.5]]" in page.html
    assert f"&quot;{node}&quot;:&quot;lamp&quot;" in page.html
    told = page.html
    panel.refresh()
    assert page.html == told
    client.select(())
    session.ui_thread.wait()
    assert "&quot;lines&quot;:[]" in page.html
