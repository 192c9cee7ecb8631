"""The catalogue: filters, favourites that outlive a reload, recent ones, and a ghost of what is placed."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import Locator, expect

from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture
from tests.e2e.test_handles_and_supports import at_rest

pytestmark = pytest.mark.browser


def test_a_category_is_chosen_a_favourite_marked_and_found_after_a_reload(editor: EditorPage) -> None:
    page = editor.page
    editor.tab("Library")
    page.get_by_label("Category").select_option("chair")
    expect(page.locator(".dio .tile:visible")).to_have_count(3)
    star = page.get_by_role("button", name="Favourite: chair b")
    star.click()
    expect(star).to_have_text("★")  # what is shown has been stored by the page
    assert editor.client.preferences.favourites == ("chair_b",)
    page.reload()
    page.wait_for_selector("#dio-toolbar")
    editor.settle()
    editor.until(lambda: editor.client.preferences.favourites == ("chair_b",), "kept in the browser")
    editor.tab("Library")
    page.locator(".dio [data-do=shelf][data-arg=favourites]").click()
    expect(page.locator(".dio .tile:visible")).to_have_count(1)
    star.click()
    expect(page.get_by_text("No favourites yet")).to_be_visible()
    page.locator(".dio [data-do=shelf][data-arg=all]").click()


def test_a_ghost_follows_the_pointer_and_the_click_puts_it_there(editor: EditorPage) -> None:
    page = editor.page
    page.keyboard.press("t")
    spot = np.array([-1.4, 0.4, 0.0])
    at_rest(editor, spot)
    editor.tab("Library")
    page.locator('.dio .tile [data-do=place][data-arg="table_a"]').click()
    editor.until(lambda: editor.client.doing is not None)
    page.wait_for_function("!!window.__viserMutable.nodeRefFromName['/ghost']")
    editor.settle()
    page.mouse.move(*editor.place_of(spot + np.array([0.5, 0.0, 0.0])))
    page.mouse.move(*editor.place_of(spot))
    page.wait_for_function("!!window.__dioGhostAt")
    shown = editor.still(lambda: page.evaluate("window.__viserMutable.nodeRefFromName['/ghost'].position.toArray()"))
    np.testing.assert_allclose(shown, spot + np.array([0.0, 0.0, 0.37]), atol=0.05)
    turn = page.evaluate("window.__viserMutable.nodeRefFromName['/ghost'].quaternion.toArray()")
    count = len(editor.session.scene.objects)
    page.mouse.click(*editor.place_of(spot))
    editor.until(lambda: len(editor.session.scene.objects) == count + 1, "put there")
    placed = editor.session.scene.objects[-1]
    np.testing.assert_allclose(placed.pose.position, shown, atol=0.02)
    assert 2 * np.arctan2(turn[2], turn[3]) == pytest.approx(placed.pose.yaw_rad, abs=0.01)
    page.wait_for_function("!window.__viserMutable.nodeRefFromName['/ghost']")
    assert editor.client.preferences.recent[0] == "table_a"


def test_a_tile_is_dragged_into_the_view_and_let_go_elsewhere_places_nothing(editor: EditorPage) -> None:
    page, count = editor.page, len(editor.session.scene.objects)
    page.keyboard.press("t")
    spot = np.array([-1.4, 0.4, 0.0])
    at_rest(editor, spot)
    editor.tab("Library")
    tile = page.locator('.dio .tile[data-grab="table_a"]')
    tile.hover()
    editor.pull(_middle(tile), editor.place_of(spot + np.array([0.3, 0.0, 0.0])))
    editor.until(lambda: editor.client.doing is not None, "it is held")
    page.wait_for_function("!!window.__viserMutable.nodeRefFromName['/ghost']")
    page.mouse.move(*editor.place_of(spot))
    page.wait_for_function("!!window.__dioGhostAt")
    keep_picture(editor, "dragged_from_the_catalogue")
    page.mouse.up()
    editor.until(lambda: len(editor.session.scene.objects) == count + 1, "put there")
    np.testing.assert_allclose(editor.session.scene.objects[-1].pose.position[:2], spot[:2], atol=0.05)
    assert editor.client.doing is None
    editor.pull(_middle(tile), _middle(page.get_by_role("tab", name="Scene")))
    editor.until(lambda: editor.client.doing is not None, "held again")
    page.mouse.up()
    editor.until(lambda: editor.client.doing is None, "let go")
    assert len(editor.session.scene.objects) == count + 1


def _middle(element: Locator) -> tuple[float, float]:
    box = element.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 3
