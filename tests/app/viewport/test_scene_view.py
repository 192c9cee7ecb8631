from __future__ import annotations

import asyncio
import io
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

from diorama_app.viewport.mesh_assets import ShapeBytes, plane_glb, reduce
from diorama_app.viewport.scene_view import BELOW_M, MARGIN_M, MESH_NAMES, Viewport, ground_glb
from diorama_core.editing.plan_edits import empty_room
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.io.glb import read_glb
from diorama_core.scene import edits
from diorama_core.scene.types import Pose
from tests.app.small_room import PlainLibrary, furnished_scene, room_planes


def test_the_ground_is_dark_below_the_room_and_fades_out_around_it() -> None:
    floor = empty_room(4.0, 2.0, 2.5).architecture.floor
    assert floor is not None
    mesh = trimesh.load(io.BytesIO(ground_glb(floor)), file_type="glb").to_geometry()
    low, high = mesh.bounds
    np.testing.assert_allclose(high - low, [4.0 + 2 * MARGIN_M, 2.0 + 2 * MARGIN_M, 0.0], atol=1e-5)
    assert low[2] == np.float32(-BELOW_M)
    alpha = np.asarray(mesh.visual.material.baseColorTexture)[..., 3]
    assert alpha[0].max() < 3
    assert alpha[alpha.shape[0] // 2, alpha.shape[1] // 2] > 90


SCENE = furnished_scene()


@pytest.fixture
def told() -> dict[str, list]:
    return {"pick": [], "drag": [], "later": []}


@pytest.fixture
def viewport(server, told):
    made = Viewport(
        server,
        ShapeBytes(PlainLibrary()),
        pick=lambda i, e: told["pick"].append((i, e)),
        drag=lambda i, e: told["drag"].append((i, e)),
        later=told["later"].append,
    )
    made.show(SCENE, {})
    yield made
    server.scene.reset()


def nodes(server) -> set[str]:
    return set(server.scene._handle_from_node_name)


def handle(server, name: str):
    return server.scene._handle_from_node_name[name]


def test_everything_is_drawn_in_its_pose(server, viewport) -> None:
    for item in SCENE.objects:
        frame = handle(server, viewport.node_name(item.id))
        np.testing.assert_allclose(frame.position, item.pose.position)
        np.testing.assert_allclose(frame.wxyz, quaternion_wxyz(item.pose.R_world_object))
        assert handle(server, viewport.mesh_name(item.id)).scale == pytest.approx(tuple(item.pose.scale))
    assert {viewport.plane_name(p.id) for p in SCENE.architecture.planes} <= nodes(server)
    assert viewport.node_name("nobody") is viewport.mesh_name("nobody") is viewport.plane_name("nobody") is None


def test_only_what_differs_is_sent(server, viewport, monkeypatch) -> None:
    monkeypatch.setattr(server.scene, "add_glb", lambda *given, **more: pytest.fail("drew a mesh again"))
    monkeypatch.setattr(server.scene, "add_mesh_simple", lambda *given, **more: pytest.fail("drew a plane again"))
    before = nodes(server)
    viewport.show(edits.rename(SCENE, "chair_1", "throne"), {})
    moved = edits.move(SCENE, "chair_1", SCENE.object("chair_1").pose.move((0.1, 0, 0)))
    viewport.show(moved, {})
    viewport.show(edits.set_hidden(moved, "chair_1", True), {})
    assert nodes(server) == before
    frame = handle(server, viewport.node_name("chair_1"))
    assert not frame.visible
    np.testing.assert_allclose(frame.position, moved.object("chair_1").pose.position)


def test_removed_objects_go_and_their_names_are_used_again(server, viewport) -> None:
    name = viewport.node_name("chair_1")
    without = edits.remove(SCENE, ["chair_1"])
    viewport.show(without, {})
    assert name not in nodes(server)
    assert viewport.node_name("chair_1") is None
    viewport.show(SCENE, {})
    assert viewport.node_name("chair_1") == name


def test_an_old_mesh_stays_until_the_new_one_is_there(server, viewport, told) -> None:
    old = viewport.mesh_name("chair_1")
    viewport.show(edits.recolour(SCENE, "chair_1", (1.0, 0.0, 0.0)), {})
    new = viewport.mesh_name("chair_1")
    assert {old, new} <= nodes(server)
    (task,) = told["later"]
    task()
    assert old not in nodes(server)
    assert new in nodes(server)
    names = {new}
    for k in range(2 * MESH_NAMES):
        viewport.show(edits.recolour(SCENE, "chair_1", (0.0, k / 40, 0.5)), {})
        names.add(viewport.mesh_name("chair_1"))
    assert len(names) == MESH_NAMES


def test_a_preview_is_taken_back_by_the_next_drawing(server, viewport) -> None:
    there = Pose.upright((1.0, 1.0, 1.0), 0.5, (2.0, 1.0, 1.0))
    viewport.preview({"chair_1": there, "nobody": there})
    frame = handle(server, viewport.node_name("chair_1"))
    np.testing.assert_allclose(frame.position, there.position)
    assert handle(server, viewport.mesh_name("chair_1")).scale == (2.0, 1.0, 1.0)
    viewport.show(SCENE, {})
    np.testing.assert_allclose(frame.position, SCENE.object("chair_1").pose.position)
    assert handle(server, viewport.mesh_name("chair_1")).scale == (1.0, 1.0, 1.0)


def test_a_preview_sends_what_can_be_seen_to_move(server, viewport) -> None:
    item = SCENE.object("chair_1")
    frame = handle(server, viewport.node_name(item.id))
    steps = [item.pose.move((0.00005 * step, 0.0, 0.0)) for step in range(1, 7)]
    sent = []
    for pose in steps:
        viewport.preview({item.id: pose})
        sent.append(float(frame.position[0] - item.pose.position[0]))
    np.testing.assert_allclose(sent, [0.0, 0.0, 0.0, 0.0, 0.00025, 0.00025], atol=1e-9)
    viewport.show(edits.place(SCENE, {item.id: steps[-1]}), {})
    np.testing.assert_allclose(frame.position, steps[-1].position, err_msg="the document's place is exact")


def test_another_shape_is_previewed(server, viewport) -> None:
    before = viewport.mesh_name("chair_1")
    viewport.preview_item(replace(SCENE.object("chair_1"), shape_id="chair_c"))
    assert viewport.mesh_name("chair_1") != before
    viewport.preview_item(replace(SCENE.object("chair_1"), id="nobody"))


def test_clicks_and_drags_name_their_object(server, viewport, told) -> None:
    mesh = handle(server, viewport.mesh_name("lamp_1"))
    clicked, dragged = SimpleNamespace(), SimpleNamespace()
    for entry in mesh._impl.click_cb:
        asyncio.run(getattr(entry, "callback", entry)(clicked))
    for entry in mesh._impl.drag_cb:
        asyncio.run(entry.callback(dragged))
    assert {i for i, _ in told["pick"]} == {i for i, _ in told["drag"]} == {"lamp_1"}
    assert len(told["pick"]) == 3, "plain, shift, and ctrl"
    assert len(told["drag"]) == 2, "plain and alt"


def test_planes_with_pictures_are_drawn_with_them(server, viewport) -> None:
    floor = SCENE.architecture.planes[0]
    textured = edits.set_planes(SCENE, [replace(floor, texture="floor.jpg")])
    picture = np.full((16, 16, 3), 200, np.uint8)
    before = handle(server, viewport.plane_name("floor"))
    viewport.show(textured, {"floor.jpg": picture})
    after = handle(server, viewport.plane_name("floor"))
    assert type(after) is not type(before)
    viewport.show(textured, {})
    assert handle(server, viewport.plane_name("floor")) is after, "the same plane is not drawn again"


def test_pictures_are_made_no_larger_than_asked() -> None:
    assert reduce(np.zeros((200, 400, 3), np.uint8), 100).shape == (50, 100, 3)
    assert reduce(np.zeros((20, 40, 3), np.uint8), 100).shape == (20, 40, 3)


def test_the_room_stands_on_its_ground_where_graphics_are_not_low(server, viewport) -> None:
    assert "/ground" in nodes(server)
    low = Viewport(server, ShapeBytes(PlainLibrary()), pick=lambda *_: None, drag=lambda *_: None, later=lambda _: None)
    server.scene.reset()
    low.light(low_graphics=True)
    low.show(SCENE, {})
    assert "/ground" not in nodes(server)


def test_a_plane_s_picture_travels_as_a_jpeg() -> None:
    picture = np.random.default_rng(0).integers(0, 255, (64, 64, 3), dtype=np.uint8)
    document, _ = read_glb(plane_glb(room_planes()[0], picture))
    assert [image["mimeType"] for image in document["images"]] == ["image/jpeg"]
