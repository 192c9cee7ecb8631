from __future__ import annotations

import io
import json
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from diorama_app.panels import photo as photo_panel
from diorama_app.panels.photo import PhotoPanel
from diorama_app.projects.uploads import Upload
from diorama_app.reconstruction import build_job
from diorama_app.viewport.annotation_canvas import Deleted, Drawn, Finished, Named, Reshaped, Selected
from diorama_core.artefacts import LabelledBox
from diorama_core.perception.inputs.source import Source
from diorama_core.project.storage import Project
from tests.app.page import Page
from tests.app.panels.test_photo_boxes import CHAIR, Known
from tests.multiview.spheres import sphere_with_wardrobe
from tests.multiview.test_plumb_lines import bent, lines
from tests.perception.inputs.files import depth_png, encoded
from tests.waiting import until


def picture(width: int = 64, height: int = 48, kind: str = "PNG") -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(np.full((height, width, 3), 120, np.uint8)).save(buffer, kind)
    return buffer.getvalue()


@pytest.fixture
def panel(session, page: Page, client, commands, monkeypatch) -> PhotoPanel:
    monkeypatch.setattr(build_job, "can_find_furniture", lambda: False)
    monkeypatch.setattr(photo_panel, "can_find_furniture", lambda: False)
    monkeypatch.setattr("diorama_app.panels.photo_boxes.Suggestions", Known)
    client.preferences = replace(client.preferences, build_at_once=False)
    return page.put(PhotoPanel, commands)


def test_a_360_degree_photo_is_marked_first_or_built_at_once(session, page: Page, panel: PhotoPanel, client) -> None:
    content, boxes = sphere_with_wardrobe(1.4)
    for at_once in (False, True):
        client.preferences = replace(client.preferences, build_at_once=at_once)
        panel.begin(Upload(content, "hall.png", boxes=Source(boxes, "hall.json")))
        session.reader.wait()
        page.settle()
        assert session.inputs.photo.equirectangular
        assert [b.label for b in session.inputs.boxes] == ["wardrobe"]
        assert session.is_unbuilt
        status = session.jobs.status
        assert (status is not None and status.title == build_job.UNASKED) == at_once
    session.jobs.cancel()
    until(lambda: session.jobs.status is None, seconds=60)


def test_a_360_degree_photo_takes_no_depth(
    session, page: Page, panel: PhotoPanel, monkeypatch: pytest.MonkeyPatch
) -> None:
    before, told = set(session.projects_dir.iterdir()), []
    monkeypatch.setattr(session, "notice", lambda client_id, message, kind: told.append(message))
    content, _ = sphere_with_wardrobe(1.4)
    panel.begin(Upload(content, "hall.png", depth=Source(b"", "hall.npy")))
    session.reader.wait()
    page.settle()
    assert "360 degree photo, with which depth is not used" in told[0]
    assert set(session.projects_dir.iterdir()) == before


@pytest.fixture
def empty(session, panel) -> PhotoPanel:
    """Before any photo."""
    session.document.open(session.scene, None)
    panel.refresh()
    return panel


def draw(panel: PhotoPanel, page: Page, box: tuple[float, float, float, float]) -> None:
    panel._boxes.handle(Drawn(box))
    page.settle()


def labels(session) -> list[str]:
    return [b.label for b in session.inputs.boxes]


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch) -> list[Sequence[LabelledBox]]:
    """Boxes of the builds that were begun unasked."""
    begun: list[Sequence[LabelledBox]] = []
    monkeypatch.setattr(build_job, "build_found", lambda session, found: begun.append(found))
    return begun


def test_an_uploaded_photo_is_built_of_what_is_sure_once(session, client, page, empty, built) -> None:
    client.preferences = replace(client.preferences, build_at_once=True)
    page.upload("Upload a photo", "room.png", picture(640, 480))
    page.settle()
    assert [[b.box for b in boxes] for boxes in built] == [[CHAIR.box]]
    session.open_project(session.project)
    empty.refresh()
    assert len(built) == 1


def test_who_wishes_to_mark_photos_is_not_built_for(client, page, empty, built) -> None:
    page.upload("Upload a photo", "room.png", picture(640, 480))
    page.settle()
    assert built == []


def test_nothing_is_built_unasked_while_boxes_are_read(session, client, page, empty, built, monkeypatch) -> None:
    page.upload("Upload a photo", "room.png", picture(640, 480))
    page.settle()
    session.project.update_info(**{build_job.AWAITED: True})
    monkeypatch.setattr(session.reader, "read", lambda *given: None)  # is still reading
    page.upload("Add boxes", "boxes.json", b"[]")
    empty._seen_for = None
    empty.refresh()
    assert built == []


def test_the_page_asks_for_a_photo_first(client, page, empty) -> None:
    assert "Start with a photo of a room" in page.html
    assert not page.shows("build")
    page.upload("Add boxes", "boxes.json", b"[]")
    assert client.viser_client.told == ["upload the photo first, then its boxes, depth or masks"]


def test_an_uploaded_photo_is_a_project_at_once(session, client, page, empty) -> None:
    page.upload("Upload a photo", "<room>.png", picture())
    assert session.project.folder.name == "room"
    assert session.is_unbuilt
    saved = Project.open(session.project.folder)
    assert saved.photo().width == 64
    assert saved.uploads() == {"photo": picture()}
    assert not saved.has_scene
    assert client.view.canvas.is_open
    assert "&lt;room&gt;.png" in page.html
    assert not page.shows("board"), "the photo is marked already"
    assert "Click each piece of furniture" in page.html


def test_what_is_no_picture_is_refused_and_loses_nothing(session, client, page, panel) -> None:
    before = session.inputs
    page.upload("Upload a photo", "room.png", b"no picture")
    assert session.inputs is before
    assert client.viser_client.told


def test_boxes_are_drawn_named_reshaped_deleted_undone_and_saved(session, client, page, panel) -> None:
    page.upload("Upload a photo", "room.png", picture())
    assert "Name of the selected box" not in page.html
    draw(panel, page, (5.0, 5.0, 30.0, 30.0))
    draw(panel, page, (20.0, 10.0, 60.0, 40.0))
    assert client.selected_box == 1, "what was drawn is selected"
    page.change("named", "desk")
    assert labels(session) == ["stool", "desk"]
    panel._boxes.handle(Selected(0))
    page.change("named", "beanbag")
    assert labels(session) == ["beanbag", "desk"]
    panel._boxes.handle(Reshaped(0, (6.0, 6.0, 31.0, 31.0)))
    assert session.inputs.boxes[0].box == (6.0, 6.0, 31.0, 31.0)
    panel._boxes.handle(Deleted(1))
    assert labels(session) == ["beanbag"]
    session.autosave.flush()
    assert Project.open(session.project.folder).load_inputs().boxes == session.inputs.boxes
    assert not session.project.has_scene, "there is nothing to show yet"
    for _ in range(3):
        session.undo(client)
    assert labels(session) == ["stool", "desk"]
    session.autosave.flush()
    assert Project.open(session.project.folder).load_inputs().boxes == session.inputs.boxes
    assert page.shows("build")
    assert "Build scene (2)" in page.html


def test_events_of_boxes_that_are_gone_do_nothing(session, client, page, panel) -> None:
    before = session.inputs
    for event in (Deleted(7), Named(-1, "x"), Reshaped(3, (1.0, 1.0, 9.0, 9.0)), Selected(12)):
        panel._boxes.handle(event)
    assert session.inputs is before
    assert client.selected_box is None


def test_an_unfinished_project_opens_where_it_was_left(session, client, page, panel) -> None:
    page.upload("Upload a photo", "room.png", picture())
    draw(panel, page, (5.0, 5.0, 30.0, 30.0))
    unfinished = session.project
    session.visit(client, Project.open(session.projects_dir / "demo"), "")
    assert not client.view.canvas.is_open
    session.visit(client, Project.open(unfinished.folder), "")
    assert client.view.canvas.is_open
    assert labels(session) == ["stool"]


def test_boxes_come_from_a_file_too(session, page, panel) -> None:
    page.upload("Upload a photo", "room.png", picture())
    boxes = [{"class": "chair", "bbox": [5, 5, 30, 40]}, {"class": "table", "bbox": [20, 10, 60, 40]}]
    page.upload("Add boxes", "boxes.json", json.dumps(boxes).encode())
    assert labels(session) == ["chair", "table"]


def test_depth_and_camera_go_with_the_photo(session, client, page, panel) -> None:
    page.upload("Upload a photo", "room.png", picture())
    buffer = io.BytesIO()
    np.save(buffer, np.full((48, 64), 2.5, np.float32))
    page.upload("Add depth", "depth.npy", buffer.getvalue())
    page.write("Camera", "60,60,32,24")
    assert session.inputs.depth_m.mean() == pytest.approx(2.5)
    assert session.inputs.intrinsics.fx == 60.0
    assert "with depth, camera" in page.html
    page.write("Camera", "60,60,32,wide")
    assert any("is not four numbers" in told for told in client.viser_client.told)
    assert session.inputs.intrinsics.fx == 60.0


def test_a_photo_that_is_upside_down_is_turned_with_its_boxes_and_back(session, client, page, panel) -> None:
    page.upload("Upload a photo", "room.png", picture())
    low = [(2, 2, 20, 10), (22, 2, 40, 10), (42, 2, 60, 10)]  # things of the floor at the top
    boxes = [{"class": "rug", "bbox": b} for b in low] + [{"class": "ceiling lamp", "bbox": [20, 38, 40, 46]}]
    page.upload("Add boxes", "boxes.json", json.dumps(boxes).encode())
    assert page.shows("turn")
    page.act("turn")
    assert session.inputs.photo.half_turned
    assert not client.view.canvas.shows_another(session.inputs.photo.rgb), "it is turned where it is marked, too"
    assert session.inputs.boxes[0].box == (44.0, 38.0, 62.0, 46.0)
    assert not page.shows("turn")
    page.write("Camera", "60,60,30,20")  # the photo is read again
    assert (session.inputs.intrinsics.cx, session.inputs.intrinsics.cy) == (34.0, 28.0)
    assert session.inputs.boxes[0].box == (44.0, 38.0, 62.0, 46.0)
    session.undo(client)
    session.undo(client)
    assert not session.inputs.photo.half_turned
    assert page.shows("turn")


def test_the_photo_is_shown_once_on_the_board_or_in_the_panel(client, page, panel) -> None:
    assert 'class="photo"' in page.html
    page.act("board")
    assert client.view.canvas.is_open
    assert 'class="photo"' not in page.html
    panel._boxes.handle(Finished())
    assert not client.view.canvas.is_open
    assert "Continue marking" in page.html


def test_the_selected_box_is_added_to_the_scene(session, client, page, panel, monkeypatch) -> None:
    asked = []
    monkeypatch.setattr(photo_panel, "add_from_photo", lambda client, box, label: asked.append((box, label)))
    assert not page.shows("add box"), "none is selected"
    page.act("mark", 0)
    page.act("add box")
    assert asked == [((240.0, 200.0, 440.0, 420.0), "dining table")]


def test_a_room_is_described_in_words(page, panel, monkeypatch) -> None:
    asked = []
    monkeypatch.setattr(photo_panel, "describe_room", lambda client, words: asked.append(words))
    assert page.field("Create room").disabled
    page.write("Describe a room", "a bedroom with a lamp")
    page.press("Create room")
    assert asked == ["a bedroom with a lamp"]


def test_a_bent_photo_is_straightened_said_and_left_bent_when_asked(session, client, page, panel) -> None:
    rgb = bent(lines(), -0.15)
    file = encoded(Image.fromarray(rgb))
    page.upload("Upload a photo", "wide.png", file)
    assert session.inputs.photo.straightened == pytest.approx(-0.15, abs=0.01)
    assert "The photo was straightened" in page.html
    assert "straightened" in session.project.info()["warnings"][0]
    page.upload("Add boxes", "boxes.json", json.dumps([{"class": "chair", "bbox": [90, 70, 250, 360]}]).encode())
    straight = session.inputs.boxes[0].box
    assert straight != (90.0, 70.0, 250.0, 360.0)
    page.write("Camera", "500,500,320,240")  # read again: the box must not move once more
    assert session.inputs.boxes[0].box == pytest.approx(straight, abs=0.05)
    assert session.inputs.photo.straightened == pytest.approx(-0.15, abs=0.01)
    page.act("bend")
    assert session.inputs.photo.straightened is None
    assert (session.inputs.photo.rgb == rgb).all()
    assert session.inputs.boxes[0].box == pytest.approx((90.0, 70.0, 250.0, 360.0), abs=0.05)
    assert not page.shows("bend")
    page.write("Camera", "510,510,320,240")
    assert session.inputs.photo.straightened is None, "it stays as asked"


def test_confidence_leaves_depth_out_and_is_kept_with_it(session, client, page, empty) -> None:
    page.upload("Upload a photo", "room.png", picture())
    depth, levels = np.full((48, 64), 2500, np.uint16), np.full((48, 64), 2, np.uint8)
    levels[:12] = 0
    confidence = Source(encoded(Image.fromarray(levels)), "confidence.png")
    client.post(lambda: empty.add({"confidence": confidence}))
    page.settle()
    assert "add the depth map, too" in client.viser_client.told[-1]
    page.upload("Add depth", "depth.png", depth_png(depth))
    client.post(lambda: empty.add({"confidence": confidence}))
    page.settle()
    assert (session.inputs.depth_m[:12] == 0).all()
    assert (session.inputs.depth_m[12:] == 2.5).all()
    page.write("Camera", "60,60,30,20")
    assert (session.inputs.depth_m[:12] == 0).all(), "also when it is read again"
    page.upload("Add depth", "depth.png", depth_png(depth))
    assert (session.inputs.depth_m == 2.5).all(), "another map has none"
