"""From a photo to a downloaded model, as the README promises, step by step, in a real browser."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from playwright.sync_api import expect

from diorama_app.projects.example import EXAMPLE
from diorama_app.serve import Running
from diorama_core.scene.types import Scene, SceneObject
from tests.conftest import SHARED
from tests.e2e.browser import EditorPage
from tests.few_shapes import example_scene, few_shapes

pytestmark = [pytest.mark.browser, pytest.mark.slow]

MARKED = 3
"""Boxes of the photo, or its build would be most of the test's time."""
BUILD_S = 300
"""A build takes some fifteen seconds of two free cores; test machines are often busy."""


@pytest.fixture
def with_example(serve: Callable[..., Running]) -> Running:
    """A server as it starts the first time: on the bundled example."""
    return serve()


def test_the_example_is_there_and_is_swapped_moved_undone_optimised_and_downloaded(
    with_example: Running, visit: Callable[[Running], EditorPage], tmp_path: Path
) -> None:
    editor = visit(with_example)
    session = with_example.session
    assert session.photo is not None
    assert session.scene.architecture.floor is not None
    editor.page.wait_for_function("'/photo_camera' in window.__viserMutable.nodeRefFromName")
    names = editor.page.evaluate("Object.keys(window.__viserMutable.nodeRefFromName)")
    assert sum("/objects/" in n and "/v" in n for n in names) >= len(session.scene.objects)

    chair = _swappable(session.scene)
    _click_on(editor, chair)
    editor.page.locator(".dio .tile:not(.on)[data-do=swap]").first.click()
    editor.until(lambda: session.scene.object(chair.id).shape_id != chair.shape_id, "swapped")
    editor.settle()
    swapped = session.scene.object(chair.id)
    goal = round(float(swapped.pose.position[0]) - 0.2, 2)
    editor.numbers()
    editor.page.get_by_label("Position: x").fill(f"{goal:.2f}")
    editor.page.keyboard.press("Enter")
    editor.until(lambda: abs(session.scene.object(chair.id).pose.position[0] - goal) < 1e-3, "moved")
    editor.tool("Undo").click()
    editor.until(lambda: session.scene.object(chair.id).pose == swapped.pose, "undone")

    editor.tab("Arrange")
    before = session.scene
    editor.button("Optimise layout").click()
    editor.until(lambda: session.jobs.status is None and session.scene is not before, "arranged", seconds=BUILD_S)
    assert session.document.history.current.label == "tidy up"
    expect(editor.page.get_by_text("Before → after")).to_be_visible()

    editor.tab("Export")
    with editor.page.expect_download(timeout=90_000) as download:
        editor.button("Export .glb").click()
    path = tmp_path / "room.glb"
    download.value.save_as(path)
    _check_model(path, session.scene)


def test_a_photo_with_boxes_becomes_a_scene(
    serve: Callable[..., Running], visit: Callable[[Running], EditorPage], tmp_path: Path
) -> None:
    photo, all_boxes = _photo_with_boxes()
    boxes = tmp_path / "boxes.json"
    boxes.write_text(json.dumps(all_boxes[:MARKED]))
    editor = visit(serve(library=few_shapes(example_scene())))
    session = editor.session
    example = session.scene

    editor.tab("Photo")
    editor.upload("Upload a photo", photo)
    editor.until(lambda: editor.session.photo is not None and editor.session.photo.name == photo.name, "read")
    assert session.scene is example, "the example stays as it is"
    session = editor.session
    editor.page.get_by_text("More", exact=True).click()
    editor.upload("Add boxes", boxes)
    editor.until(lambda: len(session.inputs.boxes) == MARKED, "the boxes are read")
    marked = len(session.inputs.boxes)
    editor.until(lambda: session.jobs.status is None, "the build that nobody asked for ends")
    assert not session.scene.objects, "and nothing was built without the boxes"
    before = session.scene
    editor.dismiss_notices()
    editor.build_button().click()
    editor.until(lambda: session.jobs.status is None and session.scene is not before, "built", seconds=BUILD_S)
    assert len(session.scene.objects) >= 0.9 * marked
    assert session.scene.architecture.floor is not None
    assert session.scene.architecture.by_role("wall")
    editor.tab("Scene")
    expect(editor.page.locator(".dio .row[data-grab]:visible")).to_have_count(len(session.scene.objects))


def _photo_with_boxes() -> tuple[Path, list[dict[str, Any]]]:
    """A real photo where there are any, else the example's own."""
    folder = SHARED / "photos"
    if folder.is_dir():
        return folder / "im3d_4.jpg", json.loads((folder / "im3d_4_detections.json").read_text())
    return EXAMPLE / "photo.jpg", json.loads((EXAMPLE / "boxes.json").read_text())["boxes"]


def _swappable(scene: Scene) -> SceneObject:
    """A chair with alternatives, or else whatever has some and stands free."""
    ready = [o for o in scene.objects if len({c.shape_id for c in o.candidates}) > 1]
    assert ready, "no object has alternatives"
    return next((o for o in ready if "chair" in o.category), ready[0])


def _click_on(editor: EditorPage, item: SceneObject) -> None:
    """Click the object in the view, where it is seen; through the list when something hides it."""
    editor.page.keyboard.press("r")
    editor.settle()
    x, y = editor.place_of(item.pose.position)
    if editor.on_canvas(x, y):
        editor.page.mouse.move(x, y)
        editor.settle()
        editor.page.mouse.click(x, y)
        editor.page.wait_for_timeout(500)
    if editor.selection != (item.id,):
        editor.tab("Scene")
        editor.page.locator(f'.dio .row[data-arg="{item.id}"] .name').click()
    editor.until(lambda: editor.selection == (item.id,), f"{item.label} is selected")


def _check_model(path: Path, scene: Scene) -> None:
    model = trimesh.load_scene(path)
    assert len(model.geometry) >= len(scene.objects)
    sizes = np.sort(model.extents)
    corners = np.concatenate([o.corners_world for o in scene.objects] + [p.polygon for p in scene.architecture.planes])
    np.testing.assert_allclose(sizes, np.sort(np.ptp(corners, axis=0)), atol=0.3)
