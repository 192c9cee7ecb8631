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


def test_software_webgl_draws_few_frames_without_smoothing(editor: EditorPage) -> None:
    renderer = "window.__viserMutable.scene.__r3f.root.getState().gl.getContext()"
    assert editor.page.evaluate(f"{renderer}.getContextAttributes().antialias") is False
    editor.settle()
    editor.page.wait_for_timeout(700)
    # One for the request, one when all is quiet, perhaps one of the heartbeat; viser's own pace is sixty a second.
    frames = editor.page.evaluate(FRAMES_AFTER_A_REQUEST)
    assert 1 <= frames <= 3
