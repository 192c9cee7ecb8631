"""A home on the page: a room joins at a door, rooms are shown apart, furniture goes from room to room, with undo."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_core.editing.homes import join
from diorama_core.geometry.rooms import doorways, rooms_of_objects
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.small_room import PlainLibrary, furnished_scene, make_project
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture
from tests.e2e.test_plan import drag_by, is_still
from tests.editing.test_homes import with_door

pytestmark = pytest.mark.browser
DOOR = ("picture_a", PlainLibrary().shape("picture_a").size_m)
"""The plain library has no doors: a flat shape stands for one."""


def room(door: str, wall: str) -> Scene:
    return with_door(furnished_scene(), door, wall, 0.3, DOOR)


@pytest.fixture
def flat(editor: EditorPage) -> Iterator[EditorPage]:
    """Two rooms with a door between them."""
    made = join(room("door_1", "wall_3"), room("door_1", "wall_1"), "door_1", "door_1", names=("hall", "study"))
    editor.session.ui_thread.post(lambda: editor.session.edit("make a home", lambda s: made.scene, by=editor.client))
    editor.until(lambda: len(editor.session.scene.rooms) == 2, "a home")
    editor.settle()
    yield editor
    editor.client.rooms = frozenset()


def test_a_project_joins_at_a_door_and_undo_takes_it_back(editor: EditorPage, tmp_path: Path) -> None:
    page, session = editor.page, editor.session
    make_project(tmp_path / "projects" / "study", room("way_in", "wall_1"))
    with_own = room("door_1", "wall_3")
    session.ui_thread.post(lambda: session.edit("add a door", lambda s: with_own, by=editor.client))
    editor.until(lambda: session.scene.has_object("door_1"), "a door")
    chooser = editor.unfold("Home", page.get_by_label("Join another project"))
    chooser.select_option(label="study")
    door = page.locator('.joins [aria-label="way_in"]')
    expect(door).to_be_visible()
    expect(editor.button("Join here")).to_be_disabled()
    door.click()
    expect(page.locator(".joins .on")).to_have_count(1)
    keep_picture(editor, "home-joining")
    session.ui_thread.post(lambda: editor.client.select(("door_1",)))
    expect(editor.button("Join here")).to_be_enabled()
    editor.button("Join here").click()
    editor.until(lambda: len(session.scene.rooms) == 2, "joined")
    assert [r.name for r in session.scene.rooms] == ["demo", "study"]
    assert len(doorways(session.scene)) == 1
    expect(editor.button("study")).to_be_visible()
    keep_picture(editor, "home-joined")
    page.keyboard.press("Control+z")
    editor.until(lambda: session.scene == with_own, "one undo step")


def test_rooms_are_shown_alone_without_a_change(flat: EditorPage) -> None:
    before = flat.session.scene
    study, hall = flat.unfold("Home", flat.button("study")), flat.button("hall")
    study.click()
    names = [flat.session.viewport.plane_name(r.floor) for r in before.rooms]
    drawn = (
        "(name) => { let on = false; window.__viserMutable.nodeRefFromName[name]?.traverse("
        "(o) => { on = on || (o.isMesh && o.visible && o.material.type !== 'ShadowMaterial'); }); return on; }"
    )

    def shown() -> list[bool]:
        flat.settle()
        return [bool(flat.page.evaluate(drawn, name)) for name in names]

    flat.until(lambda: shown() == [False, True], "the study alone")
    keep_picture(flat, "home-study-alone")
    hall.click()
    flat.until(lambda: shown() == [True, False], "the hall alone")
    flat.button("Whole home").click()
    flat.until(lambda: shown() == [True, True], "all of it")
    keep_picture(flat, "home-whole")
    assert flat.session.scene is before


def test_what_is_dragged_through_the_door_is_in_the_other_room(flat: EditorPage) -> None:
    page, session = flat.page, flat.session
    before = session.scene
    hall, study = before.rooms
    assert rooms_of_objects(before)["chair_1"] == hall.id
    page.keyboard.press("7")
    expect(page.locator("#dio-plan svg")).to_be_visible()
    expect(page.locator("#dio-plan .label.room")).to_have_text(["hall", "study"])
    flat.until(lambda: is_still(flat), "fitted to the page")
    keep_picture(flat, "home-plan")
    chair = before.object("chair_1").pose.position
    drag_by(flat, chair, (1.2, 3.6))
    flat.until(lambda: rooms_of_objects(session.scene)["chair_1"] == study.id, "in the study")
    edge = session.scene.support_of("chair_1")
    assert edge is not None
    assert edge.parent == study.floor
    np.testing.assert_allclose(session.scene.object("chair_1").pose.position[2], chair[2], atol=1e-6)
    page.keyboard.press("Control+z")
    flat.until(lambda: session.scene == before, "back in the hall")
    flat.tool("Room").click()


def test_undo_of_one_room_leaves_the_other(flat: EditorPage) -> None:
    page, session = flat.page, flat.session
    hall = session.scene.rooms[0]

    def lobby(scene: Scene) -> Scene:
        return edits.set_room(scene, hall.id, name="lobby")

    session.ui_thread.post(lambda: session.edit("rename the hall", lobby, author="a program"))
    flat.until(lambda: session.scene.rooms[0].name == "lobby", "a program renamed the hall")
    name = flat.unfold("Home", page.get_by_label("Name of study"))
    name.fill("office")
    name.press("Enter")
    flat.until(lambda: [r.name for r in session.scene.rooms] == ["lobby", "office"], "the study is renamed, too")
    session.ui_thread.post(lambda: session.undo("a program"))
    flat.until(lambda: [r.name for r in session.scene.rooms] == ["hall", "office"], "the hall alone is taken back")
    expect(flat.button("hall")).to_be_visible()
    flat.tool("Undo").click()
    flat.until(lambda: [r.name for r in session.scene.rooms] == ["hall", "study"], "and then the study")
