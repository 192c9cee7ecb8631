"""What is dropped on the page goes where it belongs, after it was said or asked what it is."""

from __future__ import annotations

import re

import pytest

from diorama_app.panels import dropping
from diorama_app.panels.dropping import DroppedFiles, listen_for_drops
from diorama_app.panels.photo import PhotoPanel
from diorama_app.projects.dropped import Dropped, Reading
from diorama_app.web.viser_adapter import component_uuid
from diorama_core.project.storage import Project
from tests.app.page import Page
from tests.app.projects.test_dropped import BOXES, DEPTH, PHOTO, packed
from tests.perception.inputs.depth.rooms import HEIGHT, WIDTH


@pytest.fixture
def dropped(page: Page, client, commands) -> DroppedFiles:
    panel = page.put(PhotoPanel, commands)
    made = DroppedFiles(client, panel)
    listen_for_drops(page, client, made.take)
    return made


def test_the_page_sends_drops_to_one_hidden_field(page: Page, client) -> None:
    taken: list[tuple[str, bytes]] = []
    listen_for_drops(page, client, lambda name, content: taken.append((name, content)))
    (field,) = [h for kind, _, h in page.made if kind == "upload_button"]
    assert re.search(r'id="dio-drop-to" data-upload="([^"]+)"', page.html)[1] == component_uuid(field)
    page.upload("Dropped files", "lamp.glb", b"bytes")
    assert taken == [("lamp.glb", b"bytes")]
    assert f"#file_upload_{component_uuid(field)}" in page.html  # out of sight


def test_a_photo_with_its_files_is_a_project(session, client, page: Page, dropped: DroppedFiles, monkeypatch) -> None:
    told: list[str] = []
    monkeypatch.setattr(client, "notice", lambda line, *_: told.append(line))
    page.upload(
        "Dropped files", "my room.zip", packed({"room.jpg": PHOTO, "b.json": BOXES, "d.png": DEPTH, "x.md": b"x"})
    )
    for _ in range(2):  # what it is was read, then what is in it
        page.settle()
    made = Project.open(session.projects_dir / "room")
    inputs = made.load_inputs()
    assert len(inputs.boxes) == 1
    assert inputs.depth_m.shape == (HEIGHT, WIDTH)
    assert made.uploads() == {"photo": PHOTO, "depth": DEPTH}
    line = next(line for line in told if "my room.zip" in line)
    assert "a photo (room.jpg) with boxes" in line
    assert "Left out: x.md" in line


def test_each_reading_has_its_way(client, dropped: DroppedFiles, monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[str] = []
    for name in ("begin_each", "build_one_room", "import_model", "open_file"):
        monkeypatch.setattr(dropping, name, lambda *_, name=name: taken.append(name))
    for action in ("photos", "room", "models", "scene"):
        dropped._act("a.zip", b"", Reading(action, action))
    assert taken == ["begin_each", "build_one_room", "import_model", "open_file"]


def test_two_readings_are_asked_about(page: Page, dropped: DroppedFiles, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Dropped] = []
    monkeypatch.setattr(dropping, "ask_which", lambda client, name, found, then: asked.append(found))
    page.upload("Dropped files", "v.zip", packed({"a.jpg": PHOTO, "b.jpg": PHOTO}))
    assert [r.action for r in asked[0].readings] == ["room", "photos"]
