"""Point 1: what was read from the photo over it, the room's edges, marks for what is wrong or unsure."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture

pytestmark = pytest.mark.browser

BOX = (240.0, 200.0, 440.0, 420.0)
"""Of the brown thing in the small room's photo."""


THERE = "window.__viserMutable.nodeRefFromName['/photo_evidence']"
GONE = f"!{THERE}"
EDGES = "Object.entries(window.__viserMutable.nodeRefFromName).filter(([n, o]) => o && /planes.*edges/.test(n)).length"


def seen_in_photo(scene: Scene) -> Scene:
    """The table was found where the photo is brown, its place hardly supported."""

    def found(item):
        return replace(item, box_px=BOX, confidence=0.2) if item.id == "table_1" else item

    return replace(scene, objects=tuple(found(o) for o in scene.objects))


def test_outlines_lie_over_the_photo_and_the_selected_one_is_orange(editor: EditorPage) -> None:
    session = editor.running.session
    session.ui_thread.post(lambda: session.edit("found", seen_in_photo))
    editor.until(lambda: session.scene.object("table_1").box_px == BOX)
    editor.menu_tool("Outlines").click()
    editor.until(lambda: session.jobs.status is None and editor.client.preferences.masks, "outlined", seconds=60)
    assert editor.client.view.camera.through_photo, "outlines are seen through the photo's camera"
    editor.page.wait_for_function(THERE)
    camera = session.scene.camera
    assert camera is not None
    inside = camera.position + camera.rays(np.array([300.0, 380.0])) * 0.11
    editor.settle()
    plain = editor.mean_colour(inside)
    editor.row("dining table").click()
    editor.until(lambda: editor.selection == ("table_1",))
    editor.settle()
    differs = "the tint of the selected outline differs"
    editor.until(lambda: np.abs(editor.mean_colour(inside) - plain).max() > 12, differs)
    orange = editor.mean_colour(inside)
    assert orange[0] > orange[2] + 40, "and is orange"
    editor.page.keyboard.press("o")
    editor.page.wait_for_function(GONE)
    editor.page.keyboard.press("o")
    editor.page.wait_for_function(THERE)
    editor.page.keyboard.press("r")
    editor.page.wait_for_function(GONE)


def test_planes_show_their_edges_and_follow_a_moved_wall(editor: EditorPage) -> None:
    editor.menu_tool("Planes").click()
    count = len(editor.running.session.scene.architecture.planes)
    editor.page.wait_for_function(f"{EDGES} == {count}")
    editor.page.keyboard.press("p")
    editor.until(lambda: editor.client.view.camera.through_photo)
    editor.page.wait_for_function(THERE)
    editor.page.keyboard.press("y")
    editor.page.wait_for_function(f"{EDGES} == 0 && {GONE}")


def test_what_floats_and_what_is_unsure_is_marked_in_the_view_and_in_the_list(editor: EditorPage) -> None:
    session = editor.running.session
    lifted = session.scene.object("chair_1").pose.move((0.0, 0.0, 0.4))
    session.ui_thread.post(lambda: session.edit("found", lambda s: edits.move(seen_in_photo(s), "chair_1", lifted)))
    editor.until(lambda: session.badges.get("chair_1") == ("floats",), "it floats")
    expect(editor.page.locator('.dio .row[data-arg="chair_1"] .chip')).to_have_text("floats")
    expect(editor.page.locator('.dio .row[data-arg="table_1"] .chip')).to_have_text("uncertain")
    table, chair = (str(session.viewport.node_name(i)) for i in ("table_1", "chair_1"))
    for name, sign in ((table, "?"), (chair, "⚠")):
        assert editor.client.viser_client.scene._handle_from_node_name[f"{name}/mark/tag"].text == sign
    over = session.scene.object("table_1").pose.position + np.array([0.0, 0.0, 0.37 + 0.06])
    editor.settle()
    marked = editor.mean_colour(over, radius=8)
    editor.menu_tool("Warnings").click()
    editor.until(lambda: not editor.client.preferences.badges)
    editor.settle()
    assert f"{table}/mark/tag" not in editor.client.viser_client.scene._handle_from_node_name
    assert np.abs(editor.mean_colour(over, radius=8) - marked).max() > 5.0, "the sign is gone from the screen"


def test_walls_between_the_eye_and_the_room_are_not_in_the_way(editor: EditorPage) -> None:
    session = editor.running.session
    editor.page.keyboard.press("4")
    editor.until(lambda: editor.client.view.camera.position[1] < -5.0, "the eye is behind the front wall")
    editor.settle()
    chair = session.scene.object("chair_1")
    editor.click_world(chair.pose.apply(np.array([0.0, 0.0, 0.045])))
    editor.until(lambda: editor.selection == ("chair_1",), "seen and clicked through the wall")


LEFT_OF = "(name) => (window.__dioWalls.shares || {})[name]"
"""How much of a plane, or of what hangs on one, is drawn: 1 all, 0 nothing."""


def test_walls_fade_with_what_hangs_on_them_and_come_back(editor: EditorPage) -> None:
    session, view = editor.running.session, editor.client.view
    wall, ceiling = (str(session.viewport.plane_name(i)) for i in ("wall_3", "ceiling"))
    picture = str(session.viewport.node_name("picture_1"))
    hangs = session.scene.object("picture_1").pose.position

    def left(name: str) -> float:
        return float(editor.page.evaluate(LEFT_OF, name))

    editor.until(lambda: left(wall) == 1.0 and left(picture) == 1.0, "the far wall is solid from inside")
    solid = editor.mean_colour(hangs)
    session.ui_thread.post(lambda: view.camera.move(hangs + np.array([0.5, 5.0, 1.5]), hangs))
    editor.until(lambda: 0.0 < left(wall) < 0.3 and left(picture) == left(wall), "faded, not gone")
    assert left(ceiling) == 0.0, "nothing lies over the room seen from above"
    table = session.scene.object("table_1")
    editor.click_world(table.pose.apply(np.array([0.0, 0.0, 0.36])))
    editor.until(lambda: editor.selection == ("table_1",), "clicked through the wall")
    editor.row("picture").click()
    editor.until(lambda: left(picture) == 1.0, "what is selected is seen")
    assert left(wall) < 0.3
    editor.page.keyboard.press("p")
    editor.until(lambda: view.camera.through_photo and left(wall) == 1.0, "solid through the photo's camera")
    editor.page.keyboard.press("Escape")
    editor.page.keyboard.press("r")
    editor.until(lambda: not view.camera.through_photo and left(wall) == 1.0 and left(picture) == 1.0, "back")
    editor.settle()
    assert np.abs(editor.mean_colour(hangs) - solid).max() < 12.0, "as it was before"


def test_a_fade_takes_a_few_frames_where_there_is_a_graphics_card(editor: EditorPage) -> None:
    session, view = editor.running.session, editor.client.view
    wall = str(session.viewport.plane_name("wall_3"))
    editor.until(lambda: editor.page.evaluate(LEFT_OF, wall) == 1.0, "solid from inside")
    session.low_graphics = False
    try:
        session.ui_thread.post(editor.client.refresh)
        editor.page.wait_for_function("window.__dioWalls.room.ms > 0")
        log = "(w) => { window.__seen = []; setInterval(() => window.__seen.push(window.__dioWalls.shares[w]), 5); }"
        editor.page.evaluate(log, wall)
        hangs = session.scene.object("picture_1").pose.position
        session.ui_thread.post(lambda: view.camera.move(hangs + np.array([0.5, 5.0, 1.5]), hangs))
        editor.until(lambda: editor.page.evaluate(LEFT_OF, wall) < 0.2, "faded")
        between = [share for share in editor.page.evaluate("window.__seen") if 0.2 < share < 0.95]
        assert between, "not all at once"
        assert between == sorted(between, reverse=True)
    finally:
        session.low_graphics = True


LINES = """() => Object.fromEntries(Object.entries(window.__viserMutable.nodeRefFromName)
    .filter(([name, node]) => /^\\/objects\\/\\d+\\/v\\d+$/.test(name) && node)
    .map(([name, node]) => [name, node.children.find((c) => c.children[0]?.material?.uniforms?.screenspace)])
    .filter(([name, group]) => group?.visible)
    .map(([name, group]) => { const k = group.children[0].material;
        return [name, [k.transparent, k.thickness, '#' + k.color.getHexString(), group.children[0].renderOrder]]; }))"""
"""What is outlined: whether the line is drawn before its object, how wide, in which colour, and when."""


def test_selection_and_hover_are_one_line_behind_the_object_and_the_name_is_shown_on_hover(editor: EditorPage) -> None:
    session = editor.session
    editor.row("lamp").click()
    editor.until(lambda: editor.selection == ("lamp_1",))
    lamp = session.viewport.mesh_name("lamp_1")
    editor.page.wait_for_function(f"'{lamp}' in ({LINES})()")
    assert editor.page.evaluate(LINES) == {lamp: [False, 3.5, "#ff7a1a", 1]}
    tags = [n for n in editor.client.viser_client.scene._handle_from_node_name if n.endswith("/mark/tag")]
    assert not tags, "names are not in the way"
    table = session.scene.object("table_1")
    x, y = editor.place_of(table.pose.apply(np.array([0.2, 0.3, 0.37])))
    assert editor.on_canvas(x, y)
    editor.page.mouse.move(x - 3, y)
    editor.page.mouse.move(x, y)
    mesh = session.viewport.mesh_name("table_1")
    editor.page.wait_for_function(f"'{mesh}' in ({LINES})()")
    expect(editor.page.locator("#dio-tag")).to_have_text("dining table")
    assert editor.page.evaluate(LINES)[mesh][2] == "#4c8dff"
    editor.page.keyboard.press("Escape")
    editor.page.wait_for_function(f"!('{lamp}' in ({LINES})())")
    editor.page.get_by_text("Scene", exact=True).first.hover()
    expect(editor.page.locator("#dio-tag")).to_be_hidden()


def test_a_cameras_photo_is_shown_on_hover_beside_the_pointer_and_not_in_the_room(editor: EditorPage) -> None:
    camera = editor.session.scene.camera
    assert camera is not None
    back = camera.T_world_camera[:3, 2] * (1.0, 1.0, 0.0)
    editor.session.ui_thread.post(
        lambda: editor.client.view.camera.move(
            camera.position - 1.5 * back + np.array([0.0, 0.0, 0.3]), camera.position
        )
    )
    editor.settle()
    picture = camera.position + 0.1 * camera.T_world_camera[:3, 2]
    x, y = editor.place_of(picture)
    assert editor.on_canvas(x, y)
    ratio = """() => { const r = document.querySelector("#dio-tag canvas")?.getBoundingClientRect();
        return r?.height ? r.width / r.height : 0; }"""
    wanted = pytest.approx(camera.intrinsics.width / camera.intrinsics.height, abs=0.02)
    beside = itertools.cycle((3, 0))

    def shown() -> bool:
        """Whether it is while the hand moves: a camera that is drawn anew feels the pointer when that moves again."""
        editor.page.mouse.move(x - next(beside), y)
        return bool(editor.page.evaluate(ratio) == wanted)

    editor.until(shown, "the picture has the photo's proportions")
    planes = """() => { let seen = 0; window.__viserMutable.nodeRefFromName['/photo_camera'].traverse((o) => {
        if (o.material?.map && o.material.visible) seen += 1; }); return seen; }"""
    assert editor.page.evaluate(planes) == 0
    keep_picture(editor, "photo_on_hover")
    editor.page.get_by_text("Scene", exact=True).first.hover()
    expect(editor.page.locator("#dio-tag")).to_be_hidden()
