"""Put right what was guessed: the room's height and walls, an object's box, an uploaded model, an earlier version."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
import viser
from playwright.sync_api import expect

from diorama_core.scene import edits
from diorama_core.scene.room_edits import ceiling_height
from diorama_core.scene.types import Scene
from tests.e2e.browser import LEARN_MS, EditorPage

pytestmark = pytest.mark.browser


def scene(editor: EditorPage) -> Scene:
    return editor.running.session.scene


def test_the_room_becomes_higher_and_what_hangs_on_a_moved_wall_goes_with_it(editor: EditorPage) -> None:
    height = editor.unfold("Room", editor.page.get_by_label("Height", exact=True))
    expect(height).to_have_value("2.5 m")
    height.fill("2.9")
    height.press("Enter")
    editor.until(lambda: abs((ceiling_height(scene(editor)) or 0.0) - 2.9) < 1e-6, "higher")
    expect(height).to_have_value("2.9 m")  # drawn anew: what is typed from here on stays
    picture = scene(editor).object("picture_1").pose.position
    wall = editor.page.get_by_label("Wall 3", exact=True)
    wall.fill("40 cm")
    wall.press("Enter")
    editor.until(lambda: scene(editor).plane("wall_3").polygon[:, 1].min() > 3.7, "the wall is further away")
    np.testing.assert_allclose(scene(editor).object("picture_1").pose.position - picture, (0.0, 0.4, 0.0), atol=1e-6)
    editor.page.keyboard.press("Escape")
    for _ in range(2):
        editor.tool("Undo").click()
    editor.until(lambda: ceiling_height(scene(editor)) == pytest.approx(2.5), "two steps back")


def test_a_box_is_redrawn_on_the_photo_and_its_object_is_looked_at_again(editor: EditorPage) -> None:
    session = editor.running.session
    editor.tab("Photo")
    editor.page.locator(".dio .row[data-do=mark]", has_text="dining table").click()
    editor.button("Add selected box to the scene").click()
    editor.until(lambda: session.jobs.status is None and len(editor.selection) == 1, "added", seconds=90)
    editor.settle()
    added = session.scene.object(editor.selection[0])
    others = [o for o in session.scene.objects if o.id != added.id]
    editor.button("Redraw box").click()
    editor.at_board()
    editor.settle()
    corners = np.array([[250.0, 210.0], [400.0, 410.0]])
    editor.draw_box((250.0, 210.0, 400.0, 410.0))
    label = f"reconstruct {added.label}"
    editor.until(lambda: session.document.history.current.label == label, "looked at again", seconds=90)
    again = session.scene.object(added.id)
    np.testing.assert_allclose(np.array(again.box_px).reshape(2, 2), corners, atol=4.0)
    assert [o for o in session.scene.objects if o.id != added.id] == others, "everything else stays"
    assert not editor.client.view.canvas.is_open
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: session.scene.object(added.id) == added, "undone")


def test_an_uploaded_model_is_clicked_into_the_room(editor: EditorPage, tmp_path: Path) -> None:
    session = editor.running.session
    trimesh.creation.box((1.8, 0.6, 0.3)).export(tmp_path / "bookcase.glb")
    editor.tab("Library")
    editor.upload("Add a model file", tmp_path / "bookcase.glb")
    expect(editor.page.get_by_text("Click where to place it")).to_be_visible(timeout=LEARN_MS)
    editor.click_world(np.array([1.1, 0.3, 0.0]))
    editor.until(lambda: len(scene(editor).objects) == 6, "placed")
    placed = scene(editor).object(editor.selection[0])
    assert placed.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    editor.tab("Object")
    expect(editor.page.get_by_text("Your model")).to_be_visible()
    node = str(session.viewport.node_name(placed.id))
    editor.page.wait_for_function(
        f"Object.keys(window.__viserMutable.nodeRefFromName).some(n => n.startsWith('{node}/v'))"
    )


def test_an_earlier_version_comes_back_as_one_undo_step(editor: EditorPage) -> None:
    session = editor.running.session
    before = scene(editor)
    editor.row("lamp").click()
    editor.page.keyboard.press("Delete")
    editor.until(lambda: session.project is not None and bool(session.project.backups()), "the version before is kept")
    editor.tab("Project")
    editor.page.get_by_text("Earlier versions").click()
    editor.button("Restore this version").first.click()
    editor.until(lambda: scene(editor) == before, "everything is there again")
    editor.tab("Scene")
    expect(editor.row("lamp")).to_be_visible()
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: not scene(editor).has_object("lamp_1"), "one step")


def test_views_focus_and_selecting_by_keys(editor: EditorPage) -> None:
    session, view = editor.running.session, editor.client.viser_client.camera
    for button, back in (("Top view", (0, 0, 1)), ("Front view", (0, -1, 0)), ("Left view", (-1, 0, 0))):
        editor.menu_tool(button).click()
        editor.until(lambda b=back: _direction(view) @ np.array(b) > 0.99, button)
        assert editor.client.view.camera.fov_rad < 0.2, "lines that are parallel in the room nearly are on the screen"
    editor.tool("Room").click()
    editor.row("lamp").click()
    editor.page.keyboard.press("f")
    lamp = scene(editor).object("lamp_1").pose.position
    editor.until(lambda: np.linalg.norm(np.asarray(view.look_at) - lamp) < 0.05, "the lamp is in the middle")
    editor.page.keyboard.press("Control+i")
    editor.until(lambda: len(editor.selection) == 4 and "lamp_1" not in editor.selection, "all but the lamp")
    editor.page.keyboard.press("Control+a")
    editor.until(lambda: len(editor.selection) == 5, "everything")
    editor.row("lamp").click()
    editor.until(lambda: editor.selection == ("lamp_1",))
    lifted = scene(editor).object("lamp_1").pose.move((0.0, 0.0, 0.2))
    session.ui_thread.post(lambda: session.edit("lift", lambda s: edits.move(s, "lamp_1", lifted)))
    editor.until(lambda: scene(editor).object("lamp_1").pose == lifted)
    editor.page.keyboard.press("g")
    editor.until(
        lambda: abs(scene(editor).object("lamp_1").corners_world[:, 2].min() - 0.74) < 1e-6, "down on the table"
    )
    yaw = scene(editor).object("lamp_1").pose.yaw_rad
    editor.page.keyboard.press("j")
    editor.until(lambda: abs(scene(editor).object("lamp_1").pose.yaw_rad - yaw - np.radians(15)) < 1e-6, "turned")
    editor.page.keyboard.press("Control+x")
    editor.until(lambda: not scene(editor).has_object("lamp_1"), "cut")
    editor.page.keyboard.press("Control+v")
    editor.until(lambda: len(scene(editor).objects) == 5, "pasted")


def _direction(camera: viser.CameraHandle) -> np.ndarray:
    """From where it looks to the camera, as a unit vector."""
    back = np.asarray(camera.position) - np.asarray(camera.look_at)
    return back / np.linalg.norm(back)
