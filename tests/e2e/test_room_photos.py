"""Add a photo of this room: it joins the scene, its camera is in the view, and one undo takes it back."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from diorama_core.artefacts import FurtherPhoto
from diorama_core.multiview import adding
from diorama_core.perception.inputs import read_inputs
from diorama_core.project.further_photos import save_photos
from tests.app.small_room import PlainLibrary, make_project
from tests.e2e.browser import LEARN_MS, EditorPage
from tests.e2e.conftest import StartServer, keep_picture
from tests.few_shapes import few_shapes
from tests.multiview.spheres import sphere_with_wardrobe
from tests.multiview.two_photos import SMALL, project_of, two_photos, with_camera

pytest.importorskip("pycolmap", reason="needs pycolmap (pip install 'diorama[photos]')")
pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.fixture(autouse=True)
def _few_distances(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three distances between the cameras are tried, not thirteen: the tests ask what the page makes of them."""
    monkeypatch.setattr(adding, "DISTANCES", (0.8, 1.0, 1.25))


def test_a_photo_of_the_same_room_is_added_looked_through_and_undone(
    serve: StartServer, visit: Callable[..., EditorPage], tmp_path: Path
) -> None:
    photos = two_photos()
    project = project_of(photos, tmp_path / "projects" / "room")
    Image.fromarray(photos.second.photo.rgb).save(tmp_path / "beside.png")
    editor = visit(serve(project.folder, few_shapes(photos.scene)))
    before = editor.session.scene
    editor.tab("Photo")
    editor.upload("Add a photo of this room", tmp_path / "beside.png")
    editor.at_board()
    assert editor.session.scene is before
    for box in photos.second.boxes[:2]:  # as a person would: a rectangle, then another name
        count = len(editor.session.further_photos[0].inputs.boxes)
        editor.draw_box(box.box)
        editor.until(lambda c=count: len(editor.session.further_photos[0].inputs.boxes) == c + 1, "drawn")
        name = editor.page.locator("#dio-box-name")
        name.fill(box.label)
        name.press("Enter")
        editor.until(lambda w=box.label: editor.session.further_photos[0].inputs.boxes[-1].label == w, "named")
    marked = replace(editor.client.inputs, boxes=photos.second.boxes)
    editor.session.ui_thread.post(lambda: editor.client.annotate("mark the others", marked))
    editor.until(lambda: editor.client.inputs.boxes == photos.second.boxes, "marked")
    editor.settle()
    keep_picture(editor, "room-photos-marked")
    editor.button("Add to the scene").click()
    editor.until(lambda: editor.session.further_photos[0].camera is not None, "joined", LEARN_MS / 1000)
    scene = editor.session.scene
    new = [o for o in scene.objects if not before.has_object(o.id)]
    assert {o.category for o in new} >= set(photos.missing)
    assert {o.id for o in before.objects} <= {o.id for o in scene.objects}
    editor.settle()
    keep_picture(editor, "room-photos-joined")
    editor.page.locator('.dio .tile[data-arg="beside"]').click()
    editor.until(lambda: editor.client.view.camera.through_photo, "looked through")
    editor.settle()
    keep_picture(editor, "room-photos-through")
    editor.tool("Room").click()
    editor.settle()
    keep_picture(editor, "room-photos-cameras")
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: editor.session.scene == before, "undone in one step")
    expect(editor.page.locator('.dio .tile[data-arg="beside"]')).to_contain_text("not in the scene yet")


def test_a_rebuild_keeps_the_other_photo_of_the_room(
    serve: StartServer, visit: Callable[..., EditorPage], tmp_path: Path
) -> None:
    photos = two_photos(SMALL)
    project = project_of(photos, tmp_path / "projects" / "room")
    boxes = {b.label.replace(" ", "_"): b.box for b in photos.second.boxes}
    seen = tuple((name, box) for name, box in boxes.items() if photos.scene.has_object(name))
    save_photos(project, (replace(with_camera(photos), seen=seen),))
    editor = visit(serve(project.folder, few_shapes(photos.scene)))
    before = editor.session.scene
    (beside,) = editor.session.further_photos
    assert beside.camera is not None
    editor.tab("Photo")
    editor.page.get_by_text("Camera and floor").click()
    field = editor.page.get_by_label("Field of view (°)")
    field.fill(f"{np.degrees(before.camera.intrinsics.horizontal_fov_rad) + 0.4:.1f}")
    field.press("Tab")
    editor.button("Rebuild with this camera").click()
    editor.until(
        lambda: editor.session.jobs.status is None and editor.session.scene != before, "built again", LEARN_MS / 1000
    )
    expect(editor.page.get_by_text("Building with this camera")).to_be_hidden(timeout=LEARN_MS)
    (again,) = editor.session.further_photos
    scene = editor.session.scene
    assert editor.session.document.history.current.label == "set the camera"
    assert again is not beside
    assert again.camera is not None, "it joined the new scene"
    assert len(again.seen) >= 4
    assert all(scene.has_object(name) for name, _ in again.seen)
    tile = editor.page.locator('.dio .tile[data-arg="beside"]')
    expect(tile).to_be_visible()
    expect(tile).not_to_contain_text("not in the scene yet")
    editor.settle()
    keep_picture(editor, "room-photos-rebuilt")
    tile.click()
    editor.until(lambda: editor.client.view.camera.through_photo, "looked through")
    editor.settle()
    keep_picture(editor, "room-photos-rebuilt-through")
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: editor.session.scene == before, "undone in one step")


def test_a_360_degree_photo_is_marked_and_looked_around_in(
    serve: StartServer, visit: Callable[..., EditorPage], tmp_path: Path
) -> None:
    project = make_project(tmp_path / "projects" / "room")
    Image.open(io.BytesIO(sphere_with_wardrobe(1.4)[0])).save(tmp_path / "all.png")
    inputs = read_inputs(tmp_path / "all.png", sphere=True).inputs
    at = np.eye(4)
    at[:3, 3] = (0.0, 0.0, 1.4)
    save_photos(project, (FurtherPhoto("all", inputs, T_world_sphere=at),))
    editor = visit(serve(project.folder, library=PlainLibrary()))
    editor.tab("Photo")
    editor.page.locator('.dio .tile[data-arg="all"]').click()
    editor.until(lambda: editor.client.view.camera.through_photo, "looked around")
    editor.settle()
    first = editor.client.viewpoint[0]
    assert first is not None
    left, top, width, height = editor.canvas_box()
    middle = (left + width / 2, top + height / 2)
    editor.drag(middle, (middle[0] - width / 5, middle[1]))
    ahead = first.T_world_camera[:3, 2]
    editor.until(lambda: editor.client.viewpoint[0].T_world_camera[:3, 2] @ ahead < 0.98, "turned")
    assert np.linalg.norm(editor.client.view.camera.position - at[:3, 3]) < 0.01
    keep_picture(editor, "sphere-turned")
    editor.button("Mark furniture").click()
    editor.at_board()
    editor.draw_box((300.0, 220.0, 420.0, 330.0))
    editor.until(lambda: len(editor.session.further_photos[0].inputs.boxes) == 1, "drawn")
    box = editor.session.further_photos[0].inputs.boxes[0].box
    assert box == pytest.approx((300.0, 220.0, 420.0, 330.0), abs=4.0)
    expect(editor.button("Build the whole room (1)")).to_be_enabled()
    keep_picture(editor, "sphere-marked")
