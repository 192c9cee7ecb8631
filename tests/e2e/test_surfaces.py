"""Walls, floor and ceiling are finished, by a click on them or from the list; undone, saved and exported."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_core.project.storage import Project
from diorama_core.scene.types import Plane, SurfaceFinish
from tests.e2e.browser import EditorPage
from tests.e2e.test_handles_and_supports import at_rest

pytestmark = pytest.mark.browser


def plane(editor: EditorPage, plane_id: str) -> Plane:
    return editor.running.session.scene.plane(plane_id)


def finish(editor: EditorPage, plane_id: str) -> SurfaceFinish:
    found = plane(editor, plane_id).finish
    assert found is not None
    return found


def test_a_click_on_the_floor_offers_finishes_which_are_seen_undone_saved_and_exported(
    editor: EditorPage, tmp_path: Path
) -> None:
    session = editor.running.session
    editor.page.keyboard.press("t")
    spot = np.array([-1.6, -0.2, 0.0])
    at_rest(editor, spot)
    editor.click_world(spot)
    editor.until(lambda: editor.client.surface == "floor", "the floor is chosen")
    before = editor.mean_colour(spot)
    editor.page.locator(".dio .tile:visible", has_text="Chequered").click()
    editor.until(lambda: plane(editor, "floor").finish is not None, "finished")
    editor.page.get_by_role("button", name="Blue", exact=True).click()
    editor.until(lambda: plane(editor, "floor").colour[2] > plane(editor, "floor").colour[0], "blue")
    direction = editor.page.get_by_label("Direction (°)").locator("visible=true").first
    direction.fill("30")
    direction.press("Enter")
    editor.until(lambda: abs(finish(editor, "floor").direction_rad - np.pi / 6) < 1e-9, "turned")
    editor.settle()
    after = editor.mean_colour(spot, 12)
    assert after[0] - after[2] < before[0] - before[2] - 20, "bluer tiles are seen"
    session.autosave.flush()
    saved = Project.open(session.project.folder)
    assert saved.load_scene().plane("floor").finish == finish(editor, "floor")
    assert saved.texture(plane(editor, "floor").texture or "") is not None
    editor.tab("Export")
    with editor.page.expect_download() as download:
        editor.button("Export .glb").click()
    download.value.save_as(tmp_path / "room.glb")
    document = glb_json((tmp_path / "room.glb").read_bytes())
    floor = next(n for n in document["nodes"] if n["name"] == "floor")
    used = {p["material"] for p in document["meshes"][floor["mesh"]]["primitives"]}
    assert any("baseColorTexture" in document["materials"][m]["pbrMetallicRoughness"] for m in used)
    editor.tab("Object")
    for _ in range(3):
        editor.page.keyboard.press("Control+z")
    editor.until(lambda: plane(editor, "floor").finish is None, "undone step by step")
    assert plane(editor, "floor").colour == pytest.approx((0.72, 0.6, 0.47))


def test_all_walls_are_papered_from_the_list_and_go_back_to_the_photo(editor: EditorPage) -> None:
    editor.unfold("Room", editor.page.locator(".dio button:visible", has_text="Wall 2")).click()
    editor.until(lambda: editor.client.surface == "wall_2")
    editor.button("All walls").click()
    editor.page.locator(".dio .tile:visible", has_text="Leaves").click()
    walls = [f"wall_{n}" for n in range(1, 5)]
    editor.until(lambda: all(plane(editor, w).finish is not None for w in walls), "all four")
    size = editor.page.get_by_label("Size (%)").locator("visible=true").first
    size.fill("much")
    size.press("Enter")
    editor.notice("is not a number")
    expect(size).to_have_value("100")
    size.fill("200")
    size.press("Enter")
    editor.until(lambda: all(finish(editor, w).scale == 2.0 for w in walls))
    editor.settle()
    editor.picture(Path(str(editor.running.session.projects_dir)) / "walls.png")
    editor.page.locator(".dio [data-do=before]:visible").click()  # light has a button of this name, too
    editor.until(lambda: all(plane(editor, w).finish is None for w in walls), "back")
    assert plane(editor, "wall_1").colour == pytest.approx((0.9, 0.89, 0.86))
    editor.page.keyboard.press("Escape")
    editor.until(lambda: editor.client.surface is None)


def glb_json(data: bytes) -> dict:
    length = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20 : 20 + length])
