from __future__ import annotations

import io
import json

import numpy as np
import pytest
from PIL import Image

from diorama_app.panels import photo as photo_panel
from diorama_app.panels.photo import PhotoPanel
from diorama_app.session.draft import Draft
from tests.app.page import Page


def picture(width: int = 64, height: int = 48, kind: str = "PNG") -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(np.full((height, width, 3), 120, np.uint8)).save(buffer, kind)
    return buffer.getvalue()


@pytest.fixture
def panel(session, page: Page, client, views, commands, monkeypatch) -> PhotoPanel:
    monkeypatch.setattr(photo_panel, "can_find_furniture", lambda: False)
    made = PhotoPanel(page, client, views, commands)
    client.panels = [made]
    made.refresh()
    return made


@pytest.fixture
def empty(session, panel) -> PhotoPanel:
    """Before any photo."""
    session.draft = Draft()
    panel.refresh()
    return panel


def test_the_page_asks_for_a_photo_first(client, page, empty) -> None:
    assert "Start with a photo of a room" in page.html
    assert not page.field("Build scene").visible
    page.upload("Add boxes (JSON)", "boxes.json", b"[]")
    assert client.viser_client.told == ["upload the photo first, then its boxes, depth or masks"]


def test_an_uploaded_photo_opens_the_drawing_board(session, client, page, empty) -> None:
    page.upload("Upload a photo", "<room>.png", picture())
    assert session.draft.photo.width == 64
    assert client.view.canvas.is_open
    assert "&lt;room&gt;.png" in page.html
    assert page.field("Draw boxes").label == "Done drawing"
    assert "Draw a box around each piece" in page.html


def test_what_is_no_picture_is_refused_and_loses_nothing(session, client, page, panel) -> None:
    before = session.draft
    page.upload("Upload a photo", "room.png", b"no picture")
    assert session.draft is before
    assert client.viser_client.told


def test_boxes_are_drawn_named_marked_and_deleted(session, client, page, panel) -> None:
    page.upload("Upload a photo", "room.png", picture())
    page.write("Category", "sofa")
    panel._drawn((5.0, 5.0, 30.0, 30.0))
    page.write("or type", "beanbag")
    page.settle()
    assert session.draft.boxes[-1].label == "beanbag", "the newest box is the marked one"
    page.write("or type", "")
    page.write("Category", "chair")
    panel._drawn((20.0, 10.0, 60.0, 40.0))
    assert [b.label for b in session.draft.boxes][-1] == "chair"
    assert "2 boxes" in page.html
    assert not page.field("Build scene").disabled
    page.act("mark", 0)
    assert session.draft.highlighted == 0
    page.act("drop", 0)
    assert [b.label for b in session.draft.boxes] == ["chair"]


def test_boxes_come_from_a_file_too(session, page, panel) -> None:
    page.upload("Upload a photo", "room.png", picture())
    boxes = [{"class": "chair", "bbox": [5, 5, 30, 40]}, {"class": "table", "bbox": [20, 10, 60, 40]}]
    page.upload("Add boxes (JSON)", "boxes.json", json.dumps(boxes).encode())
    assert [b.label for b in session.draft.boxes] == ["chair", "table"]


def test_depth_and_camera_go_with_the_photo(session, client, page, panel) -> None:
    page.upload("Upload a photo", "room.png", picture())
    buffer = io.BytesIO()
    np.save(buffer, np.full((48, 64), 2.5, np.float32))
    page.upload("Add depth (PNG or NPY)", "depth.npy", buffer.getvalue())
    page.write("Camera", "60,60,32,24")
    assert session.draft.inputs.depth_m.mean() == pytest.approx(2.5)
    assert session.draft.inputs.intrinsics.fx == 60.0
    assert "with depth, camera" in page.html
    page.write("Camera", "60,60,32,wide")
    assert any("is not four numbers" in told for told in client.viser_client.told)
    assert session.draft.inputs.intrinsics.fx == 60.0


def test_the_board_is_closed_by_its_button(client, page, panel) -> None:
    page.press("Draw boxes")
    assert client.view.canvas.is_open
    page.press("Draw boxes")
    assert not client.view.canvas.is_open


def test_the_marked_box_is_added_to_the_scene(session, client, page, panel, monkeypatch) -> None:
    asked = []
    monkeypatch.setattr(photo_panel, "add_from_photo", lambda client, box, label: asked.append((box, label)))
    add = "Add selected box to the scene"
    assert page.field(add).visible
    assert page.field(add).disabled
    page.act("mark", 0)
    page.press(add)
    assert asked == [((240.0, 200.0, 440.0, 420.0), "dining table")]


def test_a_room_is_described_in_words(page, panel, monkeypatch) -> None:
    asked = []
    monkeypatch.setattr(photo_panel, "describe_room", lambda client, words: asked.append(words))
    assert page.field("Create room").disabled
    page.write("Describe a room", "a bedroom with a lamp")
    page.press("Create room")
    assert asked == ["a bedroom with a lamp"]
