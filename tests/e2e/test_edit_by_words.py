"""Edits in words: typed, looked at, made as one undo step or dropped; what cannot be done is said."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from diorama_app.commands.edit_by_words import LABEL_CHARS
from diorama_app.panels.edit_by_words import EXAMPLE
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture

pytestmark = pytest.mark.browser


@pytest.fixture(autouse=True)
def _no_model(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DIORAMA_LMM_BASE_URL", raising=False)


def _say(editor: EditorPage, words: str) -> None:
    field = editor.page.get_by_label("Edit by words")
    field.fill(words)
    field.press("Enter")


def test_edits_are_shown_then_made_and_undone_at_once(editor: EditorPage) -> None:
    expect(editor.page.get_by_placeholder(EXAMPLE)).to_be_visible()
    before = editor.session.scene
    chairs = [o.id for o in before.objects if o.category == "chair"]
    assert chairs
    _say(editor, "make all chairs red and turn the chairs around")
    listed = editor.page.get_by_role("list", name="Proposed edits")
    expect(listed.get_by_role("listitem")).to_have_count(2)
    assert editor.session.scene is before
    editor.button("Apply").click()
    editor.until(lambda: editor.session.scene is not before, "made")
    assert len(editor.session.document.history.current.label) <= LABEL_CHARS + 1
    assert all(editor.session.scene.object(i).colour is not None for i in chairs)
    expect(listed).to_be_hidden()
    editor.page.keyboard.press("Escape")
    editor.button("Undo").first.click()
    editor.until(lambda: editor.session.scene == before, "one undo takes all back")


def test_proposed_edits_can_be_dropped(editor: EditorPage) -> None:
    before = editor.session.scene
    _say(editor, "remove the table and put a chair in the corner")
    expect(editor.page.get_by_role("list", name="Proposed edits").get_by_role("listitem")).to_have_count(2)
    keep_picture(editor, "proposed-edits")
    editor.button("Cancel").click()
    expect(editor.page.get_by_role("list", name="Proposed edits")).to_be_hidden()
    assert editor.session.scene is before


def test_what_cannot_be_done_is_said_in_a_line(editor: EditorPage) -> None:
    before = editor.session.scene
    _say(editor, "remove the chairs and paint the piano green")
    expect(editor.page.get_by_text("There is no piano in this scene; it has:")).to_be_visible()
    assert editor.session.scene is before


@pytest.mark.parametrize(
    "said", ["Mach alle Stühle rot", "Pinta todas las sillas de rojo", "Peins toutes les chaises en rouge"]
)
def test_other_languages_are_understood(editor: EditorPage, said: str) -> None:
    _say(editor, said)
    listed = editor.page.get_by_role("list", name="Proposed edits")
    expect(listed.get_by_role("listitem")).to_have_count(1)
    expect(listed).to_contain_text("red")
    editor.button("Cancel").click()
