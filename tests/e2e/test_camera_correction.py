"""Point 6: a box drawn anew and an outline clicked, with what belongs to the thing and what does not."""

from __future__ import annotations

import pytest

from diorama_app.panels.in_place import InPlace
from diorama_app.panels.photo_correction import PhotoCorrection
from tests.e2e.browser import EditorPage
from tests.e2e.test_viewport import seen_in_photo

pytestmark = pytest.mark.browser


def test_a_box_is_drawn_anew_and_an_outline_is_clicked_and_left(editor: EditorPage) -> None:
    session = editor.running.session
    session.ui_thread.post(lambda: session.edit("found", seen_in_photo))
    editor.until(lambda: session.scene.object("table_1").box_px is not None)
    apart = ("chair_1", "chair_2", "picture_1")
    others = [session.scene.object(i) for i in apart]
    editor.row("dining table").click()
    editor.button("Redraw box").click()
    editor.at_board()
    editor.draw_box((230, 190, 450, 430))
    editor.until(
        lambda: session.document.history.current.label == "reconstruct dining table", "looked at again", seconds=120
    )
    table = session.scene.object("table_1")
    assert table.box_px == pytest.approx((230.0, 190.0, 450.0, 430.0), abs=4.0)
    assert table.category == "table"
    assert session.ui_thread.wait()
    session.autosave.flush()
    retained = session.project.load_inputs()
    assert retained.boxes[0].box == table.box_px, "the next build starts from this box"
    assert [session.scene.object(i) for i in apart] == others, (
        "nothing else changed; the lamp goes along with its table"
    )
    assert not editor.client.view.canvas.is_open
    editor.button("Fix outline").click()
    editor.at_board()
    placed = [p.panel for p in editor.client.panels if isinstance(p, InPlace)]
    panel = next(p for p in placed if isinstance(p, PhotoCorrection))
    before = session.scene
    editor.page.mouse.click(*editor.on_photo(340, 300))
    editor.until(lambda: panel._outline is not None and len(panel._outline.clicks) == 1, "part of it")
    editor.page.keyboard.down("Shift")
    editor.page.mouse.click(*editor.on_photo(450, 200))
    editor.page.keyboard.up("Shift")
    editor.until(lambda: panel._outline is not None and len(panel._outline.clicks) == 2, "no part of it")
    outline = panel._outline
    assert outline is not None
    assert [part for _, _, part in outline.clicks] == [True, False]
    assert outline.mask[300, 340]
    assert not outline.mask[200, 450]
    editor.button("Cancel").click()
    editor.until(lambda: not editor.client.view.canvas.is_open)
    assert session.scene is before
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: session.scene.object("table_1").box_px == (240.0, 200.0, 440.0, 420.0), "one undo step")
    assert session.ui_thread.wait()
    session.autosave.flush()
    assert session.project.load_inputs().boxes[0].box == (240.0, 200.0, 440.0, 420.0)
