"""Handles win over bodies, pasted objects land in view, supports by dragged rows, recipes tell what got worse."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Locator, expect

from diorama_app.commands import optimise as commands
from diorama_app.interaction.gestures import Gestures
from diorama_app.serve import Running
from diorama_app.session.layout_run import LayoutRun
from diorama_core.artefacts import LayoutReport
from diorama_core.editing.collisions import Collisions
from diorama_core.scene import edits
from diorama_core.scene.types import Scene, Support
from tests.app.small_room import PlainLibrary, make_project
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture

pytestmark = pytest.mark.browser


LIFTED = """() => { let lifted = false; window.__viserMutable.nodeRefFromName['/gizmo']?.traverse((o) => {
    lifted ||= Boolean(o.isMesh && o.userData.dioLifted); }); return lifted; }"""
"""Handles are there, and above bodies."""


def at_rest(editor: EditorPage, point: np.ndarray) -> None:
    """Wait until the camera has come to rest and the handles have followed it."""
    editor.settle()
    editor.still(lambda: np.round(editor.place_of(point), 1).tolist())


def test_the_rotation_arc_turns_where_it_lies_over_the_body(editor: EditorPage) -> None:
    session = editor.session
    editor.row("dining table").click()
    editor.until(lambda: editor.selection == ("table_1",))
    editor.settle()
    table = session.scene.object("table_1")
    at_rest(editor, table.pose.position)
    gestures = editor.client.handles
    assert isinstance(gestures, Gestures)
    assert gestures._gizmo_key is not None
    scale = gestures._gizmo_key[2]
    # The first handles of a page take a while on a slow machine.
    editor.page.wait_for_function(LIFTED)
    # The arc between the x and y arms, in the object's frame, two thirds out.
    at = 0.6 * scale
    start, end = (
        editor.place_of(table.pose.position + table.pose.R_world_object @ np.array([at * np.cos(a), at * np.sin(a), 0]))
        for a in (np.radians(45), np.radians(80))
    )
    editor.drag(start, end)
    editor.until(lambda: session.scene.object("table_1").pose != table.pose, "something moved")
    now = session.scene.object("table_1").pose
    np.testing.assert_allclose(now.position, table.pose.position, atol=1e-6)
    assert abs(now.yaw_rad - table.pose.yaw_rad) > 0.1, "turned, not moved"


def test_what_is_pasted_into_another_project_lands_in_view_inside(
    serve: Callable[..., Running], visit: Callable[[Running], EditorPage], tmp_path: Path
) -> None:
    far = make_project(tmp_path / "projects" / "far")
    moved = edits.move(far.load_scene(), "table_1", far.load_scene().object("table_1").pose.move((40.0, 9.0, 3.0)))
    far.save_scene(moved)
    make_project(tmp_path / "projects" / "near")
    editor = visit(serve(far.folder, PlainLibrary()))
    editor.row("dining table").click()
    editor.until(lambda: editor.selection == ("table_1",))
    editor.page.keyboard.press("Control+c")
    editor.until(lambda: editor.session.shared.clip is not None, "copied")
    editor.page.evaluate("window.__dioGoTo('near')")
    editor.until(lambda: editor.session.project.name == "near" and bool(editor.session.clients), "another project")
    editor.settle()
    before = {o.id for o in editor.session.scene.objects}
    editor.page.keyboard.press("Control+v")
    editor.until(lambda: len(editor.session.scene.objects) == len(before) + 2, "the table with its lamp")
    scene = editor.session.scene
    table = next(o for o in scene.objects if o.id not in before and o.category == "table")
    floor = scene.architecture.floor
    assert floor is not None
    low, high = floor.polygon.min(axis=0), floor.polygon.max(axis=0)
    assert (table.corners_world[:, :2] >= low[:2] - 1e-6).all()
    assert (table.corners_world[:, :2] <= high[:2] + 1e-6).all()
    assert table.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    x, y = editor.place_of(table.pose.position)
    left, top, width, height = editor.canvas_box()
    assert left < x < left + width
    assert top < y < top + height


def test_a_table_on_a_lamp_is_refused_with_the_reason_and_done_anyway(editor: EditorPage) -> None:
    session = editor.session
    session.ui_thread.post(lambda: session.edit("down", lambda s: edits.attach(s, Support("lamp_1", "floor"))))
    editor.until(lambda: session.scene.support_of("lamp_1").parent == "floor")
    editor.settle()
    expect(editor.page.locator(".dio .row .chip", has_text="floats")).to_be_visible()  # its card moves the rows down
    row = editor.page.locator('.dio .row[data-grab="table_1"]')
    row.drag_to(editor.page.locator('.dio .row[data-drop="lamp_1"]'))
    editor.notice("much larger than lamp")
    assert session.scene.support_of("table_1").parent == "floor"
    editor.button("Put it there anyway").click()
    editor.until(lambda: session.scene.support_of("table_1").parent == "lamp_1", "anyway")


def test_what_a_recipe_made_worse_is_named_marked_and_put_back(editor: EditorPage) -> None:
    session = editor.session
    before = session.scene

    def beside_the_table(scene: Scene) -> Scene:
        lamp = scene.object("lamp_1")
        return edits.place(scene, {"lamp_1": lamp.pose.move((1.2, 0.0, 0.0))})

    def ended() -> None:
        run = session.layout_run = LayoutRun("paper", 0.0, before)
        final = beside_the_table(before)
        run.worse = commands.new_problems(
            commands.problems(before, session.library, Collisions(session.library)),
            commands.problems(final, session.library, Collisions(session.library)),
        )
        report = LayoutReport("paper", {"overlapping_pairs": 1.0}, {"overlapping_pairs": 2.0, "moved_m": 0.73}, 1.0)
        commands._arrange(editor.session, final, report, run, by=editor.client, author="")

    session.ui_thread.post(ended)
    editor.until(lambda: session.scene.object("lamp_1").pose != before.object("lamp_1").pose, "arranged")
    editor.tab("Arrange")
    card = editor.page.locator(".dio .card", has_text="What got worse")
    expect(card).to_contain_text("1 object floats: lamp")
    expect(card).to_contain_text("Overlapping pairs went from 1 to 2")
    expect(card).to_contain_text("73 cm")
    expect(card.get_by_role("button", name="Tidy up")).to_be_visible()
    editor.until(lambda: "floats" in session.badges.get("lamp_1", ()), "marked in the list and the view")
    card.get_by_role("button", name="Put back what got worse").click()
    editor.until(lambda: session.scene.object("lamp_1").pose == before.object("lamp_1").pose, "put back")


def test_rows_that_can_carry_what_is_dragged_are_marked_until_it_is_dropped(editor: EditorPage) -> None:
    editor.tab("Scene")
    editor.settle()
    marked = editor.page.locator(".dio .row.takes")

    def pulled(object_id: str, onto: str) -> set[str]:
        """The marked rows while one is dragged over another."""
        row, other = (editor.page.locator(f".dio .row[data-{w}]") for w in (f'grab="{object_id}"', f'drop="{onto}"'))
        editor.settle()  # the list is drawn again after each edit
        editor.pull(_middle(row), _middle(other))
        editor.until(lambda: marked.count() > 0, "places to drop onto are marked")
        return set(marked.evaluate_all("rows => rows.map(r => r.dataset.drop)"))

    names = pulled("lamp_1", "chair_1")
    assert {"floor", "chair_1"} <= names
    assert not names & {"table_1", "lamp_1", "wall_1", "ceiling"}, "not where it stands, and lamps stand on no walls"
    keep_picture(editor, "rows_that_take")
    editor.page.mouse.move(*_middle(editor.page.locator('.dio .row[data-drop="floor"]')))
    editor.page.mouse.up()
    editor.until(lambda: marked.count() == 0, "no marks are left")
    assert "wall_1" in pulled("picture_1", "wall_1")
    editor.page.mouse.up()
    editor.until(lambda: marked.count() == 0, "none again")


def _middle(element: Locator) -> tuple[float, float]:
    box = element.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 3, box["y"] + box["height"] / 2
