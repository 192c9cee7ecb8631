"""How the page draws where WebGL has no graphics card, as here: sparingly."""

from __future__ import annotations

import pytest

from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser

FRAMES_AFTER_A_REQUEST = """() => new Promise((done) => {
    const render = window.__viserTestpoints.rendererInfo.render, before = render.frame;
    window.__viserMutable.requestRender();
    setTimeout(() => done(render.frame - before), 600);
})"""


PIXELS = "window.__viserMutable.canvas.width / window.__viserMutable.canvas.clientWidth"
FRAME = "window.__viserTestpoints.rendererInfo.render.frame"


def test_software_webgl_draws_few_frames_without_smoothing(editor: EditorPage) -> None:
    renderer = "window.__viserMutable.scene.__r3f.root.getState().gl.getContext()"
    assert editor.page.evaluate(f"{renderer}.getContextAttributes().antialias") is False
    editor.settle()
    editor.page.wait_for_timeout(700)
    # One for the request, one when all is quiet, perhaps one of the heartbeat; viser's own pace is sixty a second.
    frames = editor.page.evaluate(FRAMES_AFTER_A_REQUEST)
    assert 1 <= frames <= 3


def test_a_page_at_rest_draws_nothing(editor: EditorPage) -> None:
    editor.settle()
    editor.page.wait_for_timeout(1000)
    before = editor.page.evaluate(FRAME)
    editor.page.wait_for_timeout(2500)
    assert editor.page.evaluate(FRAME) - before <= 1  # every ten seconds one, lest something was forgotten


def test_what_moves_is_drawn_with_fewer_pixels_until_it_rests(editor: EditorPage) -> None:
    page = EditorPage.open(editor.page.context, editor.running, query="")
    try:
        page.page.wait_for_timeout(1000)
        sharp = page.page.evaluate(PIXELS)
        page.page.evaluate("window.__viserMutable.requestRender()")
        page.page.wait_for_function(f"{PIXELS} < {0.7 * sharp}", polling=5)
        page.page.wait_for_function(f"{PIXELS} === {sharp}", polling=20)
    finally:
        page.page.close()
        editor.page.bring_to_front()
