"""The plan: walls, corners, lengths and furniture are changed from above, in the same document, with undo."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_app.session.units import format_length
from diorama_core.editing.plan_edits import corners, wall_feet
from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser


@pytest.fixture
def plan(editor: EditorPage) -> Iterator[EditorPage]:
    """The plan of the room, furniture drawn by its shapes."""
    editor.page.keyboard.press("7")
    expect(editor.page.locator("#dio-plan svg")).to_be_visible()
    editor.settle()
    yield editor
    editor.tool("Room").click()
    expect(editor.page.locator("#dio-plan")).to_have_count(0)


def on_plan(editor: EditorPage, point: np.ndarray) -> tuple[float, float]:
    """Where a point of the floor is on the page."""
    x, y = editor.page.evaluate("(p) => window.__dioPlan.toPage(p)", [float(v) for v in point[:2]])
    return float(x), float(y)


def drag_by(editor: EditorPage, start: np.ndarray, shift: tuple[float, float]) -> None:
    """Drag from one point of the floor to another (m)."""
    editor.drag(on_plan(editor, start), on_plan(editor, np.asarray(start[:2]) + shift))


def foot(editor: EditorPage, wall: str):
    return next(f for f in wall_feet(editor.session.scene) if f.id == wall)


def test_walls_furniture_doors_and_lengths_are_seen(plan: EditorPage) -> None:
    page, scene = plan.page, plan.session.scene
    walls = scene.architecture.by_role("wall")
    expect(page.locator("#dio-plan .grip")).to_have_count(len(walls))
    expect(page.locator("#dio-plan .length")).to_have_count(len(walls))
    expect(page.locator("#dio-plan .corner")).to_have_count(len(corners(scene)))
    expect(page.locator("#dio-plan .piece")).to_have_count(len(scene.objects))
    for wall in wall_feet(scene):
        expect(page.locator(f'#dio-plan .length[data-wall="{wall.id}"]')).to_have_text(
            format_length(wall.length_m, "m")
        )


def test_names_lie_over_furniture_and_cover_no_other(plan: EditorPage) -> None:
    boxes = plan.page.evaluate("""[...document.querySelectorAll('#dio-plan .names text')].map((t) => {
        const b = t.getBoundingClientRect();
        return [b.left, b.top, b.right, b.bottom];
    })""")
    assert len(boxes) >= 2
    for i, a in enumerate(boxes):
        for b in boxes[:i]:
            assert a[0] >= b[2] or b[0] >= a[2] or a[1] >= b[3] or b[1] >= a[3], (a, b)
    after = "piece => piece.compareDocumentPosition(document.querySelector('#dio-plan .names')) & 4"
    assert plan.page.locator("#dio-plan .piece:not(.opening)").first.evaluate(after)


def test_a_wall_is_dragged_as_one_undo_step(plan: EditorPage) -> None:
    before = plan.session.scene
    wall = wall_feet(before)[0]
    at = wall.start + 0.3 * (wall.end - wall.start)
    drag_by(plan, at, tuple(0.5 * wall.outward))
    plan.until(lambda: plan.session.scene is not before, "moved")
    moved = foot(plan, wall.id)
    assert float((moved.start - wall.start) @ wall.outward) == pytest.approx(0.5, abs=0.04)
    plan.page.keyboard.press("Control+z")
    plan.until(lambda: plan.session.scene == before, "undone")


def test_a_corner_is_dragged(plan: EditorPage) -> None:
    before = plan.session.scene
    corner = corners(before)[0]
    drag_by(plan, corner.at, (0.4, 0.3))
    plan.until(lambda: plan.session.scene is not before, "moved")
    at = next(c.at for c in corners(plan.session.scene) if c.first == corner.first)
    np.testing.assert_allclose(at - corner.at, (0.4, 0.3), atol=0.04)


def test_a_length_is_typed(plan: EditorPage) -> None:
    corner = corners(plan.session.scene)[0]
    plan.page.locator(f'#dio-plan .length[data-wall="{corner.first}"]').click()
    field = plan.page.locator("#dio-plan input")
    expect(field).to_be_focused()
    field.fill("3.4")
    plan.page.keyboard.press("Enter")
    plan.until(lambda: abs(foot(plan, corner.first).length_m - 3.4) < 1e-6, "as long as typed")
    expect(plan.page.locator(f'#dio-plan .length[data-wall="{corner.first}"]')).to_have_text("3.4 m")


def test_furniture_is_selected_and_dragged_with_what_stands_on_it(plan: EditorPage) -> None:
    scene = plan.session.scene
    chair, table, lamp = (scene.object(i) for i in ("chair_1", "table_1", "lamp_1"))
    plan.page.mouse.click(*on_plan(plan, chair.pose.position))
    plan.until(lambda: plan.selection == ("chair_1",), "selected")
    expect(plan.page.locator("#dio-plan .piece.on")).to_have_attribute("data-id", "chair_1")
    corner = table.corners_world.min(axis=0)[:2] + 0.12
    drag_by(plan, corner, (0.3, -0.25))
    plan.until(lambda: plan.session.scene.object("table_1").pose != table.pose, "moved")
    for item in (table, lamp):
        shift = plan.session.scene.object(item.id).pose.position - item.pose.position
        np.testing.assert_allclose(shift[:2], (0.3, -0.25), atol=0.04)


def test_views_lead_out_of_the_plan(editor: EditorPage) -> None:
    editor.tool("Plan").click()
    expect(editor.page.locator("#dio-plan")).to_be_visible()
    expect(editor.tool("Plan")).to_have_class("on")
    editor.tool("Photo").click()
    expect(editor.page.locator("#dio-plan")).to_have_count(0)
    editor.until(lambda: editor.client.view.camera.through_photo, "the photo's view")
