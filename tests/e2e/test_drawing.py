"""How the page draws where WebGL has no graphics card, as here: sparingly."""

from __future__ import annotations

import base64
import io

import numpy as np
import pytest
from PIL import Image

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
    editor.still(lambda: editor.page.evaluate(FRAME), apart_ms=700)
    # One for the request, one when all is quiet, perhaps one of the heartbeat; viser's own pace is sixty a second.
    frames = editor.page.evaluate(FRAMES_AFTER_A_REQUEST)
    assert 1 <= frames <= 3


def test_a_page_at_rest_draws_nothing(editor: EditorPage) -> None:
    editor.settle()
    editor.still(lambda: editor.page.evaluate(FRAME), apart_ms=2500)  # every ten seconds one is drawn


def test_what_moves_is_drawn_with_fewer_pixels_until_it_rests(editor: EditorPage) -> None:
    page = EditorPage.open(editor.page.context, editor.running, query="")
    try:
        sharp = pixels_at_rest(page)
        moving = "window.__viserMutable.requestRender()"  # for as long as it takes to be seen
        page.page.wait_for_function(f"() => {{ {moving}; return {PIXELS} < {0.7 * sharp}; }}", polling=5)
        page.page.wait_for_function(f"{PIXELS} === {sharp}", polling=20)
    finally:
        page.page.close()
        editor.page.bring_to_front()


def pixels_at_rest(editor: EditorPage) -> float:
    """`PIXELS` of a whole picture."""
    editor.page.wait_for_function(f"{PIXELS} > 0")
    return editor.still(lambda: float(editor.page.evaluate(PIXELS)), apart_ms=900)


PICTURE = "window.__viserMutable.canvas.toDataURL()"
CALLS = "window.__viserTestpoints.rendererInfo.render.calls"


def calls_at_rest(editor: EditorPage) -> int:
    """Draw calls of a whole picture: beside other work, shapes and marks come late."""

    def calls() -> int:
        editor.page.evaluate("window.__viserMutable.requestRender()")
        editor.page.wait_for_timeout(900)
        return int(editor.page.evaluate(CALLS))

    return editor.still(calls, apart_ms=0)


def pixels(page: EditorPage) -> np.ndarray:
    """What is on the canvas, 0 to 255."""
    data = base64.b64decode(page.page.evaluate(PICTURE).partition(",")[2])
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"), dtype=int)


@pytest.mark.parametrize("selected", [False, True], ids=["unmarked", "selected by another"])
def test_of_a_moved_object_only_its_part_of_the_picture_is_drawn(editor: EditorPage, selected: bool) -> None:
    session, mine = editor.session, editor.client
    watching = EditorPage.open(editor.page.context, editor.running, query="")
    try:
        if selected:
            session.ui_thread.post(lambda: mine.select(("lamp_1",)))
        watching.page.wait_for_timeout(1000)
        calls = calls_at_rest(watching)
        sharp = watching.page.evaluate(PIXELS)
        drawn = watching.page.evaluate(FRAME)
        here = session.scene.object("lamp_1").pose
        for step in range(1, 6):
            pose = here.move((0.0, 0.05 * step, 0.0))
            session.ui_thread.post(lambda p=pose: session.viewport.preview({"lamp_1": p}))
            watching.page.wait_for_function(f"{FRAME} > {drawn}")
            drawn = watching.page.evaluate(FRAME)
            assert watching.page.evaluate(CALLS) < calls, "what is elsewhere is not drawn"
            assert watching.page.evaluate(PIXELS) == sharp, "and what is drawn is sharp"
        watching.page.wait_for_timeout(600)
        partly = pixels(watching)
        assert watching.page.evaluate(FRAME) <= drawn + 2
        assert calls_at_rest(watching) == calls
        assert np.abs(pixels(watching) - partly).max() <= 2, "it is the picture that drawing everything gives"
        session.ui_thread.post(session.refresh)
        watching.until(lambda: np.abs(pixels(watching) - partly).max() > 40, "the lamp was seen to move")
    finally:
        watching.page.close()
        editor.page.bring_to_front()
