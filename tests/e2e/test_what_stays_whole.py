"""What one step accepts the next does not refuse: files of flat things, sizes after a layout, thin rails, additions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from playwright.sync_api import expect

from diorama_app.commands import optimise
from diorama_app.serve import Running
from diorama_app.session.layout_run import LayoutRun
from diorama_app.session.session import EditorSession
from diorama_core.artefacts import LabelledBox, LayoutReport
from diorama_core.editing.collisions import Collisions
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.user_library import ProjectShapes, UserLibrary
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene, SceneObject, Support
from tests.app.small_room import furnished_scene, make_project
from tests.e2e.browser import LEARN_MS, EditorPage
from tests.library.test_simplify import pieces, scene_of

pytestmark = pytest.mark.browser


@pytest.fixture
def flat_file(tmp_path: Path) -> Path:
    """A room of a program that gives a poster no thickness, and a rug neither."""
    room = trimesh.Scene()
    at = trimesh.transformations.translation_matrix
    room.add_geometry(trimesh.creation.box((4.0, 0.02, 4.0)), node_name="floor", transform=at((0, -0.01, 0)))
    room.add_geometry(trimesh.creation.box((0.5, 0.9, 0.5)), node_name="chair", transform=at((1, 0.45, 0)))
    corners = np.array([[-0.3, -0.4, 0.0], [0.3, -0.4, 0.0], [0.3, 0.4, 0.0], [-0.3, 0.4, 0.0]])
    poster = trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 3]], process=False)
    room.add_geometry(poster, node_name="poster", transform=at((-0.5, 1.4, -1.9)))
    rug = poster.copy().apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, (1, 0, 0)))
    room.add_geometry(rug.apply_scale(2.5), node_name="rug", transform=at((0, 0.001, 0.6)))
    path = tmp_path / "flat things.glb"
    path.write_bytes(room.export(file_type="glb"))
    return path


def _shared(editor: EditorPage) -> UserLibrary:
    library = editor.running.session.library
    shared = library.shared if isinstance(library, ProjectShapes) else library
    assert isinstance(shared, UserLibrary)
    return shared


def _open(editor: EditorPage, path: Path, folder: str) -> EditorSession:
    """Upload a file and wait for the project in a folder of this name."""
    editor.tab("Project")
    editor.upload("Open a file", path)
    sessions: list[EditorSession] = []

    def is_open() -> bool:
        there = [e.session for e in editor.running.workspace.editors]
        sessions[:] = [s for s in there if s.project is not None and s.project.folder.name == folder and s.clients]
        return bool(sessions)

    editor.until(is_open, "opened", LEARN_MS / 1000)
    return sessions[0]


def test_a_file_of_flat_things_opens_again_and_leaves_the_library_alone(editor: EditorPage, flat_file: Path) -> None:
    before = {s.id for s in _shared(editor).uploads()}
    session = _open(editor, flat_file, "flat-things")
    assert len(session.scene.objects) == 3
    assert all(min(*o.size_m, *o.shape_size_m) > 0 for o in session.scene.objects)
    session.autosave.flush()
    assert session.project is not None
    assert len(session.project.load_scene().objects) == 3, "it opens again"
    editor.settle()
    assert {s.id for s in _shared(editor).uploads()} == before, "the shapes are their projects' own"
    editor.tab("Library")
    editor.page.get_by_role("button", name="Mine").click()
    expect(editor.page.locator(".dio .tile:visible")).to_have_count(len(before))


def test_sizes_that_a_recipe_changed_are_told_and_put_back(editor: EditorPage) -> None:
    session, before = editor.session, editor.session.scene
    lamp = before.object("lamp_1")
    shrunk = edits.resize(before, "lamp_1", 0.35 * lamp.size_m)

    def ended() -> None:
        run = session.layout_run = LayoutRun("paper", 0.0, before)
        run.worse = optimise._worse(session, before, shrunk)
        optimise._arrange(session, shrunk, LayoutReport("paper", {}, {}, 1.0), run, by=editor.client, author="")

    session.ui_thread.post(ended)
    editor.until(lambda: session.scene.object("lamp_1").pose != lamp.pose, "arranged")
    editor.tab("Arrange")
    resized = editor.page.locator(".dio .card", has_text="Resized: lamp, 24 x 24 x 45 to 8 x 8 x 16 cm")
    expect(resized).to_be_visible()
    worse = editor.page.locator(".dio .card", has_text="What got worse")
    expect(worse).to_contain_text("1 object was resized: lamp")
    worse.get_by_role("button", name="Put back what got worse").click()
    editor.until(lambda: session.scene.object("lamp_1").pose == lamp.pose, "as large as it was")
    expect(resized).to_have_count(0)
    expect(worse).to_have_count(0)


def test_tidying_up_changes_no_side_by_more_than_a_quarter(editor: EditorPage) -> None:
    session, start = editor.session, editor.session.scene
    inside = start.object("chair_1").pose.move((0.9, 0.6, 0.25))  # half in the table, and floating
    session.ui_thread.post(lambda: session.edit("push", lambda s: edits.move(s, "chair_1", inside)))
    editor.until(lambda: session.scene.object("chair_1").pose == inside)
    editor.tab("Arrange")
    editor.button("Optimise layout").click()
    editor.until(lambda: session.jobs.status is None and session.layout_run is not None, "tidied", seconds=90)
    editor.until(lambda: session.layout_run is not None and session.layout_run.final is not None, "told")
    for item in session.scene.objects:
        ratio = item.size_m / start.object(item.id).size_m
        assert (np.abs(np.log(ratio)) < np.log(1.26)).all(), item.id


def test_low_graphics_keep_the_rails_of_an_iron_bed(
    serve: Callable[..., Running], visit: Callable[[Running], EditorPage], tmp_path: Path
) -> None:
    """Many beds: each gets few triangles, as in a crowded room."""
    library, scene = built_in_library(), furnished_scene()
    shape = library.shape("bed-iron")
    beds = tuple(
        SceneObject(
            f"bed_{k}", "bed", "bed", shape.id, shape.size_m, Pose.upright((0.02 * k, 1.5, shape.size_m[2] / 2))
        )
        for k in range(40)
    )
    crowded = Scene(scene.camera, scene.architecture, beds, tuple(Support(b.id, "floor") for b in beds))
    editor = visit(serve(make_project(tmp_path / "projects" / "beds", crowded).folder))
    name = editor.session.viewport.node_name("bed_0")
    editor.page.wait_for_function(f"({DRAWN})('{name}').length > 0")
    corners = editor.page.evaluate(f"({DRAWN})('{name}')")
    drawn = trimesh.Scene(
        [trimesh.Trimesh(np.reshape(c["at"], (-1, 3)), np.reshape(c["faces"], (-1, 3)), process=False) for c in corners]
    )
    whole = pieces(scene_of(library.glb(shape.id)))
    full = sum(len(g.faces) for g in scene_of(library.glb(shape.id)).geometry.values())
    assert sum(len(g.faces) for g in drawn.geometry.values()) < 0.75 * full, "a lighter mesh is drawn"
    assert len(whole) > 20
    assert len(pieces(drawn)) >= len(whole)


DRAWN = """(id) => {
    const all = Object.entries(window.__viserMutable.nodeRefFromName);
    const root = all.filter(([n]) => n === id || n.startsWith(id + '/'));
    const found = [];
    for (const [, node] of root) node && node.traverse((o) => {
        if (!o.isMesh || !o.geometry.index || found.some((f) => f.key === o.geometry.uuid)) return;
        found.push({key: o.geometry.uuid, at: Array.from(o.geometry.attributes.position.array),
                    faces: Array.from(o.geometry.index.array)});
    });
    return found;
}"""
"""The triangles on the screen of one object."""


def test_what_is_added_from_the_photo_stands_where_it_stands_there(editor: EditorPage) -> None:
    session, scene = editor.session, editor.session.scene
    assert scene.camera is not None
    x, y = map(float, scene.camera.project(np.array([[-0.25, 2.05, 0.74]]))[0])  # on the table, left of the lamp
    box = LabelledBox((x - 22.0, y - 70.0, x + 22.0, y + 4.0), "lamp", "lamp")
    assert session.inputs is not None
    marked = replace(session.inputs, boxes=(*session.inputs.boxes, box))
    session.ui_thread.post(lambda: session.edit("mark", lambda s: s, inputs=marked))
    editor.tab("Photo")
    editor.page.locator(".dio .row[data-do=mark]", has_text="lamp").last.click()
    editor.button("Add selected box to the scene").click()
    editor.until(lambda: session.jobs.status is None and len(session.scene.objects) == 6, "added", seconds=90)
    new = session.scene.objects[-1]
    edge = session.scene.support_of(new.id)
    assert edge is not None
    assert new.corners_world[:, 2].min() == pytest.approx(0.74, abs=0.01)
    assert edge.parent == "table_1"
    assert not Collisions(session.library).pairs(session.scene, [new.id])
