"""Files and folders dropped on the page, as a file manager drops them: said or asked what they are, then taken."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image
from playwright.sync_api import expect

from diorama_app.projects.packing import pack_project
from diorama_app.session.client import Placing
from tests.app.small_room import make_project
from tests.e2e.browser import LEARN_MS, EditorPage
from tests.e2e.conftest import keep_picture
from tests.multiview.test_plumb_lines import bent, lines
from tests.perception.inputs.depth.rooms import HEIGHT, WIDTH, room
from tests.perception.inputs.files import box, boxes_json, depth_png

pytestmark = pytest.mark.browser


def drop(editor: EditorPage, *paths: Path) -> None:
    """Drop files or folders on the middle of the page."""
    devtools = editor.page.context.new_cdp_session(editor.page)
    data = {"items": [], "files": [str(p) for p in paths], "dragOperationsMask": 1}
    veil = editor.page.locator("#dio-drop")
    for what in ("dragEnter", "dragOver", "drop"):
        devtools.send("Input.dispatchDragEvent", {"type": what, "x": 700, "y": 400, "data": data})
        if what == "dragEnter":  # Chromium forgets a drop on a page that has not yet said that it takes files
            expect(veil).to_be_visible()
        editor.settle()
    expect(veil).to_be_hidden()
    devtools.detach()


def photo(path: Path, seed: int = 0) -> Path:
    rgb = np.random.default_rng(seed).integers(0, 255, (HEIGHT // 8, WIDTH // 8, 3), dtype=np.uint8)
    Image.fromarray(rgb).resize((WIDTH * 3, HEIGHT * 3), Image.Resampling.BICUBIC).save(path)
    return path


def test_a_packed_project_opens(editor: EditorPage, tmp_path: Path) -> None:
    packed = pack_project(make_project(tmp_path / "elsewhere" / "attic"), tmp_path / "attic.diorama")
    drop(editor, packed)
    editor.notice("Opened attic from attic.diorama.")
    editor.until(lambda: editor.session.project.folder.name == "attic", "the project", seconds=90)


def test_a_photo_with_boxes_then_its_depth(editor: EditorPage, tmp_path: Path) -> None:
    boxes = tmp_path / "labels.json"
    boxes.write_bytes(boxes_json(box(30, 60, 180, 270), box(200, 90, 400, 400), box(5, 200, 90, 300)))
    drop(editor, photo(tmp_path / "room.png"), boxes)
    editor.notice("2 files.zip: a photo (room.png) with boxes (list of boxes)")
    editor.until(lambda: editor.session.is_unbuilt, "a project of its own", seconds=90)
    editor.until(lambda: len(editor.session.inputs.boxes) == 3, "with its boxes")
    editor.at_board()
    keep_picture(editor, "dropped-photo-and-boxes")
    inverse = tmp_path / "d.npy"
    np.save(inverse, 20 / room()[0] + 1.3)
    drop(editor, inverse)
    asked = editor.page.get_by_text("How should the depth be read?")
    expect(asked).to_be_visible(timeout=LEARN_MS)
    keep_picture(editor, "dropped-depth-asked")
    editor.page.get_by_role("button", name="Inverse depth").click()
    editor.until(lambda: editor.session.inputs.depth_m is not None, "read as it was answered", seconds=90)
    assert editor.session.project.info()["depth_kind"] == "inverse"


def test_confidence_is_dropped_onto_its_depth(editor: EditorPage, tmp_path: Path) -> None:
    depth, levels = tmp_path / "depth.png", tmp_path / "confidence.png"
    depth.write_bytes(depth_png(room()[0] * 1000))
    Image.fromarray(np.repeat(np.uint8(2 * (np.arange(HEIGHT) >= 40))[:, None], WIDTH, axis=1)).save(levels)
    drop(editor, photo(tmp_path / "room.png"), depth)
    editor.notice("a photo (room.png) with a depth map")
    editor.until(lambda: editor.session.inputs.depth_m is not None, "photo and depth", seconds=90)
    editor.until(lambda: "depth" in editor.session.project.uploads(), "kept")
    editor.at_board()  # the page of the new project is there: what is dropped on its way to it is lost
    drop(editor, levels)
    editor.notice("25% of the depth is unsure by confidence.png, and left out.")
    keep_picture(editor, "dropped-confidence")
    measured = editor.session.inputs.depth_m > 0
    assert not measured[:115].any()
    assert measured[125:].all()


def test_a_bent_photo_is_straightened_and_left_bent_when_asked(editor: EditorPage, tmp_path: Path) -> None:
    Image.fromarray(bent(lines(), -0.15)).save(tmp_path / "wide.png")
    drop(editor, tmp_path / "wide.png")
    editor.until(lambda: editor.session.inputs.photo.straightened is not None, "straightened", seconds=90)
    expect(editor.page.get_by_text("because its lens bends straight lines")).to_be_visible(timeout=LEARN_MS)
    keep_picture(editor, "straightened-photo")
    editor.page.get_by_role("button", name="Undo straightening").click()
    editor.until(lambda: editor.session.inputs.photo.straightened is None, "as its file has it", seconds=90)
    expect(editor.page.get_by_text("because its lens bends straight lines")).not_to_be_visible()
    keep_picture(editor, "bent-photo")


def test_an_upside_down_photo_is_turned(editor: EditorPage, tmp_path: Path) -> None:
    rugs = [box(x, 10, x + 90, 90, word="rug") for x in (20, 150, 280)]
    labels = tmp_path / "room.json"
    labels.write_bytes(boxes_json(*rugs, box(150, 400, 250, 470, word="ceiling lamp")))
    drop(editor, photo(tmp_path / "room.png"), labels)
    editor.until(lambda: len(editor.session.inputs.boxes) == 4, "with its boxes", seconds=90)
    expect(editor.page.get_by_text("The photo seems to be upside down.", exact=True)).to_be_visible(timeout=LEARN_MS)
    keep_picture(editor, "upside-down-photo")
    editor.page.get_by_role("button", name="Turn photo").click()
    editor.until(lambda: bool(editor.session.inputs.photo.half_turned), "turned", seconds=90)
    assert editor.session.inputs.boxes[0].box[1] > 380
    expect(editor.page.get_by_text("The photo seems to be upside down.", exact=True)).not_to_be_visible()
    keep_picture(editor, "turned-photo")


def test_a_folder_of_photos(editor: EditorPage, tmp_path: Path) -> None:
    folder = tmp_path / "holiday"
    folder.mkdir()
    for number in range(3):
        photo(folder / f"p{number}.jpg", number)
    (folder / "readme.md").write_text("x")
    drop(editor, folder)
    expect(editor.page.get_by_text("What is holiday.zip?")).to_be_visible(timeout=LEARN_MS)
    expect(editor.page.get_by_text("Left out: readme.md")).to_be_visible()
    keep_picture(editor, "dropped-folder-asked")
    editor.page.get_by_role("button", name="3 photos of different rooms, a project each").click()
    editor.until(lambda: editor.session.project.folder.name == "p0", "the first is open", seconds=90)
    assert {"p0", "p1", "p2"} <= {p.name for p in editor.session.project.folder.parent.iterdir()}


def test_a_dropped_model_is_placed(editor: EditorPage, tmp_path: Path) -> None:
    trimesh.creation.box((0.4, 0.5, 0.9)).export(tmp_path / "cupboard.glb")
    drop(editor, tmp_path / "cupboard.glb")
    editor.until(lambda: isinstance(editor.client.doing, Placing), "it is read", seconds=90)
    expect(editor.page.get_by_text("Click where to place it")).to_be_visible(timeout=LEARN_MS)
    editor.click_world(np.array([0.9, 0.4, 0.0]))
    editor.until(lambda: len(editor.running.session.scene.objects) == 6, "placed")
