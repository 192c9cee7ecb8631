"""The panels: photo and boxes, library, layout, projects, and what happens when something is wrong."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from playwright.sync_api import expect

from diorama_app.commands.edit import rename
from diorama_app.panels.in_place import InPlace
from diorama_app.panels.outliner import Outliner
from diorama_app.serve import Running
from diorama_app.session.jobs import JobKind
from diorama_app.web import visitors
from diorama_core.progress import Progress, ProgressEvent
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene
from tests.app.small_room import PlainLibrary, furnished_scene, make_project
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import ARTEFACTS

pytestmark = pytest.mark.browser

WATCH = """(name) => {
    window.__heights = [];
    const look = () => {
        const node = window.__viserMutable.nodeRefFromName[name];
        const z = node ? Math.round(1000 * node.position.z) : null;
        if (!window.__heights.includes(z)) window.__heights.push(z);
        requestAnimationFrame(look);
    };
    look();
}"""
"""Notes every height at which a node is drawn."""

WATCH_PRAISE = """() => {
    window.__praise = { made: false, seen: false };
    new MutationObserver(() => {
        for (const notice of document.querySelectorAll('.mantine-Notification-root')) {
            if (!notice.textContent.includes('uploaded successfully')) continue;
            window.__praise.made = true;
            if (notice.getClientRects().length) window.__praise.seen = true;
        }
    }).observe(document.body, { childList: true, subtree: true, characterData: true });
}"""
"""Notes whether viser's notice that a file was uploaded was made, and whether it was seen."""


def test_what_cannot_be_used_is_one_clear_notice_and_nothing_is_lost(
    editor: EditorPage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = editor.running.session
    scene, inputs = session.scene, session.inputs
    words = tmp_path / "words.jpg"
    words.write_text("this is no picture")
    empty = tmp_path / "empty.jpg"
    empty.write_bytes(b"")
    editor.tab("Photo")
    editor.page.evaluate(WATCH_PRAISE)
    for path in (words, empty):
        editor.upload("Upload a photo", path)
        editor.notice(path.name)
        assert session.scene is scene
        assert session.inputs is inputs
        editor.dismiss_notices()
    assert editor.page.evaluate("window.__praise") == {"made": True, "seen": False}
    monkeypatch.setattr(visitors, "MAX_UPLOAD_BYTES", 1000)
    large = tmp_path / "large.jpg"
    large.write_bytes(b"\xff" * 5000)
    editor.upload("Upload a photo", large)
    editor.notice("can be uploaded")
    assert session.inputs is inputs


def test_a_shape_found_by_words_is_inserted_on_the_selected_table(editor: EditorPage) -> None:
    session = editor.running.session
    editor.row("dining table").click()
    editor.until(lambda: editor.selection == ("table_1",))
    editor.tab("Library")
    field = editor.page.locator(".mantine-Flex-root", has_text="Search").locator("input")
    field.fill("lamp")
    tile = editor.page.locator(".dio .tile:visible", has_text="lamp a")
    expect(editor.page.locator(".dio .tile:visible", has_text="chair a")).to_have_count(0)
    tile.get_by_role("button", name="Insert").click()
    editor.until(lambda: len(session.scene.objects) == 6, "inserted")
    new = session.scene.object(editor.selection[0])
    assert session.scene.support_of(new.id).parent == "table_1"
    assert new.corners_world[:, 2].min() == pytest.approx(0.74, abs=1e-6)
    editor.settle()
    shown = editor.page.evaluate("Object.keys(window.__viserMutable.nodeRefFromName)")
    assert any(n.startswith(str(session.viewport.node_name(new.id))) for n in shown)


@pytest.mark.parametrize("recipe", ["Tidy up", "As in the paper"])
def test_the_layout_is_optimised_before_your_eyes_and_undone(editor: EditorPage, recipe: str) -> None:
    session = editor.running.session
    lifted = session.scene.object("chair_1").pose.move((0.0, 0.0, 0.3))
    session.ui_thread.post(lambda: session.edit("lift", lambda s: _with_pose(s, "chair_1", lifted)))
    editor.until(lambda: session.scene.object("chair_1").pose == lifted)
    editor.settle()  # rows move down when the chair is said to float: a click in between would be on two of them
    editor.row("picture").click()
    editor.page.keyboard.press("l")
    editor.until(lambda: session.scene.object("picture_1").locked)
    picture = session.scene.object("picture_1").pose
    before = session.scene
    editor.tab("Arrange")
    editor.page.get_by_label("Recipe").click()
    editor.page.get_by_role("option", name=recipe).click()
    node = session.viewport.node_name("chair_1")
    editor.page.evaluate(WATCH, node)
    editor.button("Optimise layout").click()
    editor.until(lambda: session.jobs.status is None and session.scene is not before, "arranged", seconds=90)
    editor.settle()
    assert session.scene.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=0.01)
    assert session.scene.object("picture_1").pose == picture
    assert len(editor.page.evaluate("window.__heights")) > 2, "the chair is seen on its way"
    expect(editor.page.get_by_text("Before → after")).to_be_visible()
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: session.scene.object("chair_1").pose == lifted, "one undo takes it back")


def test_cancelling_the_optimiser_restores_everything(editor: EditorPage, monkeypatch: pytest.MonkeyPatch) -> None:
    session, begin = editor.running.session, editor.running.session.jobs.start
    reported, pressed = threading.Event(), threading.Event()
    before = session.scene

    def held(kind: JobKind, title: str, work: Callable[[Progress], None]) -> None:
        """The optimiser goes on from its first report when *Cancel* was pressed: it would have ended before."""

        def slow(progress: Progress) -> None:
            def told(event: ProgressEvent) -> None:
                progress.on_event(event)
                reported.set()
                pressed.wait(60.0)

            work(replace(progress, on_event=told))

        begin(kind, title, slow)

    monkeypatch.setattr(session.jobs, "start", held)
    editor.tab("Arrange")
    editor.page.get_by_label("Recipe").click()
    editor.page.get_by_role("option", name="All in one").click()
    editor.button("Optimise layout").click()
    editor.until(reported.is_set, "it runs: cancelled earlier, it ends before its wish to stop is seen")
    editor.button("Cancel").click()
    editor.until(lambda: session.jobs.status is not None and session.jobs.status.cancelling, "it is asked to stop")
    pressed.set()
    editor.until(lambda: session.jobs.status is None, "stopped")
    editor.notice("nothing was changed")
    assert session.scene is before


def test_projects_are_saved_reopened_and_exported(editor: EditorPage, tmp_path: Path) -> None:
    session = editor.running.session
    projects = tmp_path / "projects"
    make_project(projects / "second", furnished_scene())
    editor.row("lamp").click()
    editor.button("Delete").click()
    editor.until(lambda: not session.scene.has_object("lamp_1"))
    saved = Project.open(projects / "demo")
    editor.until(lambda: not saved.load_scene().has_object("lamp_1"), "saved by itself")
    editor.tab("Export")
    with editor.page.expect_download() as download:
        editor.button("Export .glb").click()
    path = tmp_path / "room.glb"
    download.value.save_as(path)
    model = trimesh.load_scene(path)
    assert np.sort(model.extents)[-1] == pytest.approx(4.4, abs=0.3)
    editor.tab("Project")
    session.ui_thread.post(session.refresh)
    editor.page.locator(".dio .row", has_text="second").get_by_role("button", name="Open").click()
    editor.until(lambda: editor.session.project is not None and editor.session.project.name == "second", "opened")
    editor.until(lambda: editor.session.scene.has_object("lamp_1"), "its scene is shown")
    editor.tab("Project")
    expect(editor.page.locator(".dio .row", has_text="demo").get_by_role("button", name="Open")).to_be_visible()


def test_the_photo_view_stands_where_the_photo_was_taken(editor: EditorPage) -> None:
    session = editor.running.session
    camera = session.scene.camera
    assert camera is not None
    editor.tool("Photo").click()
    view = editor.client.view
    editor.until(lambda: view.camera.through_photo)
    editor.settle()
    for point in (session.scene.object("table_1").pose.position, np.array([1.0, 2.0, 0.0])):
        u, v = camera.project(point) - (camera.intrinsics.cx, camera.intrinsics.cy)
        box = editor.canvas_box()
        x, y = editor.place_of(point)
        scale = (box[3] / 2) / np.tan(view.camera.fov_rad / 2) / camera.intrinsics.fy
        assert x - (box[0] + box[2] / 2) == pytest.approx(u * scale, abs=2.5)
        assert y - (box[1] + box[3] / 2) == pytest.approx(v * scale, abs=2.5)
    editor.page.get_by_role("slider", name="Opacity of the photo over the model").fill("100")
    editor.until(lambda: view.photo.opacity > 0.0, "the photo lies over the model")
    brown = camera.position + camera.rays(np.array([340.0, 310.0]))
    editor.until(lambda: np.allclose(editor.mean_colour(brown), (120, 80, 50), atol=25), "its picture is drawn")
    editor.tool("Room").click()
    editor.until(lambda: view.photo.opacity == 0.0 and not view.camera.through_photo, "the model alone again")


def test_an_empty_room_says_what_to_do(
    serve: Callable[..., Running], visit: Callable[[Running], EditorPage], tmp_path: Path
) -> None:
    project = make_project(tmp_path / "projects" / "empty", Scene())
    editor = visit(serve(project.folder, PlainLibrary()))
    expect(editor.page.get_by_text("Nothing here yet.")).to_be_visible()
    editor.button("Start with a photo").click()
    expect(editor.page.get_by_role("tab", name="Photo", exact=True)).to_have_attribute("aria-selected", "true")
    editor.tab("Scene")
    editor.tab("Arrange")
    expect(editor.button("Optimise layout")).to_be_disabled()


def _with_pose(scene: Scene, object_id: str, pose: Pose) -> Scene:
    return edits.move(scene, object_id, pose)


def test_a_panel_that_fails_is_one_line_in_its_place_until_it_works_again(
    editor: EditorPage, monkeypatch: pytest.MonkeyPatch
) -> None:
    session, page = editor.running.session, editor.page
    editor.tab("Scene")
    outliner = next(p.panel for p in editor.client.panels if isinstance(p, InPlace) and isinstance(p.panel, Outliner))
    line = page.get_by_text("The list of objects cannot be shown (RuntimeError). Your work is saved.")

    def fails() -> None:
        raise RuntimeError("a fault of the program")

    def named(label: str) -> None:
        session.ui_thread.post(lambda: rename(editor.client, "chair_1", label))
        editor.until(lambda: session.scene.object("chair_1").label == label, "renamed")

    with monkeypatch.context() as patch:
        patch.setattr(outliner, "refresh", fails)
        named("throne")
        expect(line).to_be_visible()
        expect(editor.row("dining table")).to_be_hidden()
        expect(page.get_by_role("tab", name="Photo", exact=True)).to_be_visible()
        editor.picture(ARTEFACTS / "a panel that fails.png")
        assert page.locator(".mantine-Notification-root").count() == 0, "no notice beside the line"
        session.autosave.flush()
        assert session.project is not None
        assert session.project.load_scene().object("chair_1").label == "throne"
    named("armchair")
    expect(line).to_be_hidden()
    expect(editor.row("armchair")).to_be_visible()
