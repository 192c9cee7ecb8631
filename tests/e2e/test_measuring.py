"""Lengths that are measured in the view: drawn over everything, between corners."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_app.commands.measure import length_m
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture

pytestmark = pytest.mark.browser


def test_a_measured_line_is_drawn_over_everything_and_snaps_to_corners(editor: EditorPage) -> None:
    page, table = editor.page, editor.session.scene.object("table_1")
    corners = sorted(table.corners_world.tolist(), key=lambda c: (round(c[2], 3), c[0], c[1]))[4:]
    page.keyboard.press("m")
    beside = np.array([0.01, 0.01, 0.0])
    for corner in (np.array(corners[0]) + beside, np.array(corners[1]) + beside):
        editor.click_world(corner)
        editor.settle()
    editor.until(lambda: length_m(editor.client.doing) is not None, "measured")
    assert length_m(editor.client.doing) == pytest.approx(np.linalg.norm(np.subtract(*corners[:2])), abs=1e-6)
    over = """() => { const found = []; window.__viserMutable.nodeRefFromName['/tape/line']?.traverse((o) =>
        o.isMesh && found.push([o.material.depthTest, o.renderOrder > 0])); return found; }"""
    page.wait_for_function(f"((all) => all.length > 0 && all.every(([tests, last]) => !tests && last))(({over})())")
    keep_picture(editor, "measured")
