"""A walk through the room in the editor: keys walk and are no commands, Esc leads back to where one looked from."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import expect
from shapely.geometry import Point, Polygon

from diorama_core.editing.footprints import footprint_of
from diorama_core.editing.walking import RADIUS_M
from tests.e2e.browser import EditorPage
from tests.e2e.test_html_viewer import EYE, TRACED

pytestmark = pytest.mark.browser


def test_one_walks_by_keys_past_furniture_and_comes_back(editor: EditorPage) -> None:
    page, scene = editor.page, editor.session.scene
    page.keyboard.press("r")
    editor.settle()
    before = editor.still(lambda: page.evaluate(EYE))
    editor.menu_tool("Walk").click()
    page.wait_for_function("!!window.__dioWalk.place()")
    page.evaluate(f"({TRACED})()")
    for keys in ("w", "wd", "s", "a", "q", "w", "e", "d"):
        for key in keys:
            page.keyboard.down(key)
        page.wait_for_timeout(900)
        for key in keys:
            page.keyboard.up(key)
    page.keyboard.press("Delete")
    trace = np.array(page.evaluate("window.__trace"))
    np.testing.assert_allclose(page.evaluate(EYE)[:2], trace[-1], atol=0.02)
    page.keyboard.press("Escape")
    expect(page.locator("#dio-walk")).to_have_count(0)
    editor.until(lambda: np.allclose(page.evaluate(EYE), before, atol=0.05), "back where one looked from")
    assert editor.session.scene is scene, "no key was a command"
    outline = Polygon(scene.architecture.by_role("floor")[0].polygon[:, :2])
    stands = [Polygon(footprint_of(o)) for o in scene.objects if o.category in ("table", "chair")]
    assert np.linalg.norm(np.diff(trace, axis=0), axis=1).sum() > 1.0, "a metre and more"
    for x, y in trace:
        assert outline.contains(Point(x, y))
        assert min(Point(x, y).distance(g) for g in (outline.exterior, *stands)) > RADIUS_M - 0.011
    page.keyboard.press("Control+a")
    editor.until(lambda: len(editor.selection) == len(scene.objects), "keys are commands again")
