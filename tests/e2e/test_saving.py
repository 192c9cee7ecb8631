"""Points 6 and 10: the photo's camera put right, unsaved changes restored."""

from __future__ import annotations

import os
import time
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_app.session.recovery import Recovery
from diorama_core.geometry.rotations import CameraAttitude
from diorama_core.scene import edits
from tests.app.small_room import furnished_scene, make_project
from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser


def test_height_rescales_at_once_and_field_of_view_and_tilt_build_again(editor: EditorPage) -> None:
    session = editor.running.session
    before = session.scene
    editor.tab("Photo")
    editor.page.get_by_text("Camera and floor").click()
    height = editor.page.get_by_label("Camera height")
    expect(height).to_have_value("1.5 m")
    height.fill("3 m")
    height.press("Tab")
    editor.until(lambda: session.scene.camera.position[2] == pytest.approx(3.0), "twice as large")
    assert session.scene.object("table_1").size_m[0] == pytest.approx(2 * before.object("table_1").size_m[0])
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: session.scene == before, "one undo step")
    expect(height).to_have_value("1.5 m")  # the list is still open
    for label, value in (("Field of view (°)", "60"), ("Tilt down (°)", "15")):
        field = editor.page.get_by_label(label)
        field.fill(value)
        field.press("Tab")
        expect(field).to_have_value(f"{value}.0")
    editor.page.wait_for_function("!!window.__viserMutable.nodeRefFromName['/photo_evidence']")
    editor.button("Rebuild with this camera").click()
    editor.until(lambda: session.jobs.status is None and session.scene != before, "built again", seconds=120)
    camera = session.scene.camera
    assert np.degrees(camera.intrinsics.horizontal_fov_rad) == pytest.approx(60.0, abs=1e-6)
    assert np.degrees(CameraAttitude.of(camera.T_world_camera[:3, :3]).pitch_rad) == pytest.approx(15.0, abs=1e-6)
    assert [o.category for o in session.scene.objects] == ["table"]
    assert session.document.history.current.label == "set the camera"
    outlined = list(session.project.stages_folder.glob("objects-*.zip"))
    assert len(outlined) == 1
    first = outlined[0].stat().st_ino
    expect(editor.page.get_by_label("Field of view (°)")).to_have_value("60.0")
    editor.settle()
    editor.page.get_by_label("Field of view (°)").fill("70")
    editor.page.get_by_label("Field of view (°)").press("Tab")
    now = session.scene
    editor.button("Rebuild with this camera").click()
    editor.until(lambda: session.jobs.status is None and session.scene != now, "and again", seconds=120)
    again = list(session.project.stages_folder.glob("objects-*.zip"))
    assert [p.stat().st_ino for p in again] == [first], "what is not downstream did not run again"
    editor.page.keyboard.press("Control+z")
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: session.scene == before, "everything comes back")


def test_what_an_earlier_session_could_not_save_is_restored(editor: EditorPage, tmp_path: Path) -> None:
    session = editor.running.session
    project = make_project(tmp_path / "projects" / "crashed")
    crashed = Recovery(session.autosave.recovery._folder)
    lost = edits.rename(furnished_scene(), "chair_1", "throne")
    crashed.note(project, lost)
    minute_ago = time.time() - 60.0
    os.utime(project.scene_path, (minute_ago - 60.0, minute_ago - 60.0))
    (kept,) = crashed._folder.glob(f"*-{crashed._session}-*.json")
    os.utime(kept, (minute_ago, minute_ago))
    session.ui_thread.post(lambda: session.open_project(project))
    expect(editor.page.get_by_text("were not saved when Diorama ended")).to_be_visible()
    editor.button("Restore unsaved changes").click()
    editor.until(lambda: session.scene == lost, "restored")
    expect(editor.row("throne")).to_be_visible()
    expect(editor.button("Restore unsaved changes")).to_have_count(0)
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: session.scene == furnished_scene(), "as one undo step")
