"""Point 11: who comes back, or finds the server started anew, finds things as they were left."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import expect

from tests.app.small_room import PlainLibrary, make_project
from tests.ports import lasting_port

pytestmark = pytest.mark.browser

CACHE_SIZE = "Object.values(localStorage).some((text) => text.includes('paper'))"
DARK = "document.documentElement.dataset.mantineColorScheme == 'dark'"


def test_theme_unit_snap_recipe_and_open_tabs_outlive_a_reload_and_another_start(serve, visit, tmp_path: Path) -> None:
    folder = make_project(tmp_path / "projects" / "demo").folder
    port = lasting_port()
    first = serve(folder, PlainLibrary(), port=port)
    page = visit(first)
    page.menu_tool("Dark or light").click()
    page.page.keyboard.press("Escape")
    page.tool("Snap").click()
    page.row("lamp").click()
    page.numbers()
    page.page.get_by_label("Unit").select_option("ft-in")
    page.tab("Arrange")
    page.page.get_by_label("Recipe").click()
    page.page.get_by_role("option", name="As in the paper", exact=True).click()
    page.until(lambda: page.client.preferences.recipe == "paper")
    page.page.wait_for_function(CACHE_SIZE)
    chosen = page.client.preferences
    assert (chosen.dark, chosen.snap, chosen.unit) == (True, True, "ft-in")

    page.load()
    page.until(lambda: page.client.preferences == chosen, "a reload")
    page.page.wait_for_function(DARK)
    expect(page.page.get_by_label("Recipe")).to_have_value("As in the paper")
    expect(page.page.get_by_role("tab", name="Arrange", exact=True)).to_have_attribute("aria-selected", "true")

    first.stop()
    page.page.goto("about:blank")
    again = serve(folder, PlainLibrary(), port=port)
    page.running = again
    page.load()
    page.until(lambda: page.client.preferences == chosen, "another start")
    page.page.wait_for_function(DARK)
    expect(page.tool("Snap")).to_have_class("spare on")
    page.tab("Scene")
    page.row("lamp").click()
    expect(page.page.get_by_label("Size: Width")).to_have_value('9 7/16"')
