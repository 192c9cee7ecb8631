"""A panel that cannot be drawn is one line in its place, and drawn again when it can be."""

from __future__ import annotations

from diorama_app.panels.in_place import InPlace
from diorama_core.errors import ProjectError
from tests.app.page import Page


class Moody:
    """A panel of which a redraw fails while there is a reason."""

    def __init__(self, page: Page) -> None:
        self.reason: Exception | None = None
        self.drawn = 0
        page.add_button("Press")

    def refresh(self) -> None:
        if self.reason is not None:
            raise self.reason
        self.drawn += 1


def test_a_line_stands_where_the_panel_was_until_it_can_be_drawn(page: Page) -> None:
    placed = InPlace(page, "The list", lambda: Moody(page))
    folder = next(handle for kind, _, handle in page.made if kind == "folder")
    placed.refresh()
    assert (placed.panel.drawn, page.html) == (1, "")
    assert folder.visible
    placed.panel.reason = RuntimeError("of no use to people")
    placed.refresh()
    assert "The list cannot be shown (RuntimeError). Your work is saved." in page.html
    assert not folder.visible
    placed.panel.reason = ProjectError("<b>photo.jpg</b> is damaged")
    placed.refresh()
    assert "&lt;b&gt;photo.jpg&lt;/b&gt; is damaged" in page.html
    placed.panel.reason = None
    placed.refresh()
    assert (placed.panel.drawn, page.html) == (2, "")
    assert folder.visible
