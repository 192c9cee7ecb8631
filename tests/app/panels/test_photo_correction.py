from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_app.panels import photo_correction
from diorama_app.panels.photo_correction import PhotoCorrection
from diorama_app.viewport.annotation_canvas import Drawn, Pointed
from tests.app.page import Page

BOX = (240.0, 200.0, 440.0, 420.0)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[tuple]:
    """What the panel asked to be corrected."""
    calls: list[tuple] = []
    for name in ("rename_class", "redraw_box", "use_outline"):
        monkeypatch.setattr(photo_correction, name, lambda client, *given, name=name: calls.append((name, *given)))
    return calls


@pytest.fixture
def panel(session, page: Page, client, asked) -> PhotoCorrection:
    table = replace(session.scene.object("table_1"), box_px=BOX)
    scene = replace(session.scene, objects=tuple(table if o.id == "table_1" else o for o in session.scene.objects))
    session.document.open(scene, session.document.inputs)
    made = page.put(PhotoCorrection)
    client.select(["table_1"])
    return made


def test_only_what_was_found_in_the_photo_is_offered(client, page, panel) -> None:
    assert "From the photo" in page.html
    client.select(["chair_1"])
    assert "From the photo" not in page.html


def test_another_class_is_typed(page, panel, asked) -> None:
    assert 'value="table"' in page.html
    page.change("is", "desk")
    assert asked == [("rename_class", "table_1", "desk")]


def test_a_box_is_drawn_on_the_board(client, page, panel, asked, monkeypatch) -> None:
    shown = []
    monkeypatch.setattr(client.view.canvas, "show_boxes", lambda boxes, marked: shown.append([b.box for b in boxes]))
    page.act("box")
    assert client.view.canvas.is_open
    assert shown == [[BOX]]
    assert "Draw a box around it" in page.html
    panel._handle("table_1", Drawn((1.0, 2.0, 30.0, 40.0)))
    assert asked == [("redraw_box", "table_1", (1.0, 2.0, 30.0, 40.0))]
    assert not client.view.canvas.is_open


def test_an_outline_is_clicked_and_used(client, page, panel, asked, monkeypatch) -> None:
    masks = []
    monkeypatch.setattr(client.view.canvas, "show_mask", masks.append)
    page.act("outline")
    assert "Click the object" in page.html
    panel._handle("table_1", Pointed(340.0, 320.0, True))
    assert len(masks) == 2
    page.act("use")
    ((name, object_id, outline),) = asked
    assert (name, object_id) == ("use_outline", "table_1")
    assert outline.clicks == ((340.0, 320.0, True),)
    assert not client.view.canvas.is_open
    assert page.shows("outline")


@pytest.mark.parametrize("what", ["box", "outline"])
def test_either_can_be_left(client, page, panel, asked, what) -> None:
    page.act(what)
    page.act("stop")
    assert not client.view.canvas.is_open
    assert asked == []
    assert page.shows(what)
