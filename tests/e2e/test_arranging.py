"""Select, move, swap, undo: on the canvas and in the panels, by mouse and keys."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_core.scene.types import Scene
from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser


def scene(editor: EditorPage) -> Scene:
    return editor.running.session.scene


def selection(editor: EditorPage) -> tuple[str, ...]:
    return editor.selection


def seat(editor: EditorPage, chair: str = "chair_2") -> np.ndarray:
    return scene(editor).object(chair).pose.apply(np.array([0.1, 0.0, 0.045]))


def select_chair(editor: EditorPage) -> None:
    editor.click_world(seat(editor))
    editor.until(lambda: selection(editor) == ("chair_2",), "the chair is selected")


def test_click_selects_shift_click_adds_and_a_click_on_the_floor_chooses_it_instead(editor: EditorPage) -> None:
    select_chair(editor)
    expect(editor.button("Duplicate")).to_be_visible()
    editor.click_world(scene(editor).object("table_1").pose.apply(np.array([0.2, -0.4, 0.37])), modifiers=("Shift",))
    editor.until(lambda: selection(editor) == ("chair_2", "table_1"), "the table is selected too")
    editor.click_world(np.array([1.2, 0.2, 0.0]))
    editor.until(lambda: selection(editor) == (), "no object is selected")
    assert editor.client.surface == "floor"
    expect(editor.button("Herringbone")).to_be_visible()
    editor.page.keyboard.press("Escape")
    expect(editor.page.get_by_text("Click an object")).to_be_visible()


def test_the_outliner_selects_escapes_names_locks_and_hides(editor: EditorPage) -> None:
    editor.row("chair <b>by the window</b>").click()
    editor.until(lambda: selection(editor) == ("chair_2",))
    editor.page.keyboard.press("Escape")
    editor.until(lambda: selection(editor) == ())
    tools = editor.page.locator(".dio .row").filter(has=editor.page.get_by_text("lamp", exact=True))
    tools.get_by_role("button", name="Hide lamp").click()
    editor.until(lambda: scene(editor).object("lamp_1").hidden)
    tools.get_by_role("button", name="Lock lamp").click()
    editor.until(lambda: scene(editor).object("lamp_1").locked)
    editor.row("lamp").click()
    editor.button("Delete").click()
    editor.notice("locked")
    assert scene(editor).has_object("lamp_1")


def test_swap_moves_undo_and_redo(editor: EditorPage) -> None:
    select_chair(editor)
    before = scene(editor).object("chair_2")
    editor.page.locator(".dio .tile", has_text="chair c").click()
    editor.until(lambda: scene(editor).object("chair_2").shape_id == "chair_c", "swapped")
    after = scene(editor).object("chair_2")
    np.testing.assert_allclose(after.pose.position[:2], before.pose.position[:2])
    assert after.corners_world[:, 2].min() == pytest.approx(before.corners_world[:, 2].min(), abs=1e-9)
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: scene(editor).object("chair_2").shape_id == "chair_b", "undone")
    editor.tool("Redo").click()
    editor.until(lambda: scene(editor).object("chair_2").shape_id == "chair_c", "redone")


def test_the_gizmo_moves_by_mouse_as_one_undo_step_and_children_follow(editor: EditorPage) -> None:
    editor.row("dining table").click()
    editor.until(lambda: selection(editor) == ("table_1",))
    session = editor.running.session
    table, lamp = scene(editor).object("table_1"), scene(editor).object("lamp_1")
    steps = len(session.document.history.entries)
    along = table.pose.R_world_object[:, 0]
    gizmo = float(np.clip(0.62 * max(table.size_m), 0.3, 1.1))
    editor.settle()
    handle = editor.place_of(table.pose.position + along * 0.75 * gizmo)
    target = editor.place_of(table.pose.position + along * (0.75 * gizmo + 0.5))
    editor.drag(handle, target)
    editor.until(lambda: scene(editor).object("table_1").pose != table.pose, "the table moved")
    moved = scene(editor).object("table_1").pose.position - table.pose.position
    assert moved @ along == pytest.approx(0.5, abs=0.12)
    assert abs(moved[2]) < 1e-6
    np.testing.assert_allclose(scene(editor).object("lamp_1").pose.position - lamp.pose.position, moved, atol=1e-9)
    assert len(session.document.history.entries) == steps + 1
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: scene(editor).object("table_1").pose == table.pose, "undone at once")


def test_numeric_fields_move_turn_and_resize(editor: EditorPage) -> None:
    select_chair(editor)
    before = scene(editor).object("chair_2")
    x = editor.page.get_by_label("Position: x")
    x.fill("0.65")
    x.press("Tab")
    editor.until(lambda: abs(scene(editor).object("chair_2").pose.position[0] - 0.65) < 1e-3, "x is 0.65 m")
    assert scene(editor).object("chair_2").pose.position[1] == pytest.approx(before.pose.position[1])
    editor.settle()  # the fields are drawn anew after every change
    turn = editor.page.get_by_label("Direction (°)")
    turn.fill("90")
    turn.press("Tab")
    editor.until(lambda: abs(np.degrees(scene(editor).object("chair_2").pose.yaw_rad) - 90) < 1e-3, "turned")
    editor.settle()
    width = editor.page.get_by_label("Size: Width")
    width.fill("0.9")
    width.press("Tab")
    editor.until(lambda: abs(scene(editor).object("chair_2").size_m[1] - 0.9) < 1e-3, "0.9 m wide")
    assert scene(editor).object("chair_2").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)


def test_duplicate_delete_and_an_impossible_support(editor: EditorPage) -> None:
    editor.row("lamp").click()
    editor.page.keyboard.press("Control+d")
    editor.until(lambda: len(scene(editor).objects) == 6, "a copy")
    assert scene(editor).support_of(selection(editor)[0]).parent == "table_1"
    editor.page.keyboard.press("Delete")
    editor.until(lambda: len(scene(editor).objects) == 5, "deleted")
    editor.row("dining table").click()
    editor.until(lambda: selection(editor) == ("table_1",))
    editor.page.get_by_label("Stands on").click()
    editor.page.get_by_role("option", name="lamp", exact=True).click()
    editor.notice("already holds up")
    assert scene(editor).support_of("table_1").parent == "floor"


def test_a_second_browser_and_a_reload_see_the_same_document(editor: EditorPage, visit) -> None:
    other = visit(editor.running)
    select_chair(editor)
    editor.button("Delete").click()
    editor.until(lambda: not scene(editor).has_object("chair_2"))
    expect(other.row("chair <b>by the window</b>")).to_have_count(0)
    editor.page.keyboard.press("Control+z")
    expect(other.row("chair <b>by the window</b>")).to_have_count(1)
    editor.load()
    expect(editor.row("chair <b>by the window</b>")).to_have_count(1)
    select_chair(editor)


def test_what_stood_on_a_deleted_table_comes_down_and_may_go_too(editor: EditorPage) -> None:
    editor.row("dining table").click()
    editor.until(lambda: selection(editor) == ("table_1",))
    editor.page.keyboard.press("Delete")
    editor.until(lambda: not scene(editor).has_object("table_1"), "deleted")
    editor.notice("lowered what stood on top: lamp")
    assert scene(editor).object("lamp_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    editor.button("Delete it too").click()
    editor.until(lambda: not scene(editor).has_object("lamp_1"), "with what stood on it")


def test_tidying_up_leaves_what_a_person_moved_and_says_so(editor: EditorPage) -> None:
    select_chair(editor)
    x = editor.page.get_by_label("Position: x")
    x.fill("0.65")
    x.press("Tab")
    editor.until(lambda: scene(editor).object("chair_2").by_hand, "a person placed it")
    placed = scene(editor).object("chair_2").pose
    editor.tab("Arrange")
    editor.button("Optimise layout").click()
    editor.until(lambda: editor.session.layout_run is not None and editor.session.layout_run.final is not None, "tidy")
    np.testing.assert_allclose(scene(editor).object("chair_2").pose.position, placed.position, atol=5e-3)
    expect(editor.page.get_by_text("1 object that people placed stayed in place.")).to_be_visible()
    expect(editor.button("Tidy up all")).to_be_visible()
