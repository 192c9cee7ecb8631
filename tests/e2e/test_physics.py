"""Mass, friction, joints and colliders, for those who want them."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture

pytestmark = pytest.mark.browser

COLLIDERS = "!!window.__viserMutable.nodeRefFromName['/colliders']"


def test_physics_are_unfolded_and_the_colliders_seen(editor: EditorPage) -> None:
    page = editor.page
    editor.row("dining table").click()
    fold = page.get_by_role("button", name="Physics")
    expect(fold).to_have_attribute("aria-expanded", "false")
    fold.click()
    expect(page.get_by_role("cell", name="Mass")).to_be_visible()
    expect(page.get_by_role("cell", name="5 convex parts")).to_be_visible()
    page.wait_for_function(COLLIDERS)
    fold.scroll_into_view_if_needed()
    keep_picture(editor, "physics")
    fold.click()
    page.wait_for_function(f"!({COLLIDERS})")
    expect(page.get_by_role("cell", name="Mass")).to_have_count(0)
