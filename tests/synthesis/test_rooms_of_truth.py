"""Rooms and pictures with a known truth: valid, repeatable, and telling the same story in every buffer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.room_frame import WallLine
from diorama_core.errors import LibraryError
from diorama_core.layout.exact import mesh_overlap_m3
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Plane
from diorama_core.synthesis import ROOM_KINDS, furnish_room, render_truth, sample_cameras
from diorama_core.synthesis.artefacts import photo_only, true_geometry, true_objects, true_supports
from diorama_core.synthesis.finishes import FLOORS, WALLS, finish_picture
from diorama_core.synthesis.furnisher import WALL_GAP_M, Furnisher
from diorama_core.synthesis.plan import footprint, quads_overlap, room_plan
from diorama_core.synthesis.splits import split_library, split_of
from diorama_core.synthesis.truth import Studio

SIZE = (160, 120)


@pytest.fixture(scope="module")
def library():
    return built_in_library()


@pytest.fixture(scope="module")
def rooms(library):
    return {kind: furnish_room(1, kind, library) for kind in ROOM_KINDS}


@pytest.fixture(scope="module")
def view(rooms, library):
    camera = sample_cameras(rooms["living"], library, 1, 1, SIZE)[0]
    return render_truth(rooms["living"], camera, library, SIZE)


@pytest.mark.parametrize("kind", ROOM_KINDS)
def test_every_kind_of_room_is_furnished_and_free_of_collisions(rooms, library, kind):
    scene = rooms[kind]
    assert 8 <= len(scene.objects) <= 70
    assert mesh_overlap_m3(scene, library, skip_supporters=False) < 2e-4
    assert {o.id for o in scene.objects} == {s.child for s in scene.supports}
    floor = scene.architecture.floor
    low, high = floor.polygon.min(axis=0)[:2], floor.polygon.max(axis=0)[:2]
    for item in scene.objects:
        corners = item.corners_world
        assert (corners[:, :2] > low - 0.01).all()
        assert (corners[:, :2] < high + 0.01).all()
        assert corners[:, 2].min() > -1e-6


def test_supports_touch_what_they_name(rooms, library):
    scene = rooms["living"]
    for edge in scene.supports:
        item = scene.object(edge.child)
        low = item.corners_world[:, 2].min()
        if edge.parent == "floor":
            assert abs(low) < 1e-6
        elif scene.has_object(edge.parent) and edge.parent_surface is not None:
            parent = scene.object(edge.parent)
            face = library.shape(parent.shape_id).surfaces[edge.parent_surface]
            height = parent.pose.position[2] + face.height_m * parent.pose.scale[2]
            assert abs(low - height) < 0.03


def test_chairs_face_their_table(library):
    scene = furnish_room(0, "dining", library)
    table = next(o for o in scene.objects if o.category == "table")
    chairs = [o for o in scene.objects if o.category == "chair"]
    assert len(chairs) >= 2
    for chair in chairs:
        inward = chair.pose.R_world_object[:2, 0]
        # In the table's frame a chair points to the middle of the side it stands at.
        offset = (table.pose.position - chair.pose.position)[:2]
        assert inward @ offset > 0


def test_the_same_seed_gives_the_same_room_and_picture(rooms, view, library):
    again = furnish_room(1, "living", library)
    assert [(o.id, o.shape_id) for o in again.objects] == [(o.id, o.shape_id) for o in rooms["living"].objects]
    assert all(np.array_equal(a.pose.matrix, b.pose.matrix) for a, b in zip(again.objects, rooms["living"].objects))
    camera = sample_cameras(again, library, 1, 1, SIZE)[0]
    second = render_truth(again, camera, library, SIZE, with_empty_room=False)
    assert second.inputs.photo.rgb.tobytes() == view.inputs.photo.rgb.tobytes()
    other = furnish_room(2, "living", library)
    assert [o.shape_id for o in other.objects] != [o.shape_id for o in again.objects]


def test_buffers_agree_with_one_another(view):
    depth, planes = view.inputs.depth_m, view.plane_ids
    on_room = planes >= 0
    assert (on_room == (view.object_ids < 0)).all()
    assert np.array_equal(planes[on_room], view.room_plane_ids[on_room])
    assert np.allclose(depth[on_room], view.room_depth_m[on_room], atol=1e-4)
    assert (depth <= view.room_depth_m + 1e-3).all()
    assert (view.inputs.instances > 0).sum() <= (view.object_ids >= 0).sum()
    assert view.empty_room.shape == view.inputs.photo.rgb.shape


def test_normals_are_those_of_the_planes_in_the_photos_world(view):
    for index, plane in enumerate(view.scene.architecture.planes):
        seen = view.normals_world[view.plane_ids == index]
        assert np.allclose(seen, plane.normal, atol=1e-4)
    assert len(np.unique(view.plane_ids)) >= 4


def test_a_studio_gives_every_view_as_if_it_were_alone(rooms, view, library):
    cameras = sample_cameras(rooms["living"], library, 1, 2, SIZE)
    studio = Studio(rooms["living"], library)
    studio.view(cameras[1], SIZE, with_empty_room=False)
    again = studio.view(sample_cameras(rooms["living"], library, 1, 1, SIZE)[0], SIZE)
    assert again == view


def test_nothing_hides_what_stands_alone(view, library):
    index = max(view.indices, key=lambda k: view.visible_fraction[k])
    alone = replace(view.scene, objects=(view.scene.objects[index],), supports=())
    seen = render_truth(alone, view.camera, library, SIZE, with_empty_room=False)
    assert 0.9 < seen.visible_fraction[0] <= 1
    assert (seen.object_ids == 0).sum() >= (view.object_ids == index).sum()


def test_depth_and_scene_are_in_the_photos_world(view):
    camera, k = view.camera, view.camera.intrinsics
    assert np.allclose(camera.position[:2], 0, atol=1e-9)
    assert 1.2 < camera.position[2] < 1.8
    forward = camera.T_world_camera[:3, 2]
    assert forward[1] >= abs(forward[0]) - 1e-9
    rows, columns = np.nonzero(view.plane_ids >= 0)
    for row, column in zip(rows[::997], columns[::997]):
        point = camera.position + camera.rays(np.array([column + 0.5, row + 0.5])) * view.inputs.depth_m[row, column]
        plane = view.scene.architecture.planes[view.plane_ids[row, column]]
        assert abs(point @ plane.normal - plane.offset) < 2e-3
    assert (k.width, k.height) == SIZE


def test_masks_boxes_and_shares_belong_together(view):
    assert len(view.indices) >= 4
    for index, found in zip(view.indices, true_objects(view)):
        item = view.scene.objects[index]
        assert (view.inputs.instances[found.mask] == item.mask_id).all()
        x0, y0, x1, y1 = item.box_px
        ax0, ay0, ax1, ay1 = view.amodal_boxes[index]
        assert ax0 <= x0 + 1.5
        assert ay0 <= y0 + 1.5
        assert ax1 >= x1 - 1.5
        assert ay1 >= y1 - 1.5
        assert 0.1 < view.visible_fraction[index] <= 1
    assert photo_only(view).depth_m is None
    assert {c.object_id for c in true_geometry(view).cuboids} == {o.id for o in true_objects(view)}
    retained = {o.id for o in true_objects(view)} | {p.id for p in view.scene.architecture.planes}
    assert all(s.parent in retained for s in true_supports(view))


def test_outlines_hold_what_is_inside_only(rng):
    plan = room_plan(rng, (4.0, 4.0), (4.0, 4.0), "L-shape")
    assert len(plan.walls) == 6
    assert plan.area_m2 < 16
    missing = next(
        corner for corner in np.array([[-1.9, -1.9], [1.9, -1.9], [1.9, 1.9], [-1.9, 1.9]])
        if not plan.contains(footprint(np.array([0.1, 0.1, 1.0]), corner, 0.0))
    )  # fmt: skip
    assert plan.contains(footprint(np.array([0.1, 0.1, 1.0]), -missing, 0.3))
    assert not plan.contains(footprint(np.array([3.9, 3.9, 1.0]), np.zeros(2), 0.0))
    for wall, plane in zip(plan.walls, plan.architecture().by_role("wall")):
        assert np.allclose(plane.normal[:2], wall.inward)


def test_quads_overlap_only_when_they_share_ground():
    a = footprint(np.ones(3), np.zeros(2), 0.4)
    assert quads_overlap(a, footprint(np.ones(3), np.array([0.9, 0.0]), -0.2))
    assert not quads_overlap(a, footprint(np.ones(3), np.array([1.5, 0.0]), 0.0))
    assert not quads_overlap(footprint(np.ones(3), np.zeros(2), 0.0), footprint(np.ones(3), np.array([1.0, 0.0]), 0.0))


@pytest.mark.parametrize("style", [*(f"floor:{s}" for s in FLOORS), *(f"wall:{s}" for s in WALLS)])
def test_every_finish_has_texture_and_is_repeatable(style):
    role, name = style.split(":")
    table = FLOORS if role == "floor" else WALLS
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    upright = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1.0]])
    plane = Plane("p", role, square if role == "floor" else upright, texture=f"{role}:{name}:{table[name][0]}:3")
    picture = finish_picture(plane)
    assert picture.std() > 0.5
    assert np.array_equal(picture, finish_picture(plane))


def test_splits_share_nothing_and_cover_everything(library):
    parts = [split_library(library, s) for s in ("train", "validation", "test")]
    assert sum(len(p.shapes()) for p in parts) == len(library.shapes())
    assert not (parts[0].ids & parts[2].ids)
    assert {s.category for s in parts[0].shapes()} == {s.category for s in library.shapes()}
    assert 0.2 < len(parts[2].ids) / len(library.shapes()) < 0.4
    assert split_of(library) == split_of(library)
    with pytest.raises(LibraryError):
        parts[0].mesh(next(iter(parts[2].ids)))


def test_a_wall_hardly_longer_than_a_piece_takes_none(library):
    furnisher = Furnisher(room_plan(np.random.default_rng(0), (4, 5), (4, 5)), library, np.random.default_rng(0))
    item = furnisher.pick("bookshelf")
    for spare_m in (0.021, 0.0239, 0.0241):
        wall = WallLine("short", np.zeros(2), np.array([item.size_m[1] + spare_m, 0.0]))
        assert furnisher.against_wall(item, walls=(wall,)) is None or spare_m > 2 * WALL_GAP_M
