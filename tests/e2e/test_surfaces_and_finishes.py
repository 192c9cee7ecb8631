"""Points 3 and 4: size by handles, mirror and even gaps, finishes that go into the GLB, alternatives in their paint."""

from __future__ import annotations

import itertools
import json
import struct
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_core.editing.stretching import HANDLES, handle_place
from diorama_core.scene.types import Scene
from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser
BY_NAME = {h.name: h for h in HANDLES}


def scene(editor: EditorPage) -> Scene:
    return editor.running.session.scene


def handle_at(editor: EditorPage, object_id: str, name: str, further_m: float = 0.0) -> np.ndarray:
    """Where a handle of an object is, or would be when pulled further."""
    item = scene(editor).object(object_id)
    outward = item.pose.R_world_object @ np.sign(BY_NAME[name].along)
    place = item.pose.R_world_object @ handle_place(item, BY_NAME[name], 0.04)
    return item.pose.position + place + further_m * outward


def choose(editor: EditorPage, label: str, object_id: str) -> None:
    editor.row(label).click()
    editor.until(lambda: editor.selection == (object_id,))
    editor.settle()


def test_handles_stretch_one_side_and_take_along_what_stands_on_top(editor: EditorPage) -> None:
    editor.page.keyboard.press("f")
    choose(editor, "dining table", "table_1")
    editor.page.keyboard.press("f")
    editor.settle()
    editor.page.keyboard.press("3")
    editor.page.wait_for_function("!!window.__viserMutable.nodeRefFromName['/size/top']")
    before = scene(editor)
    start = editor.place_of(handle_at(editor, "table_1", "top"))
    assert editor.on_canvas(*start)
    editor.drag(start, editor.place_of(handle_at(editor, "table_1", "top", 0.2)))
    editor.until(lambda: scene(editor) is not before, "pulled")
    table, lamp = (scene(editor).object(i) for i in ("table_1", "lamp_1"))
    assert table.size_m[2] - before.object("table_1").size_m[2] == pytest.approx(0.2, abs=0.05)
    assert lamp.corners_world[:, 2].min() == pytest.approx(table.corners_world[:, 2].max(), abs=1e-6)
    assert editor.running.session.document.history.current.label == "resize dining table"
    node = editor.running.session.viewport.node_name("table_1")
    editor.settle()
    shown = editor.page.evaluate(f"window.__viserMutable.nodeRefFromName['{node}'].position.z")
    assert shown == pytest.approx(table.pose.position[2], abs=1e-4), "as the document says"
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: scene(editor) == before, "one undo step")


def test_esc_puts_a_pulled_handle_back_and_snapping_keeps_to_the_grid(editor: EditorPage) -> None:
    choose(editor, "dining table", "table_1")
    editor.page.keyboard.press("f")
    editor.page.keyboard.press("3")
    editor.page.wait_for_function("!!window.__viserMutable.nodeRefFromName['/size/corner']")
    editor.settle()
    before = scene(editor)
    start = editor.place_of(handle_at(editor, "table_1", "corner"))
    end = editor.place_of(handle_at(editor, "table_1", "corner", 0.15))
    node = editor.running.session.viewport.node_name("table_1")
    height = f"window.__viserMutable.nodeRefFromName['{node}'].position.z"
    editor.pull(start, end)
    editor.page.wait_for_function(f"{height} > {before.object('table_1').pose.position[2] + 0.03}")
    editor.page.keyboard.press("Escape")
    editor.page.mouse.up()
    editor.page.wait_for_function(f"Math.abs({height} - {before.object('table_1').pose.position[2]}) < 1e-4")
    assert scene(editor) is before
    choose(editor, "dining table", "table_1")
    editor.page.keyboard.press("n")
    editor.until(lambda: editor.client.preferences.snap)
    editor.settle()
    start = editor.place_of(handle_at(editor, "table_1", "top"))
    editor.drag(start, editor.place_of(handle_at(editor, "table_1", "top", 0.11)))
    editor.until(lambda: scene(editor) is not before, "pulled")
    assert scene(editor).object("table_1").size_m[2] % 0.05 == pytest.approx(0.0, abs=1e-6) or (
        scene(editor).object("table_1").size_m[2] % 0.05 == pytest.approx(0.05, abs=1e-6)
    )


def test_three_are_spread_evenly_mirrored_and_turned(editor: EditorPage) -> None:
    rows = (("chair", []), ("dining table", ["Shift"]), ("chair <b>by the window</b>", ["Shift"]))
    for count, (label, more) in enumerate(rows, start=1):
        editor.row(label).click(modifiers=more)
        editor.until(lambda wanted=count: len(editor.selection) == wanted)
    editor.page.get_by_role("button", name="Distribute evenly").click()
    editor.until(lambda: editor.running.session.document.history.current.label == "distribute evenly")
    spans = sorted(
        (c[:, 0].min(), c[:, 0].max())
        for c in (scene(editor).object(i).corners_world for i in ("chair_1", "table_1", "chair_2"))
    )
    gaps = [after[0] - before[1] for before, after in itertools.pairwise(spans)]
    assert gaps[0] == pytest.approx(gaps[1], abs=1e-6)
    before = {i: scene(editor).object(i).pose.position[0] for i in ("chair_1", "chair_2")}
    editor.page.keyboard.press("Shift+M")
    editor.until(lambda: editor.running.session.document.history.current.label == "mirror 3 objects")
    after = {i: scene(editor).object(i).pose.position[0] for i in before}
    assert np.sign(before["chair_1"] - before["chair_2"]) == -np.sign(after["chair_1"] - after["chair_2"])
    yaw = scene(editor).object("chair_1").pose.yaw_rad
    choose(editor, "chair", "chair_1")
    editor.page.keyboard.press("j")
    editor.until(lambda: scene(editor).object("chair_1").pose.yaw_rad != yaw)
    turned = np.degrees(scene(editor).object("chair_1").pose.yaw_rad - yaw)
    assert (turned + 360) % 360 == pytest.approx(15.0, abs=1e-6)


def test_paint_and_finish_are_seen_undone_and_in_the_glb(editor: EditorPage, tmp_path: Path) -> None:
    session = editor.running.session
    choose(editor, "dining table", "table_1")
    shown = session.viewport.mesh_name("table_1")
    editor.button("Metal").click()
    editor.until(lambda: scene(editor).object("table_1").finish == "metal")
    editor.until(lambda: session.viewport.mesh_name("table_1") != shown, "the picture follows")
    expect(editor.button("Metal")).to_have_class("on")
    colour = editor.page.locator(".mantine-Flex-root", has_text="Colour").locator("input").first
    colour.fill("rgb(20, 60, 200)")
    colour.press("Enter")
    editor.until(lambda: scene(editor).object("table_1").colour == pytest.approx((20 / 255, 60 / 255, 200 / 255)))
    editor.tab("Export")
    with editor.page.expect_download() as download:
        editor.button("Export .glb").click()
    download.value.save_as(tmp_path / "room.glb")
    document = glb_json((tmp_path / "room.glb").read_bytes())
    node = next(n for n in document["nodes"] if n.get("extras", {}).get("id") == "table_1")
    used = {p["material"] for p in document["meshes"][node["mesh"]]["primitives"]}
    finishes = [document["materials"][m]["pbrMetallicRoughness"] for m in used]
    assert any(one.get("metallicFactor", 1.0) == 0.75 and one["baseColorFactor"][2] > 0.4 for one in finishes)
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: scene(editor).object("table_1").colour is None)
    assert scene(editor).object("table_1").finish == "metal"
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: scene(editor).object("table_1").finish is None)


def test_alternatives_are_pictured_in_the_colour_that_is_retained(editor: EditorPage) -> None:
    choose(editor, "chair", "chair_1")
    tile = editor.page.locator(".dio .tile:visible", has_text="chair b").locator("img")
    expect(tile).to_be_visible()
    plain = tile.get_attribute("src")
    colour = editor.page.locator(".mantine-Flex-root", has_text="Colour").locator("input").first
    colour.fill("rgb(20, 160, 40)")
    colour.press("Enter")
    editor.until(lambda: scene(editor).object("chair_1").colour is not None)
    expect(tile).not_to_have_attribute("src", plain or "")
    editor.button("Keep colour").click()
    expect(tile).to_have_attribute("src", plain or "")


def glb_json(data: bytes) -> dict:
    length = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20 : 20 + length])
