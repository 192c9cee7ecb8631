"""Every browser has its own project, and its address says which."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import expect

from diorama_app.serve import Running
from diorama_core.scene import edits
from tests.app.small_room import PlainLibrary, furnished_scene, make_project
from tests.e2e.browser import QUERY, EditorPage

pytestmark = pytest.mark.browser

OBJECTS = (
    "Object.entries(window.__viserMutable.nodeRefFromName).filter(([n, o]) => o && /^.objects.[0-9]+$/.test(n)).length"
)


@pytest.fixture
def running(serve: Callable[..., Running], tmp_path: Path) -> Running:
    """A server that was started on one of two projects."""
    first = make_project(tmp_path / "projects" / "first")
    fewer = edits.remove(furnished_scene(), ("chair_2", "lamp_1"))
    make_project(tmp_path / "projects" / "second", fewer)
    return serve(first.folder, PlainLibrary())


def test_opening_a_project_leaves_the_other_browsers_where_they_are(
    running: Running, visit: Callable[[Running], EditorPage]
) -> None:
    editor, other = visit(running), visit(running)
    assert "project=first" in editor.page.url, "the address names the project that was given"
    editor.tab("Project")
    editor.page.locator(".dio .row", has_text="second").get_by_role("button", name="Open").click()
    expect(editor.page).to_have_url(re.compile("project=second"))
    editor.page.wait_for_function(f"window.__viserMutable && {OBJECTS} === 3")
    editor.settle()
    editor.tab("Project")
    expect(editor.page.get_by_label("Project name")).to_have_value("second", timeout=30_000)
    assert other.page.evaluate(OBJECTS) == 5
    assert "project=first" in other.page.url
    assert running.session.project is not None
    assert running.session.project.name == "first"


def test_a_link_leads_to_its_project_and_back_leads_back(
    running: Running, visit: Callable[[Running], EditorPage]
) -> None:
    editor = visit(running)
    editor.page.goto(f"http://127.0.0.1:{running.port}/{QUERY}&project=second")
    editor.page.wait_for_function(f"window.__viserMutable && {OBJECTS} === 3")
    second = running.workspace.editors[1].session
    second.ui_thread.post(lambda: second.edit("move out", lambda s: edits.remove(s, ("chair_1",))))
    editor.page.wait_for_function(f"{OBJECTS} === 2")
    editor.page.evaluate("window.__dioGoTo('first')")
    editor.page.wait_for_function(f"{OBJECTS} === 5")
    editor.page.go_back()
    editor.page.wait_for_function(f"{OBJECTS} === 2")
    editor.page.go_forward()
    editor.page.wait_for_function(f"{OBJECTS} === 5")


def test_a_link_to_no_project_says_so(running: Running, visit: Callable[[Running], EditorPage]) -> None:
    editor = visit(running)
    editor.page.goto(f"http://127.0.0.1:{running.port}/{QUERY}&project=..%2F..%2Fetc")
    editor.settle()
    editor.notice("There is no project called")
