"""What hands do: drag objects, frame them, preview swaps, click things into place, measure, share a room."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Locator, expect

from diorama_core.project.storage import Project
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.small_room import plain_photo
from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser


def scene(editor: EditorPage) -> Scene:
    return editor.running.session.scene


def seat(editor: EditorPage, chair: str = "chair_2") -> np.ndarray:
    return scene(editor).object(chair).pose.apply(np.array([0.1, 0.0, 0.045]))


def command(editor: EditorPage, command_id: str) -> None:
    client = editor.client
    client.post(lambda: editor.running.editor.commands[command_id].run(client))
    editor.running.session.ui_thread.wait()


def test_an_object_is_dragged_over_the_floor_stopped_by_the_table_and_undone(editor: EditorPage) -> None:
    session = editor.running.session
    editor.until(lambda: session.preparer.ready(o.shape_id for o in session.scene.objects), "shapes are prepared")
    chair = scene(editor).object("chair_2")
    editor.settle()
    start = editor.place_of(seat(editor))
    free = editor.place_of(seat(editor) + np.array([0.3, -0.7, 0.0]))
    editor.drag(start, free)
    editor.until(lambda: scene(editor).object("chair_2").pose != chair.pose, "dragged")
    moved = scene(editor).object("chair_2")
    np.testing.assert_allclose(moved.pose.position - chair.pose.position, (0.3, -0.7, 0.0), atol=0.04)
    assert editor.selection == ("chair_2",)
    assert session.document.history.current.label.startswith("move chair")
    editor.settle()
    table = scene(editor).object("table_1").pose.position
    editor.drag(editor.place_of(seat(editor)), editor.place_of(table + np.array([0.3, -0.1, 0.1])))
    editor.until(lambda: scene(editor).object("chair_2").pose != moved.pose, "pushed against the table")
    assert session.checker.wait()
    assert session.badges == {}, "it slid along the table instead of going into it"
    editor.notice("Move chair")
    editor.page.locator(".dio-toast").get_by_role("button", name="Undo").last.click()
    editor.until(lambda: scene(editor).object("chair_2").pose == moved.pose, "the toast takes it back")
    editor.page.keyboard.press("c")
    editor.until(lambda: not editor.client.preferences.slide, "now it may go through things")
    editor.settle()
    start, into = (
        editor.place_of(seat(editor) + np.array([0.13, 0.13, 0.0])),
        editor.place_of(table + np.array([0.1, -0.3, 0.1])),
    )
    editor.pull(start, into)
    editor.until(lambda: bool(editor.client.marks._colliding), "the collision is shown while dragging")
    editor.page.keyboard.press("Escape")
    editor.page.mouse.up()
    editor.settle()
    assert scene(editor).object("chair_2").pose == moved.pose, "Esc puts it back"


def test_a_frame_selects_and_several_are_aligned_copied_hidden_and_named(editor: EditorPage) -> None:
    editor.settle()
    places = np.array([editor.place_of(scene(editor).object(i).pose.position) for i in ("chair_1", "chair_2")])
    low, high = places.min(axis=0) - 25, places.max(axis=0) + 25
    editor.page.keyboard.down("Shift")
    editor.drag((low[0], high[1]), (high[0], low[1]))
    editor.page.keyboard.up("Shift")
    editor.until(lambda: {"chair_1", "chair_2"} <= set(editor.selection), "both chairs are framed")
    editor.row("chair", exact=True).click()
    editor.row("chair <b>by the window</b>").click(modifiers=["Shift"])
    editor.until(lambda: editor.selection == ("chair_1", "chair_2"))
    editor.page.get_by_role("button", name="Near", exact=True).click()
    editor.until(lambda: editor.running.session.document.history.current.label.startswith("align "), "aligned")
    ends = [scene(editor).object(i).corners_world[:, 1].min() for i in ("chair_1", "chair_2")]
    assert ends[0] == pytest.approx(ends[1], abs=1e-6)
    editor.page.keyboard.press("Control+c")
    editor.page.keyboard.press("Control+v")
    editor.until(lambda: len(scene(editor).objects) == 7, "pasted")
    assert len(editor.selection) == 2
    editor.page.keyboard.press("h")
    editor.until(lambda: all(scene(editor).object(i).hidden for i in editor.selection), "hidden")
    editor.page.keyboard.press("Shift+H")
    editor.until(lambda: not any(o.hidden for o in scene(editor).objects), "shown")
    editor.page.keyboard.press("b")
    editor.until(lambda: editor.client.preferences.names)
    expect(editor.page.get_by_text("picture", exact=True).first).to_be_visible()


def test_a_swap_is_previewed_searched_and_goes_to_all_alike(editor: EditorPage) -> None:
    session = editor.running.session
    command(editor, "select_all")
    editor.row("chair", exact=True).click()
    editor.until(lambda: editor.selection == ("chair_1",))
    session.ui_thread.post(lambda: session.edit("paint", lambda s: edits.recolour(s, "chair_1", (0.1, 0.5, 0.2))))
    before = scene(editor).object("chair_1")
    editor.settle()
    shown = session.viewport.mesh_name("chair_1")
    editor.page.locator(".dio .tile", has_text="chair c").hover()
    editor.until(lambda: session.viewport.mesh_name("chair_1") != shown, "another shape is shown")
    peeked = session.viewport.mesh_name("chair_1")
    editor.page.wait_for_function(f"'{peeked}' in window.__viserMutable.nodeRefFromName")
    assert scene(editor).object("chair_1").shape_id == before.shape_id, "only shown"
    editor.page.mouse.move(500, 500)
    field = editor.page.locator(".mantine-Flex-root", has_text="Swap for").locator("input")
    field.fill("table")
    expect(editor.page.locator(".dio .tile:visible", has_text="table b")).to_be_visible()
    field.fill("")
    editor.page.get_by_role("button", name="Same box").click()
    editor.until(lambda: editor.client.preferences.size_mode == "same box")
    editor.page.locator(".dio .tile", has_text="chair b").click()
    editor.until(lambda: scene(editor).object("chair_1").shape_id == "chair_b", "swapped")
    swapped = scene(editor).object("chair_1")
    np.testing.assert_allclose(swapped.size_m, before.size_m)
    assert swapped.colour == (0.1, 0.5, 0.2), "the colour stays"
    editor.page.get_by_role("button", name="All 2").click()
    editor.until(lambda: editor.client.preferences.all_alike)
    editor.page.locator(".dio .tile", has_text="chair c").click()
    editor.until(lambda: {scene(editor).object(f"chair_{k}").shape_id for k in (1, 2)} == {"chair_c"}, "both")
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: {scene(editor).object(f"chair_{k}").shape_id for k in (1, 2)} == {"chair_b"}, "one step")


def test_a_shape_is_clicked_onto_the_table_and_lengths_are_measured_and_rescaled(editor: EditorPage) -> None:
    editor.tab("Library")
    tile = editor.page.locator(".dio .tile:visible", has_text="lamp a")
    tile.get_by_role("button", name="Place").click()
    expect(editor.page.get_by_text("Click where to place it")).to_be_visible()
    table = scene(editor).object("table_1")
    editor.click_world(table.pose.apply(np.array([0.2, 0.4, 0.37])))
    editor.until(lambda: len(scene(editor).objects) == 6, "placed")
    new = scene(editor).object(editor.selection[0])
    assert scene(editor).support_of(new.id).parent == "table_1"
    np.testing.assert_allclose(new.pose.position[:2], table.pose.apply(np.array([0.2, 0.4, 0.0]))[:2], atol=0.03)
    expect(editor.page.get_by_text("Click where to place it")).to_have_count(0)
    editor.page.keyboard.press("m")
    expect(editor.page.get_by_text("Click the first point")).to_be_visible()
    for x in (-1.0, 0.9):
        editor.click_world(np.array([x, 0.5, 0.0]))
        editor.settle()
    expect(editor.page.get_by_text("between the two points")).to_be_visible()
    width = _floor_width(editor)
    field = editor.page.get_by_label("True length")
    field.fill("3.8 m")
    field.press("Enter")
    editor.until(lambda: abs(_floor_width(editor) / width - 2.0) < 0.05, "rescaled")


def _floor_width(editor: EditorPage) -> float:
    floor = scene(editor).architecture.floor
    assert floor is not None
    return float(np.ptp(floor.polygon[:, 0]))


def test_supports_are_dragged_in_the_list_and_refused_with_the_reason(editor: EditorPage) -> None:
    _drag_row(editor, "lamp_1", "floor")
    editor.until(lambda: scene(editor).support_of("lamp_1").parent == "floor", "onto the floor")
    assert scene(editor).object("lamp_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    _drag_row(editor, "lamp_1", "table_1")
    editor.until(lambda: scene(editor).support_of("lamp_1").parent == "table_1", "back onto the table")
    _drag_row(editor, "table_1", "lamp_1")
    editor.notice("already holds up")
    assert scene(editor).support_of("table_1").parent == "floor"
    editor.row("chair <b>by the window</b>").click()
    editor.page.get_by_label("Against").click()
    editor.page.get_by_role("option", name="Wall 2").click()
    editor.until(lambda: scene(editor).support_of("chair_2").adheres_to == ("wall_2",), "against the wall")
    wall = scene(editor).plane("wall_2")
    gap = float((scene(editor).object("chair_2").corners_world @ wall.normal).min()) - wall.offset
    assert gap == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("modifiers", [(), ("Shift",)])
def test_a_row_that_is_drawn_anew_while_it_is_pressed_is_chosen_once(
    editor: EditorPage, modifiers: tuple[str, ...]
) -> None:
    session = editor.running.session
    editor.row("dining table").click()
    editor.until(lambda: editor.selection == ("table_1",), "the table")
    editor.settle()
    row = editor.page.locator('.dio .row[data-arg="chair_1"]')
    row.evaluate("(node) => { window.__pressedRow = node; }")
    row.locator(".name").hover()
    for key in modifiers:
        editor.page.keyboard.down(key)
    editor.page.mouse.down()
    session.ui_thread.post(lambda: session.edit("rename", lambda s: edits.rename(s, "lamp_1", "night lamp")))
    editor.page.wait_for_function("!window.__pressedRow.isConnected")
    editor.page.mouse.up()
    for key in modifiers:
        editor.page.keyboard.up(key)
    wanted = ("table_1", "chair_1") if modifiers else ("chair_1",)
    editor.until(lambda: editor.selection == wanted, "the row under the pointer")
    editor.page.wait_for_timeout(300)
    assert editor.selection == wanted  # a second click would take it out again


def test_what_moves_away_while_it_is_pressed_is_clicked_once(editor: EditorPage) -> None:
    page = editor.page
    editor.row("dining table").click()
    editor.until(lambda: editor.selection == ("table_1",), "the table")
    editor.settle()

    def press(node: Locator) -> None:
        node.hover()
        page.mouse.down()
        node.evaluate("(node) => { node.style.position = 'relative'; node.style.top = '90px'; }")
        page.mouse.up()
        node.evaluate("(node) => { node.style.position = ''; node.style.top = ''; }")

    page.keyboard.down("Shift")
    press(page.locator('.dio .row[data-arg="chair_1"]'))
    page.keyboard.up("Shift")
    editor.until(lambda: editor.selection == ("table_1", "chair_1"), "what was pressed")
    page.wait_for_timeout(300)
    assert editor.selection == ("table_1", "chair_1"), "a second click would take it out again"
    editor.tab("Photo")
    with page.expect_file_chooser():
        press(editor.button("Upload a photo"))


def test_only_the_selection_is_optimised_compared_and_put_back(editor: EditorPage) -> None:
    session = editor.running.session

    def lift() -> None:
        for chair in ("chair_1", "chair_2"):
            pose = session.scene.object(chair).pose.move((0.0, 0.0, 0.25))
            session.edit("lift", lambda s, c=chair, p=pose: edits.move(s, c, p))

    session.ui_thread.post(lift)
    editor.until(lambda: len(session.badges) == 2, "both float, and it is said")
    expect(editor.page.get_by_text(re.compile(r"· \d+ to check"))).to_be_visible()
    editor.row("chair", exact=True).click()
    editor.tab("Arrange")
    before = session.scene
    editor.button("Optimise selection").click()
    editor.until(lambda: session.jobs.status is None and session.scene is not before, "arranged", seconds=60)
    assert session.scene.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=0.01)
    assert session.scene.object("chair_2").pose == before.object("chair_2").pose
    editor.button("Before").click()
    node = str(session.viewport.node_name("chair_1"))
    editor.page.wait_for_function(f"window.__viserMutable.nodeRefFromName['{node}']?.position.z > 0.6")
    editor.settle()
    editor.button("After").click()
    editor.page.wait_for_function(f"window.__viserMutable.nodeRefFromName['{node}']?.position.z < 0.6")
    editor.button("Revert").click()
    editor.until(lambda: session.scene is before, "put back")
    editor.page.get_by_title("Give the selected objects their alternative 2").click()
    editor.until(lambda: session.scene.object("chair_1").shape_id == "chair_b", "another arrangement")


def test_projects_are_renamed_copied_binned_and_brought_back(editor: EditorPage, tmp_path: Path) -> None:
    session = editor.running.session
    editor.tab("Project")
    name = editor.page.get_by_label("Project name")
    name.fill("Living room")
    name.press("Enter")
    editor.until(lambda: session.project is not None and session.project.name == "Living room", "renamed")
    editor.button("All projects").click()
    grid = editor.page.locator("#dio-projects")
    grid.get_by_role("button", name="Duplicate").first.click()
    copy = grid.locator(".tile", has=editor.page.get_by_label("Name of Living room 2"))
    expect(copy.locator("img")).to_be_visible()
    assert Project.open(tmp_path / "projects" / "demo-2").load_scene() == session.scene
    copy.get_by_role("button", name="Delete").click()
    expect(copy).to_have_count(0)
    editor.page.locator(".dio-toast").get_by_role("button", name="Restore").click()
    expect(copy).to_be_visible()
    copy.get_by_role("button", name="Delete").click()
    grid.get_by_text("Bin", exact=True).click()
    grid.locator(".row").get_by_role("button", name="Restore").click()
    expect(copy).to_be_visible()
    editor.page.get_by_label("Search projects").fill("room 2")
    expect(grid.locator(".tile:visible")).to_have_count(1)
    for _ in range(2):  # out of the field, and out of the grid
        editor.page.keyboard.press("Escape")
    expect(grid).to_have_count(0)


def test_a_photo_begins_another_project_from_the_list_of_projects(editor: EditorPage, tmp_path: Path) -> None:
    photo = tmp_path / "attic.png"
    Image.fromarray(plain_photo().rgb).save(photo)
    editor.tab("Project")
    editor.upload("New from a photo", photo)
    editor.at_board()
    expect(editor.page.get_by_role("tab", name="Photo", exact=True)).to_have_attribute("aria-selected", "true")
    expect(editor.page.locator("p").filter(has_text="attic.png").first).to_be_visible()
    assert editor.session is not editor.running.session, "the open project stays as it is"
    assert editor.session.is_unbuilt


def test_dark_keys_palette_and_units(editor: EditorPage) -> None:
    command(editor, "theme")
    editor.page.wait_for_function("document.documentElement.dataset.mantineColorScheme === 'dark'")
    command(editor, "theme")
    editor.page.keyboard.press("Shift+?")
    dialog = editor.page.locator(".mantine-Modal-content")
    expect(dialog.get_by_text("Drop to support")).to_be_visible()
    editor.page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)
    editor.page.keyboard.press("Control+k")
    expect(editor.page.locator("input.mantine-Spotlight-search")).to_be_focused()
    editor.page.keyboard.type("top view")
    editor.page.keyboard.press("Enter")
    editor.until(lambda: editor.client.view.camera.fov_rad < 0.2, "from above")
    editor.row("dining table").click()
    editor.page.get_by_label("Unit").select_option("ft-in")
    for axis, before, after in (
        ("Width", "4' 7 1/8\"", "5'"),
        ("Depth", "2' 7 1/2\"", "3'"),
        ("Height", "2' 5 1/8\"", "2' 6\""),
    ):
        field = editor.page.get_by_label(f"Size: {axis}")
        expect(field).to_have_value(before)
        field.fill(after)
        field.press("Enter")
    editor.until(lambda: np.allclose(scene(editor).object("table_1").size_m, (0.9144, 1.524, 0.762), atol=1e-3))


def test_two_people_share_the_history_and_see_each_others_selection(editor: EditorPage, visit) -> None:
    other = visit(editor.running)
    editor.row("lamp").click()
    editor.until(lambda: editor.selection == ("lamp_1",))
    assert other.selection == ()
    expect(other.page.locator('.dio .row[data-arg="lamp_1"] .who')).to_be_visible()
    node = editor.running.session.viewport.node_name("lamp_1")
    names = other.page.evaluate("Object.keys(window.__viserMutable.nodeRefFromName)")
    assert any(n.startswith(f"{node}/mark") for n in names), "the other's cursor is drawn"
    editor.page.keyboard.press("Delete")
    expect(other.row("lamp")).to_have_count(0)
    other.page.keyboard.press("Control+z")
    other.notice("nothing of yours to undo")
    editor.page.keyboard.press("Control+z")
    expect(other.row("lamp")).to_have_count(1)


@pytest.mark.slow
def test_what_was_missed_is_added_from_the_photo_and_renamed(editor: EditorPage) -> None:
    session = editor.running.session
    editor.tab("Photo")
    editor.page.locator(".dio .row[data-do=mark]", has_text="dining table").click()
    editor.button("Add selected box to the scene").click()
    editor.until(lambda: session.jobs.status is None and len(editor.selection) == 1, "added", seconds=90)
    new = session.scene.object(editor.selection[0])
    assert new.category == "table"
    assert new.box_px == pytest.approx((240.0, 200.0, 440.0, 420.0))
    assert new.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    field = editor.page.get_by_label("Object category")
    field.click()
    editor.settle()
    editor.page.keyboard.type("chair")  # what is clicked is selected whole, so that typing replaces it
    expect(field).to_have_value("chair")
    field.press("Enter")
    editor.until(
        lambda: session.jobs.status is None and session.scene.object(new.id).category == "chair", "renamed", seconds=90
    )
    assert session.library.shape(session.scene.object(new.id).shape_id).category == "chair"
    np.testing.assert_allclose(session.scene.object(new.id).pose.position[:2], new.pose.position[:2])
    editor.button("Fix outline").click()
    editor.at_board()
    editor.page.mouse.click(*editor.on_photo(340.0, 300.0))
    editor.settle()
    editor.button("Use this outline").click()
    label = f"change the outline of {session.scene.object(new.id).label}"
    editor.until(lambda: session.document.history.current.label == label, "looked at again", seconds=90)
    assert not editor.client.view.canvas.is_open
    assert session.ui_thread.wait()
    session.autosave.flush()
    retained = session.project.load_inputs()
    drawn = retained.instances == retained.instance_boxes[0][0]
    assert drawn[300, 340], "the next build takes the outline as it was drawn"
    assert retained.instance_boxes[0][1].label == session.scene.object(new.id).label == "chair"


def _drag_row(editor: EditorPage, child: str, parent: str) -> None:
    assert editor.running.session.checker.wait()
    editor.running.session.ui_thread.wait()
    editor.settle()
    row = editor.page.locator(f'.dio .row[data-grab="{child}"]')
    row.drag_to(editor.page.locator(f'.dio .row[data-drop="{parent}"]'))
