from __future__ import annotations

import pytest

from diorama_app.panels.edit_by_words import EditByWords
from tests.app.page import Page
from tests.waiting import until


@pytest.fixture
def panel(page: Page, client) -> EditByWords:
    return page.put(EditByWords)


def test_a_command_shows_its_edits_and_applies_them(session, page, panel) -> None:
    count = len(session.scene.objects)
    page.change("ask", "remove the chair")
    until(lambda: "Proposed edits" in page.html)
    assert "Apply" in page.html
    assert len(session.scene.objects) == count
    page.act("apply")
    until(lambda: len(session.scene.objects) < count)
    assert "Proposed edits" not in page.html


def test_a_refusal_is_a_line_that_screen_readers_announce(page, panel) -> None:
    page.change("ask", "remove the piano")
    until(lambda: 'role="alert"' in page.html)
    assert "piano" in page.html
