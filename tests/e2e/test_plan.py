"""The plan: walls, corners, lengths and furniture are changed from above, in the same document, with undo."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from diorama_app.serve import Running
from diorama_app.session.units import format_length
from diorama_core.editing.plan_edits import corners, wall_feet
from tests.app.small_room import make_project
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture
from tests.importing.test_plan_pages import write_pdf

pytestmark = pytest.mark.browser


@pytest.fixture
def plan(editor: EditorPage) -> Iterator[EditorPage]:
    """The plan of the room, furniture drawn by its shapes."""
    editor.page.keyboard.press("7")
    expect(editor.page.locator("#dio-plan svg")).to_be_visible()
    editor.settle()
    editor.until(lambda: is_still(editor), "fitted to the page")
    yield editor
    editor.tool("Room").click()
    expect(editor.page.locator("#dio-plan")).to_have_count(0)


def on_plan(editor: EditorPage, point: np.ndarray) -> tuple[float, float]:
    """Where a point of the floor is on the page."""
    x, y = editor.page.evaluate("(p) => window.__dioPlan.toPage(p)", [float(v) for v in point[:2]])
    return float(x), float(y)


def is_still(editor: EditorPage) -> bool:
    """Whether the plan stays where it is: it is fitted anew while the page's panels come."""
    before = [on_plan(editor, np.full(2, at)) for at in (0.0, 1.0)]
    editor.page.wait_for_timeout(200)
    return before == [on_plan(editor, np.full(2, at)) for at in (0.0, 1.0)]


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
    def boxes() -> list[list[float]]:
        return plan.page.evaluate("""[...document.querySelectorAll('#dio-plan .names text')].map((t) => {
            const b = t.getBoundingClientRect();
            return [b.left, b.top, b.right, b.bottom];
        })""")

    def are_apart(a: list[float], b: list[float]) -> bool:
        return a[0] >= b[2] or b[0] >= a[2] or a[1] >= b[3] or b[1] >= a[3]

    plan.until(lambda: len(boxes()) >= 2, "named")
    plan.until(lambda: all(are_apart(a, b) for a, b in combinations(boxes(), 2)), "apart")
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
    field = plan.page.locator("#dio-plan input:not([type=file])")
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


def on_foot(editor: EditorPage, wall: str, share: float) -> tuple[float, float]:
    """A place on a wall, on the page."""
    at = foot(editor, wall)
    return on_plan(editor, at.start + share * (at.end - at.start))


def test_a_wall_is_split_and_its_part_moved(plan: EditorPage) -> None:
    page, session = plan.page, plan.session
    wall, count = wall_feet(session.scene)[0].id, len(wall_feet(session.scene))
    page.get_by_role("button", name="Split wall").click()
    page.mouse.click(*on_foot(plan, wall, 0.4))
    plan.until(lambda: len(wall_feet(session.scene)) == count + 1, "split")
    plan.settle()
    part = foot(plan, wall)
    drag_by(plan, (part.start + part.end) / 2, tuple(0.5 * part.outward))
    plan.until(lambda: len(wall_feet(session.scene)) == count + 2, "the gap is closed")
    for _ in range(2):
        page.keyboard.press("Control+z")
    plan.until(lambda: len(wall_feet(session.scene)) == count, "undone")


def test_a_door_and_a_window_are_put_into_a_wall(
    serve: Callable[..., Running], visit: Callable[[Running], EditorPage], tmp_path: Path
) -> None:
    editor = visit(serve(project=make_project(tmp_path / "projects" / "demo").folder))
    session = editor.session
    wall = wall_feet(session.scene)[0].id
    editor.page.keyboard.press("7")
    expect(editor.page.locator("#dio-plan svg")).to_be_visible()
    for category, share in (("door", 0.2), ("window", 0.7)):
        count = len(session.scene.objects)
        editor.page.get_by_role("button", name=category.capitalize(), exact=True).click()
        editor.page.mouse.click(*on_foot(editor, wall, share))
        editor.until(lambda many=count: len(session.scene.objects) == many + 1, "inserted")
        new = session.scene.objects[-1]
        assert new.category == category
        assert session.scene.support_of(new.id).parent == wall
        at = foot(editor, wall)
        assert float((new.pose.position[:2] - at.start) @ at.direction) == pytest.approx(share * at.length_m, abs=0.45)
    expect(editor.page.locator("#dio-plan .piece.opening")).to_have_count(2)


def test_a_room_is_drawn_corner_by_corner(plan: EditorPage) -> None:
    page, session = plan.page, plan.session
    before = session.scene
    outline = [np.array(p) for p in ([-1.5, 1.5], [1.5, 1.5], [1.5, 4.0], [-1.5, 4.0])]
    page.get_by_role("button", name="Draw room").click()
    for corner in outline[:2]:
        page.mouse.click(*on_plan(plan, corner))
    page.keyboard.press("Enter")
    hint = page.locator("#dio-plan-tools p")
    expect(hint).to_have_text("A room has at least three corners.")
    page.mouse.move(*on_plan(plan, outline[2]))
    plan.settle()
    expect(hint).to_have_text("A room has at least three corners.")
    for corner in outline[2:]:
        page.mouse.click(*on_plan(plan, corner))
    page.keyboard.press("Enter")
    plan.until(lambda: session.scene is not before, "drawn")
    lengths = sorted(f.length_m for f in wall_feet(session.scene))
    np.testing.assert_allclose(lengths, [2.5, 2.5, 3.0, 3.0], atol=0.06)
    page.keyboard.press("Control+z")
    plan.until(lambda: session.scene == before, "one undo step")


def test_a_picture_lies_below_and_is_scaled_by_a_known_length(plan: EditorPage, tmp_path: Path) -> None:
    page = plan.page
    drawing = tmp_path / "plan.png"
    Image.new("RGB", (400, 200), (230, 240, 250)).save(drawing)
    page.locator("#dio-plan-tools input[type=file]").set_input_files(drawing)
    picture = page.locator("#dio-plan image")
    expect(picture).to_be_visible()
    plan.until(lambda: is_still(plan), "fitted to the picture, too")
    box = picture.bounding_box()
    assert box is not None
    for share in (0.25, 0.75):
        page.mouse.click(box["x"] + share * box["width"], box["y"] + box["height"] / 2)
    page.get_by_label("True length between the two points").fill("2 m")
    page.keyboard.press("Enter")

    def width_m() -> float:
        box = picture.bounding_box()  # none while it is drawn anew
        # The plan is fitted to the page's size, which may still change: what a metre is is asked each time.
        metre = np.subtract(on_plan(plan, np.array([1.0, 0.0])), on_plan(plan, np.array([0.0, 0.0])))[0]
        return 0.0 if box is None else float(box["width"] / metre)

    plan.until(lambda: abs(width_m() - 4.0) < 0.02, "scaled")
    plan.load()  # it is the project's, not this page's
    page.keyboard.press("7")
    expect(picture).to_be_visible()
    plan.until(lambda: abs(width_m() - 4.0) < 0.02, "as it was scaled")
    page.get_by_role("button", name="Remove picture").click()
    expect(picture).to_have_count(0)


def test_a_pdf_page_lies_below(plan: EditorPage, tmp_path: Path) -> None:
    pytest.importorskip("pypdfium2", reason="needs pypdfium2 (pip install 'diorama[plan]')")
    write_pdf(tmp_path / "plan.pdf")
    plan.page.locator("#dio-plan-tools input[type=file]").set_input_files(tmp_path / "plan.pdf")
    picture = plan.page.locator("#dio-plan image")
    expect(picture).to_be_visible()
    keep_picture(plan, "plan-pdf-below")
    box = picture.bounding_box()
    assert box["width"] / box["height"] == pytest.approx(842 / 595, rel=0.01)
    plan.page.get_by_role("button", name="Remove picture").click()
    expect(picture).to_have_count(0)


def test_the_plan_is_zoomed_and_shifted(plan: EditorPage) -> None:
    page = plan.page
    a, b = np.array([0.0, 2.0]), np.array([1.0, 2.0])
    before = np.subtract(on_plan(plan, b), on_plan(plan, a))
    page.mouse.move(*on_plan(plan, a))
    held = on_plan(plan, a)
    page.mouse.wheel(0, -400)
    plan.until(lambda: np.subtract(on_plan(plan, b), on_plan(plan, a))[0] > 1.5 * before[0], "zoomed")
    np.testing.assert_allclose(on_plan(plan, a), held, atol=1.5)
