"""A photo is a project at once; boxes are objects on it: drawn, selected, dragged, named, deleted, undone."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from diorama_app.projects.example import EXAMPLE
from diorama_core.artefacts import LabelledBox
from diorama_core.project.storage import Project
from tests.app.small_room import PlainLibrary, make_project, plain_photo
from tests.e2e.browser import QUERY, EditorPage
from tests.ports import lasting_port
from tests.waiting import until

pytestmark = [pytest.mark.browser, pytest.mark.slow]

CHAIR, TABLE = (40.0, 250.0, 160.0, 440.0), (240.0, 200.0, 440.0, 420.0)


@pytest.fixture
def photo(tmp_path: Path) -> Path:
    path = tmp_path / "my room.png"
    Image.fromarray(plain_photo().rgb).save(path)
    return path


@pytest.fixture
def started(editor: EditorPage, photo: Path) -> EditorPage:
    """A photo was uploaded."""
    scene = editor.session.scene
    editor.tab("Photo")
    editor.upload("Upload a photo", photo)
    editor.until(lambda: editor.session.is_unbuilt, "a project of its own")
    editor.at_board()
    editor.dismiss_notices()
    assert editor.running.session.scene is scene, "the open scene stays"
    return editor


def boxes(editor: EditorPage) -> list[tuple[str, tuple[float, ...]]]:
    assert editor.session.inputs is not None
    return [(b.label, b.box) for b in editor.session.inputs.boxes]


def name(editor: EditorPage, word: str, of: str) -> None:
    field = editor.page.get_by_label(f"Name of the {of} box").first
    field.fill(word)
    field.press("Enter")


def test_what_is_drawn_is_selected_and_named(started: EditorPage) -> None:
    editor = started
    expect(editor.button("Build at once")).to_be_visible()
    expect(editor.build_button()).to_have_count(0)
    editor.draw_box(CHAIR)
    editor.until(lambda: len(boxes(editor)) == 1, "drawn")
    np.testing.assert_allclose(boxes(editor)[0][1], CHAIR, atol=4.0)
    expect(editor.page.locator(".dio-canvas-box.on")).to_have_count(1)
    name(editor, "desk", "selected")
    editor.until(lambda: boxes(editor)[0][0] == "desk", "named in the panel")
    for _ in range(2):  # out of the field, and then the selection
        editor.page.keyboard.press("Escape")
    expect(editor.page.locator(".dio-canvas-box.on")).to_have_count(0)
    editor.draw_box(TABLE)
    editor.until(lambda: len(boxes(editor)) == 2, "drawn, too")
    expect(editor.page.locator(".dio-canvas-box.on")).to_have_count(1)
    editor.page.locator(".dio-canvas-box.on input").fill("couch")
    editor.page.keyboard.press("Enter")
    editor.until(lambda: boxes(editor)[1][0] == "couch", "named on the photo")
    assert editor.session.inputs.boxes[1].category == "sofa"
    expect(editor.build_button()).to_be_enabled()


def test_a_name_goes_on_being_typed_when_the_boxes_are_drawn_anew(started: EditorPage) -> None:
    editor, page = started, started.page
    editor.draw_box(CHAIR)
    editor.until(lambda: len(boxes(editor)) == 1, "drawn")
    field = page.locator(".dio-canvas-box.on input")
    field.click()
    field.press("Control+a")
    page.keyboard.type("r")
    page.evaluate("window.__dioCanvas.told({})")
    page.keyboard.type("ug")
    expect(field).to_have_value("rug")
    assert editor.client.view.canvas.is_open, "the letter is no command"
    page.keyboard.press("Enter")
    editor.until(lambda: boxes(editor)[0][0] == "rug", "named")


def test_corners_drag_delete_deletes_and_every_step_is_undone(started: EditorPage) -> None:
    editor = started
    editor.draw_box(TABLE)
    editor.until(lambda: len(boxes(editor)) == 1, "drawn")
    expect(editor.page.locator(".dio-canvas-handle")).to_have_count(8)
    editor.drag(editor.on_photo(440, 420), editor.on_photo(500, 460))
    editor.until(lambda: boxes(editor)[0][1][2] > 480, "pulled by its corner")
    np.testing.assert_allclose(boxes(editor)[0][1], (240, 200, 500, 460), atol=5.0)
    editor.drag(editor.on_photo(340, 300), editor.on_photo(300, 280))
    editor.until(lambda: boxes(editor)[0][1][0] < 220, "moved by its body")
    np.testing.assert_allclose(boxes(editor)[0][1], (200, 180, 460, 440), atol=6.0)
    editor.page.keyboard.press("Delete")
    editor.until(lambda: not boxes(editor), "deleted")
    for left in (200, 240, 240):
        editor.page.keyboard.press("Control+z")
        editor.until(lambda left=left: bool(boxes(editor)) and abs(boxes(editor)[0][1][0] - left) < 6, "undone")
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: not boxes(editor), "not drawn")
    editor.page.locator(".dio-canvas").get_by_role("button", name="Done").click()
    expect(editor.page.locator(".dio-canvas")).to_have_count(0)


def test_escape_deselects_first_and_an_empty_view_offers_to_go_on(started: EditorPage) -> None:
    editor, page = started, started.page
    editor.draw_box(CHAIR)
    editor.until(lambda: editor.client.selected_box == 0, "drawn and selected")
    page.keyboard.press("Escape")
    editor.until(lambda: editor.client.selected_box is None, "deselected")
    editor.settle()
    assert editor.client.view.canvas.is_open
    page.keyboard.press("Escape")
    expect(page.locator(".dio-canvas")).to_have_count(0)
    card = page.locator("#dio-no-scene")
    expect(card).to_contain_text("1 object is marked")
    expect(card.get_by_role("button", name="Build scene (1)")).to_be_enabled()
    card.get_by_role("button", name="Continue marking").click()
    editor.at_board()
    expect(card).to_have_count(0)


def test_the_offer_of_an_empty_view_goes_when_the_page_does_whichever_tab_is_in_front(started: EditorPage) -> None:
    editor, card = started, started.page.locator("#dio-no-scene")
    editor.page.keyboard.press("Escape")
    expect(card).to_contain_text("nothing is marked")
    editor.tab("Scene")
    editor.page.wait_for_timeout(300)  # the page remembers the tab
    editor.page.evaluate("window.__dioGoTo('demo')")
    editor.until(lambda: bool(editor.running.session.clients), "at the first project")
    expect(editor.row("chair")).to_be_visible()
    expect(card).to_have_count(0)


def test_a_box_drawn_by_hand_gets_the_kind_that_is_recognised(editor: EditorPage) -> None:
    editor.tab("Photo")
    editor.upload("Upload a photo", EXAMPLE / "photo.jpg")
    editor.until(lambda: editor.session.is_unbuilt, "a project of its own")
    editor.at_board()
    known = json.loads((EXAMPLE / "boxes.json").read_text())["boxes"]
    editor.draw_box(next(tuple(b["bbox"]) for b in known if b["class"] == "bookshelf"))
    editor.until(lambda: len(boxes(editor)) == 1, "drawn")
    assert boxes(editor)[0][0] == "bookshelf"
    expect(editor.page.locator(".dio-canvas-box.on")).to_have_count(1)


SERVER = """
import sys
from pathlib import Path
from diorama_app.serve import start
from tests.app.small_room import PlainLibrary
running = start(project=Path(sys.argv[1]), projects_dir=Path(sys.argv[1]).parent, port=int(sys.argv[2]),
                low_graphics=True, library=PlainLibrary())
print(running.port, flush=True)
running.stopped.wait()
"""


@pytest.fixture
def serve_apart(tmp_path: Path) -> Iterator[Callable[[int], subprocess.Popen[str]]]:
    """Starts a server in a process of its own, which can be killed."""
    project = make_project(tmp_path / "projects" / "demo")
    begun: list[subprocess.Popen[str]] = []

    def start(port: int) -> subprocess.Popen[str]:
        command = [sys.executable, "-c", SERVER, str(project.folder), str(port)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ})
        begun.append(process)
        return process

    yield start
    for process in begun:
        process.kill()
        process.wait()


def saved_boxes(folder: Path) -> tuple[LabelledBox, ...]:
    inputs = Project.open(folder).load_inputs()
    assert inputs is not None
    return inputs.boxes


@pytest.mark.posix
def test_what_was_drawn_outlives_a_killed_server(context, serve_apart, serve, photo: Path, tmp_path: Path) -> None:
    port = lasting_port()
    server = serve_apart(port)
    assert server.stdout is not None
    assert int(server.stdout.readline()) == port
    page = context.new_page()
    page.set_default_timeout(60_000)
    page.goto(f"http://127.0.0.1:{port}/{QUERY}")
    page.get_by_role("tab", name="Photo", exact=True).click()
    with page.expect_file_chooser() as chosen:
        page.get_by_role("button", name="Upload a photo", exact=True).click()
    chosen.value.set_files(str(photo))
    page.wait_for_selector(".dio-canvas-layer")
    area = page.locator(".dio-canvas-layer").bounding_box()
    assert area is not None
    page.mouse.move(area["x"] + 40, area["y"] + 40)
    page.mouse.down()
    page.mouse.move(area["x"] + 120, area["y"] + 140, steps=4)
    page.mouse.up()
    expect(page.locator(".dio-canvas-box")).to_have_count(1)
    folder = tmp_path / "projects" / "my-room"
    until(lambda: saved_boxes(folder), "the box is saved")
    os.kill(server.pid, signal.SIGKILL)
    server.wait()
    serve(tmp_path / "projects" / "demo", PlainLibrary(), port=port)
    page.goto(f"http://127.0.0.1:{port}/{QUERY}")
    page.get_by_role("tab", name="Project", exact=True).click()
    page.locator(".dio .row", has_text="my room").get_by_role("button", name="Open").click()
    expect(page.locator(".dio-canvas-box")).to_have_count(1)
    expect(page.get_by_role("tab", name="Photo", exact=True)).to_have_attribute("aria-selected", "true")
    page.close()
