"""Files that leave the page and come back: formats with their options, a file opened as a project, pictures."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from PIL import Image
from playwright.sync_api import BrowserContext, Download, Locator, expect

from diorama_app.projects import formats
from diorama_app.serve import start
from diorama_core.project.storage import Project
from diorama_core.scene.schema import scene_to_json
from tests.e2e.browser import LEARN_MS, PATIENCE_MS, QUERY, EditorPage
from tests.e2e.conftest import keep_picture
from tests.export import gltf_reader

pytestmark = [pytest.mark.browser, pytest.mark.slow]

JOB_MS = 120_000
"""Seconds on two free cores; test machines are often busy."""


@dataclass(frozen=True)
class GlbFile:
    """What the switches change in a GLB."""

    size: int
    document: dict[str, Any]
    picture_sizes: list[int]
    """Longest sides, in pixels."""

    @classmethod
    def read(cls, path: Path) -> GlbFile:
        content = path.read_bytes()
        document, binary = gltf_reader.read(content)
        longest = []
        for image in document.get("images", ()):
            view = document["bufferViews"][image["bufferView"]]
            start = view.get("byteOffset", 0)
            longest.append(max(Image.open(io.BytesIO(binary[start : start + view["byteLength"]])).size))
        return cls(len(content), document, longest)

    @property
    def nodes(self) -> list[dict[str, Any]]:
        return list(self.document["nodes"])

    @property
    def roles(self) -> set[str]:
        """Roles of the planes."""
        extras = [n.get("extras", {}) for n in self.nodes]
        return {e["role"] for e in extras if "diorama_plane" in e}

    @property
    def has_photo(self) -> bool:
        return any("diorama_photo" in n.get("extras", {}) for n in self.nodes)


@pytest.fixture(scope="module")
def example(context: BrowserContext, tmp_path_factory: pytest.TempPathFactory) -> Iterator[EditorPage]:
    """The bundled example, for the last tests here: it lies over the tab of the others, which is drawn slowly then."""
    page = EditorPage.open(context, start(projects_dir=tmp_path_factory.mktemp("example"), low_graphics=True))
    yield page
    page.page.close()
    page.running.stop()
    assert not page.errors, page.errors


@pytest.fixture(scope="module")
def plain_path(example: EditorPage, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example's GLB, before any switch of it is turned."""
    choose(example, "glb")
    path = download(example, "Export .glb", tmp_path_factory.mktemp("plain") / "my room.glb")
    example.running.session.jobs.wait(30.0)
    return path


def choose(editor: EditorPage, format_name: str) -> None:
    editor.tab("Export")
    editor.page.locator(f'.dio .row[data-do=choose][data-arg="{format_name}"]').click()


def switch(editor: EditorPage, name: str) -> Locator:
    return editor.page.get_by_role("switch", name=name, exact=True)


def turn_on(editor: EditorPage, name: str) -> None:
    switch(editor, name).click()
    expect(switch(editor, name)).to_have_attribute("aria-checked", "true")


def turn_off(editor: EditorPage, name: str) -> None:
    switch(editor, name).click()
    expect(switch(editor, name)).to_have_attribute("aria-checked", "false")


def glb_of(editor: EditorPage, path: Path) -> GlbFile:
    """The chosen GLB as it is downloaded."""
    editor.running.session.jobs.wait(30.0)
    return GlbFile.read(download(editor, "Export .glb", path))


def download(editor: EditorPage, button: str, path: Path) -> Path:
    with editor.page.expect_download(timeout=JOB_MS) as event:
        editor.button(button).click()
    got: Download = event.value
    got.save_as(path)
    return path


def test_every_format_is_offered_with_what_it_keeps_and_where_it_opens(editor: EditorPage) -> None:
    editor.tab("Export")
    rows = editor.page.locator(".dio .row[data-do=choose]")
    expect(rows).to_have_count(len(formats.EXPORT_FORMATS))
    for name, one in formats.EXPORT_FORMATS.items():
        row = editor.page.locator(f'.dio .row[data-do=choose][data-arg="{name}"]')
        expect(row).to_contain_text(one.title)
        expect(row).to_contain_text(formats.GUIDES[name].opens_in)
        row.click()
        expect(editor.page.locator(".dio .card", has_text=f"Keeps {one.keeps}.")).to_be_visible()
        expect(switch(editor, "Welded")).to_have_count(int("welded" in formats.GUIDES[name].choices))


def test_a_format_whose_library_is_missing_says_what_to_install(
    editor: EditorPage, monkeypatch: pytest.MonkeyPatch
) -> None:
    absent = replace(formats.EXPORT_FORMATS["pdf"], needs="a_library_that_nobody_has")
    assert isinstance(formats.EXPORT_FORMATS, dict)
    monkeypatch.setitem(formats.EXPORT_FORMATS, "pdf", absent)
    choose(editor, "pdf")
    expect(editor.page.get_by_text("pip install 'diorama[plan]'")).to_be_visible()
    expect(editor.button("Export .pdf")).to_be_disabled()


def test_options_change_what_is_written(editor: EditorPage, tmp_path: Path) -> None:
    choose(editor, "glb")
    expect(switch(editor, "Only selection")).to_be_disabled()
    expect(switch(editor, "Only selection")).to_contain_text("Select objects first")
    editor.row("dining table").click()
    editor.until(lambda: editor.selection == ("table_1",))
    turn_on(editor, "Only selection")
    model = trimesh.load_scene(download(editor, "Export .glb", tmp_path / "table.glb"))
    np.testing.assert_allclose(np.sort(model.extents), (0.74, 0.8, 1.4), atol=1e-3)
    choose(editor, "mjcf")
    package = zipfile.ZipFile(download(editor, "Export .zip", tmp_path / "table.zip"))
    assert any(name.endswith(".xml") for name in package.namelist())
    editor.running.session.jobs.wait(10.0)


def test_simulators_get_objects_that_move_or_not(editor: EditorPage, tmp_path: Path) -> None:
    choose(editor, "mjcf")
    assert b"freejoint" in model_in(download(editor, "Export .zip", tmp_path / "free.zip"))
    editor.running.session.jobs.wait(10.0)
    turn_on(editor, "Welded")
    assert b"freejoint" not in model_in(download(editor, "Export .zip", tmp_path / "welded.zip"))
    editor.running.session.jobs.wait(10.0)


def model_in(package: Path) -> bytes:
    """The MuJoCo model in a zip."""
    with zipfile.ZipFile(package) as archive:
        return archive.read(next(n for n in archive.namelist() if n.endswith(".xml")))


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("room.glb", b"glTF but then nothing of it", "room.glb"),
        ("room.txt", b"words", "is nothing that is read as a room"),
    ],
)
def test_a_bad_file_is_one_clear_line_and_nothing_is_lost(
    editor: EditorPage, tmp_path: Path, name: str, content: bytes, words: str
) -> None:
    session = editor.running.session
    scene, project = session.scene, session.project
    folders = sorted(session.projects_dir.iterdir())
    path = tmp_path / name
    path.write_bytes(content)
    editor.tab("Project")
    editor.upload("Open a file", path)
    refusal = editor.page.locator(".mantine-Notification-root", has_text="Could not do that")
    refusal.wait_for(timeout=JOB_MS)
    shown = refusal.inner_text()
    assert words in shown
    assert len(shown) < 200, "one line"
    assert "/" not in shown, "no places of this machine"
    editor.until(lambda: session.jobs.status is None)
    assert session.scene is scene
    assert session.project is project
    assert sorted(session.projects_dir.iterdir()) == folders
    editor.dismiss_notices()


def test_a_picture_of_this_view_and_of_the_photos(editor: EditorPage, tmp_path: Path) -> None:
    camera = editor.page.get_by_title("Draw a picture or a film of the scene to download (I)")
    camera.click()
    editor.button("640").click()
    here = Image.open(download(editor, "Make picture", tmp_path / "here.png")).convert("RGB")
    assert here.width == 640
    assert here.height == pytest.approx(640 / editor.client.view.camera.aspect, abs=1)
    editor.running.session.jobs.wait(10.0)
    table = editor.running.session.scene.object("table_1").pose.position + np.array([0.3, 0.0, 0.36])
    left, top, width, _ = editor.canvas_box()
    x, y = ((np.array(editor.place_of(table)) - (left, top)) * 640 / width).astype(int)
    r, g, b = np.asarray(here, dtype=int)[y, x]
    assert r > g > b, "the table's wood, where it is seen on the page"
    assert r - b > 25

    camera.click()
    editor.button("Photo's camera").click()
    editor.button("640").click()
    photo = Image.open(download(editor, "Make picture", tmp_path / "photo.png"))
    assert photo.size == (640, 480)
    editor.running.session.jobs.wait(10.0)


def test_a_film_can_be_cancelled_and_leaves_nothing(editor: EditorPage) -> None:
    session = editor.running.session
    downloads: list[Download] = []
    editor.page.on("download", lambda one: downloads.append(one))
    editor.page.get_by_title("Draw a picture").click()
    editor.button("Turntable").click()
    expect(editor.page.get_by_text("Four seconds of 1280 × 960 pixels")).to_be_visible()
    editor.button("480").click()
    editor.button("Make picture").click()
    editor.until(lambda: session.jobs.status is not None and "frame" in session.jobs.status.message, "it is filming")
    editor.button("Cancel").click()
    editor.until(lambda: session.jobs.status is None, "stopped")
    editor.notice("nothing was changed")
    assert downloads == []


def test_a_file_of_another_program_becomes_objects_that_are_drawn(editor: EditorPage, tmp_path: Path) -> None:
    shapes = len(editor.session.library.shapes())
    foreign = trimesh.Scene()
    floor, chair = trimesh.creation.box((4.0, 0.02, 4.0)), trimesh.creation.box((0.5, 0.9, 0.5))
    foreign.add_geometry(floor, node_name="floor", transform=trimesh.transformations.translation_matrix((0, -0.01, 0)))
    foreign.add_geometry(chair, node_name="chair", transform=trimesh.transformations.translation_matrix((1, 0.45, 0)))
    path = tmp_path / "their flat.glb"
    path.write_bytes(foreign.export(file_type="glb"))
    editor.tab("Project")
    editor.upload("Open a file", path)
    editor.until(
        lambda: (
            editor.session.project is not None
            and editor.session.project.name == "their flat"
            and bool(editor.session.scene.objects)
        ),
        "opened",
        LEARN_MS / 1000,
    )
    session = editor.session
    (item,) = session.scene.objects
    assert item.category == "chair"
    np.testing.assert_allclose(item.corners_world.min(axis=0), (0.75, -0.25, 0.0), atol=1e-3)
    np.testing.assert_allclose(item.corners_world.max(axis=0), (1.25, 0.25, 0.9), atol=1e-3)
    assert session.scene.architecture.floor is not None
    assert len(session.library.shapes()) == shapes + 1
    editor.settle()
    shown = editor.page.evaluate("Object.keys(window.__viserMutable.nodeRefFromName)")
    assert any(n.startswith(f"{session.viewport.node_name(item.id)}/") for n in shown), "it is drawn"


def test_the_page_of_one_file_opens_without_a_server(example: EditorPage, context, tmp_path: Path) -> None:
    choose(example, "html")
    path = download(example, "Export .html", tmp_path / "room.html")
    viewer = context.new_page()
    viewer.set_viewport_size({"width": 550, "height": 320})  # software draws its many pixels slowly
    errors: list[str] = []
    viewer.on("pageerror", lambda error: errors.append(str(error)))
    try:
        viewer.goto(path.as_uri() + QUERY)
        viewer.locator("canvas").first.wait_for(timeout=PATIENCE_MS)
        for _ in range(20):
            viewer.wait_for_timeout(1000)
            shot = np.asarray(Image.open(io.BytesIO(viewer.screenshot(timeout=PATIENCE_MS))).convert("RGB"))
            if colours(shot) > 15:
                break
        keep_picture(EditorPage(viewer, example.running), "exported_viewer")
    finally:
        viewer.close()
    assert not errors, errors
    assert colours(shot) > 15, "a furnished room has many colours"


def colours(picture: np.ndarray) -> float:
    """How far the colours of a picture are apart."""
    return float(picture.reshape(-1, 3).std(axis=0).min())


@pytest.mark.skipif(find_spec("DracoPy") is None, reason="needs the extra 'draco'")
def test_every_switch_of_a_model_is_in_its_file(example: EditorPage, plain_path: Path, tmp_path: Path) -> None:
    plain = GlbFile.read(plain_path)
    assert plain.roles == {"floor", "wall", "ceiling"}
    assert "extensionsRequired" not in plain.document
    assert not plain.has_photo
    assert max(plain.picture_sizes) > 256

    turn_on(example, "Without ceiling")
    example.page.get_by_label("Textures").select_option("256")
    example.page.get_by_label("Compression").select_option("meshopt")
    small = glb_of(example, tmp_path / "small.glb")
    assert small.roles == {"floor", "wall"}
    assert max(small.picture_sizes) == 256
    assert "EXT_meshopt_compression" in small.document["extensionsRequired"]

    turn_off(example, "Without ceiling")
    example.page.get_by_label("Compression").select_option("draco")
    turn_on(example, "With photo")
    packed = glb_of(example, tmp_path / "packed.glb")
    assert packed.roles == plain.roles
    assert "KHR_draco_mesh_compression" in packed.document["extensionsRequired"]
    assert packed.has_photo
    assert max(small.size, packed.size) < plain.size
    example.running.session.jobs.wait(10.0)


def test_an_exported_glb_is_opened_again_with_the_same_scene(example: EditorPage, plain_path: Path) -> None:
    session = example.running.session
    before, folder = session.scene, session.project.folder if session.project else None
    example.tab("Project")
    example.until(lambda: session.jobs.status is None)
    expect(example.button("Open a file")).to_be_enabled()
    example.upload("Open a file", plain_path)
    example.until(
        lambda: example.session.project is not None and example.session.project.folder != folder,
        "a project of its own",
        JOB_MS / 1000,
    )
    opened = example.session
    example.until(lambda: bool(opened.scene.objects), "its scene is read")
    assert opened.project is not None
    assert opened.project.name == "my room"
    assert opened.scene.objects == before.objects
    assert opened.scene.supports == before.supports
    assert scene_to_json(opened.scene) == scene_to_json(before)
    assert Project.open(opened.project.folder).load_scene() == opened.scene
    example.settle()
    drawn = example.page.evaluate("Object.keys(window.__viserMutable.nodeRefFromName)")
    for item in opened.scene.objects:
        assert any(n.startswith(f"{opened.viewport.node_name(item.id)}/") for n in drawn), f"{item.id} is drawn"
    expect(example.page.get_by_text("Opened from my room.glb.")).to_be_visible()
