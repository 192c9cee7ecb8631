"""The panel of an object says in plain words what decided most when the scene was built."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from diorama_core.artefacts import Reason
from diorama_core.project.reasons import save_reasons
from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser

REASONS = (
    Reason("chair_1", "kind", "word", 6.9, "nats", "named “chair” by you"),
    Reason("chair_1", "front", "at table", 2.1, "nats", "seats face what they serve"),
    Reason("chair_1", "place", "layout", 3.0, "cm", "it rests on something, clear of the others"),
)


def test_the_two_strongest_reasons_of_an_object_are_told(editor: EditorPage) -> None:
    session = editor.session
    assert session.project is not None
    save_reasons(session.project, REASONS)
    project = session.project
    session.ui_thread.post(lambda: session.open_project(project))
    assert session.ui_thread.wait()
    editor.settle()
    why = editor.page.locator(".why li")
    editor.row("dining table").click()
    expect(editor.page.get_by_label("Size: Width")).to_be_visible()
    expect(why).to_have_count(0)
    chair = next(item for item in session.scene.objects if item.id == "chair_1")
    editor.row(chair.label).click()
    expect(why).to_have_text(["Kind: named “chair” by you (6.9)", "Front: seats face what they serve (2.1)"])
    why.first.scroll_into_view_if_needed()
