"""Walls are pulled by their arrow, distances are shown while dragging and typed, doors cut their wall."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_app.serve import Running
from diorama_core.editing.clearances import clearances
from diorama_core.scene.types import Scene
from tests.e2e.browser import EditorPage
from tests.e2e.test_handles_and_supports import at_rest

pytestmark = pytest.mark.browser

SHOWN = "() => document.querySelectorAll('#dio-distances .line').length"


def scene(editor: EditorPage) -> Scene:
    return editor.session.scene


def test_a_wall_is_pulled_by_its_arrow_in_one_step_and_says_how_far(editor: EditorPage) -> None:
    editor.page.keyboard.press("t")
    wall = scene(editor).plane("wall_2")
    middle = 0.5 * (wall.polygon.min(axis=0) + wall.polygon.max(axis=0))
    at_rest(editor, middle)
    editor.page.locator(".dio .row:visible", has_text="Wall 3").first.click()
    editor.unfold("Room", editor.page.locator(".dio button:visible", has_text="Wall 2")).click()
    editor.until(lambda: editor.client.surface == "wall_2")
    editor.page.wait_for_function("!!window.__viserMutable.nodeRefFromName['/wall-handle']")
    editor.settle()
    before = scene(editor)
    start = editor.place_of(middle + 0.45 * wall.normal)
    end = editor.place_of(middle + (0.45 - 0.6) * wall.normal)
    editor.pull(start, end)
    editor.page.wait_for_function(f"({SHOWN})() === 1")
    editor.page.mouse.up()
    editor.until(lambda: scene(editor) is not before, "moved")
    assert editor.session.document.history.current.label.startswith("move wall 2 by")
    moved = scene(editor).plane("wall_2")
    assert abs(float((moved.centre - wall.centre) @ wall.normal)) == pytest.approx(0.6, abs=0.15)
    editor.page.wait_for_function(f"({SHOWN})() === 0")
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: scene(editor) == before, "one undo step")


def test_distances_are_shown_while_dragging_and_typed_to_place(editor: EditorPage) -> None:
    editor.page.keyboard.press("t")
    chair = scene(editor).object("chair_1")
    at_rest(editor, chair.pose.position)
    top = chair.pose.position + np.array([0.0, 0.0, 0.02])
    start, end = editor.place_of(top), editor.place_of(top + np.array([-0.4, -0.3, 0.0]))
    editor.pull(start, end)
    editor.page.wait_for_function(f"({SHOWN})() >= 3")
    editor.page.mouse.up()
    editor.page.wait_for_function(f"({SHOWN})() === 0")
    editor.until(lambda: editor.session.document.history.current.label == "move chair")
    field = editor.page.get_by_label("Distance: back")
    field.fill("25 cm")
    field.press("Enter")

    def back() -> float:
        return next(c.distance_m for c in clearances(scene(editor), "chair_1") if c.side == "back")

    editor.until(lambda: abs(back() - 0.25) < 1e-6, "placed")
    expect(field).to_have_value("0.25")
    editor.page.keyboard.press("Escape")


def test_a_door_from_the_library_cuts_the_wall_it_is_put_on(
    serve: Callable[..., Running], visit: Callable[[Running], EditorPage]
) -> None:
    page = visit(serve())
    page.tab("Library")
    shape = page.session.library.in_category("door")[0]
    page.page.get_by_label("Search").fill(shape.caption)
    page.page.keyboard.press("Enter")
    count = len(scene(page).objects)
    page.page.locator(f'.dio .tile [data-do=insert][data-arg="{shape.id}"]').click()
    page.until(lambda: len(scene(page).objects) == count + 1, "inserted")
    door = scene(page).objects[-1]
    edge = scene(page).support_of(door.id)
    assert edge is not None
    wall = scene(page).plane(edge.parent)
    assert wall.role == "wall"
    assert door.corners_world[:, 2].min() == pytest.approx(wall.polygon[:, 2].min(), abs=1e-6)
    drawn = page.session.viewport._planes
    page.until(
        lambda: wall.id in drawn and len(drawn[wall.id][0].polygon) > len(wall.polygon), "drawn with its opening"
    )
    mesh = page.session.viewport.mesh_name(door.id)
    page.tab("Object")
    slider = page.page.get_by_label("Open", exact=True).and_(page.page.locator("input"))
    slider.fill("60")
    page.until(lambda: scene(page).object(door.id).open_share == 0.6, "opened")
    assert page.session.document.history.current.label == f"open {door.label} by 60 %"
    page.until(lambda: page.session.viewport.mesh_name(door.id) != mesh, "drawn open")
    slider.blur()  # in a field the keys would undo what was typed
    page.page.keyboard.press("Control+z")
    page.until(lambda: scene(page).object(door.id).open_share == 0.0, "closed again in one step")
    expect(slider).to_have_value("0")
    slider.press("ArrowRight")
    page.page.keyboard.press("Control+z")
    document, step = page.session.document, f"open {door.label} by 5 %"
    page.until(lambda: document.history.can_redo and document.history.entries[-1].label == step, "done and undone")
    page.page.wait_for_timeout(500)  # longer than a slider waits for the hand to go on
    assert scene(page).object(door.id).open_share == 0.0, "what was undone at once stays undone"
