"""What the build is not sure of is asked, one question after another, by mouse and by keys."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from diorama_core.review.questions import questions
from tests.e2e.browser import EditorPage
from tests.review.doubtful_room import doubtful_scene

pytestmark = pytest.mark.browser


def test_a_doubtful_scene_is_reviewed_by_clicks_and_keys(editor: EditorPage) -> None:
    session, page = editor.session, editor.page
    session.ui_thread.ask(lambda: session.commit("doubt", doubtful_scene()))
    editor.settle()
    card = page.locator(".job.card", has_text="sure")
    expect(card).to_contain_text("would resolve most doubts")
    card.get_by_role("button", name="Review").click()
    asked = page.locator(".review")
    left = len(questions(session.scene))
    expect(asked).to_contain_text(f"{left} questions left")
    first = questions(session.scene)[0]
    expect(asked).to_contain_text(first.sentence)
    page.keyboard.press("1")
    expect(asked).to_contain_text(f"{left - 1} questions left")
    assert first.id not in {q.id for q in questions(session.scene)}
    second = questions(session.scene)[0]
    asked.get_by_role("button", name="Later").click()
    expect(asked).not_to_contain_text(second.sentence)
    asked.locator("[data-digit]").first.click()
    expect(asked).to_contain_text(f"{left - 3} questions left")  # one was answered, one put off
    page.keyboard.press("Control+z")
    editor.settle()
    assert len(questions(session.scene)) == left - 1
    asked.get_by_role("button", name="Close").click()
    expect(page.locator(".job.card", has_text="sure")).to_be_visible()
