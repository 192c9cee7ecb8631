from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from diorama_core.arrangement.surfaces import (
    RestingSurface,
    choose_contact,
    choose_surface,
    complete_edges,
    convex_outline,
    is_soft,
    is_wall_like,
    is_wide_enough,
    misfit,
    object_surfaces,
    overhang_m,
    plane_surface,
    wall_faces,
)
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.library.record import Shape, SupportSurface
from diorama_core.scene.types import Architecture, Plane, Pose, Scene, SceneObject, Support, yaw_rotation
from tests.layout.small_rooms import Room, tilted

SQUARE = np.array([[-1.0, -0.5, 0.2], [1.0, -0.5, 0.2], [1.0, 0.5, 0.2], [-1.0, 0.5, 0.2]])
UP = np.array([0.0, 0.0, 1.0])
TOP = RestingSurface.of(SQUARE, UP, 0.3, of_plane=False)

coordinate = st.floats(-3, 3)
vector = st.tuples(coordinate, coordinate, coordinate).map(np.array)
scales = st.tuples(*[st.floats(0.3, 3.0)] * 3).map(np.array)


@given(turn=vector, p=vector, scale=scales, point=vector)
def test_a_surface_at_a_pose_holds_the_posed_points(turn, p, scale, point) -> None:
    pose = Pose(rotation_from_vector(turn), p, scale)
    world = TOP.to_world(pose)
    np.testing.assert_allclose(world.polygon, pose.apply(SQUARE), atol=1e-9)
    np.testing.assert_allclose(world.polygon @ world.normal, world.level, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(world.outward, axis=1), 1.0)
    assert world.clearance_m == pytest.approx(0.3 * scale[2])
    inside_before = (TOP.outward @ point <= TOP.offset + 1e-9).all()
    margin = (world.outward @ pose.apply(point) - world.offset).max()
    assert margin <= 1e-7 if inside_before else margin > -1e-7


def test_planes_stay_where_they_are() -> None:
    floor = RestingSurface.of(SQUARE, UP, np.inf, of_plane=True)
    assert floor.to_world(Pose.upright((1, 2, 3))) is floor
    assert TOP.to_world(None) is TOP


@given(points=st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=12, unique=True), normal=vector)
def test_convex_outlines_are_hulls_about_their_normal(points, normal) -> None:
    points = np.array(points)
    if np.linalg.norm(normal) < 0.1 or np.linalg.matrix_rank(points[1:] - points[0], tol=0.05) < 2:
        return
    normal = normal / np.linalg.norm(normal)
    u, v = plane_axes(normal)
    polygon = points[:, :1] * u + points[:, 1:] * v + 0.7 * normal
    found = convex_outline(polygon, normal)
    flat = np.column_stack([found @ u, found @ v])
    ring = np.roll(flat, -1, axis=0)
    area = 0.5 * float((flat[:, 0] * ring[:, 1] - flat[:, 1] * ring[:, 0]).sum())
    assert area == pytest.approx(ConvexHull(points).volume, rel=1e-6)
    np.testing.assert_allclose(found @ normal, 0.7, atol=1e-9)


def test_rounding_along_a_side_takes_no_corner_away() -> None:
    left = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 2.0, 0.0], [-1e-16, 2.0, 0.0], [0.0, 1.0, 0.0]])
    found = convex_outline(left, UP)
    assert {tuple(np.abs(p).round(9)) for p in found} == {(0, 0, 0), (3, 0, 0), (3, 2, 0), (0, 2, 0)}


@given(point=vector)
def test_outside_is_zero_within_and_grows_outward(point) -> None:
    beyond = max(abs(point[0]) - 1.0, abs(point[1]) - 0.5, 0.0)
    assert overhang_m(TOP, point) == pytest.approx(beyond)


def item_at(position, size=(0.2, 0.3, 0.4), **more) -> SceneObject:
    return SceneObject("item", "item", "vase", "vase", size, Pose.upright(position), **more)


def test_misfit_is_none_for_what_rests_and_counts_every_fault() -> None:
    low_shelf = RestingSurface.of(SQUARE, UP, 0.35, of_plane=False)
    open_top = RestingSurface.of(SQUARE, UP, np.inf, of_plane=False)
    rests = item_at((0, 0, 0.4))
    assert misfit(rests, open_top) == pytest.approx(0.0)
    assert misfit(item_at((0, 0, 0.5)), open_top) == pytest.approx(0.1)
    assert misfit(item_at((1.2, 0, 0.4)), open_top) == pytest.approx(0.2)
    # 5 cm higher than the clearance, but more than three quarters of its height are free.
    assert misfit(rests, low_shelf) == pytest.approx(0.025)
    assert misfit(rests, RestingSurface.of(SQUARE, UP, 0.2, of_plane=False)) == pytest.approx(1.1)
    assert misfit(item_at((0, 0, 1.7), (3.0, 3.0, 3.0)), open_top) == pytest.approx(0.5 * (2.0 + 1.0))


def test_an_object_without_surfaces_offers_the_top_of_its_box(room: Room) -> None:
    box = room.put("box_24", (0, 0, 0.15))
    item = room.scene().object(box)
    bare = replace(room.library.shape("box_24"), surfaces=())
    (top,) = object_surfaces(bare, item)
    assert top.level == pytest.approx(item.shape_size_m[2] / 2)
    assert np.ptp(top.polygon, axis=0)[:2] == pytest.approx(item.shape_size_m[:2])
    assert top.clearance_m == np.inf


def test_the_nearest_shelf_is_chosen_unless_the_edge_names_one(room: Room) -> None:
    names = [s.id for s in room.library.in_category("bookshelf")]
    shelf = room.put(names[0], (0, 0, 0.9))
    shape = room.library.shape(names[0])
    levels = [s.height_m for s in shape.surfaces]
    assert len(levels) >= 4
    for k, level in enumerate(levels):
        cup = room.put("cup_21", (0, 0, 0.9 + level + 0.06), on=shelf, id=f"cup_{k}")
        scene = room.scene()
        edge = Support(cup, shelf)
        assert choose_surface(scene, scene.object(cup), edge, shape).level == pytest.approx(level)
        named = replace(edge, parent_surface=1)
        assert choose_surface(scene, scene.object(cup), named, shape).level == pytest.approx(levels[1])
        beyond = replace(edge, parent_surface=99)
        assert choose_surface(scene, scene.object(cup), beyond, shape).level == pytest.approx(level)


def test_soft_objects_spread_over_all_places_of_one_height(room: Room) -> None:
    sofa = room.put("table_0", (0, 0, 0.37))
    halves = tuple(
        SupportSurface(np.array([[-0.3, a, 0.1], [0.3, a, 0.1], [0.3, b, 0.1], [-0.3, b, 0.1]]), np.inf, interior=False)
        for a, b in ((-0.6, -0.1), (0.0, 0.6))
    )
    shape = replace(room.library.shape("table_0"), surfaces=halves)
    scene = room.scene()
    pillow = SceneObject("pillow", "pillow", "pillow", "x", (0.4, 0.4, 0.1), Pose.upright((0, -0.3, 0.6)))
    assert is_soft(pillow)
    assert not is_soft(scene.object(sofa))
    chosen = choose_surface(scene, pillow, Support("pillow", sofa), shape)
    np.testing.assert_allclose(np.ptp(chosen.polygon, axis=0), [0.6, 1.2, 0.0], atol=1e-12)
    vase = replace(pillow, category="vase")
    assert np.ptp(choose_surface(scene, vase, Support("pillow", sofa), shape).polygon[:, 1]) < 0.7


def test_what_is_mounted_on_an_object_goes_to_its_nearest_side(room: Room) -> None:
    wardrobe = room.put("wardrobe_12", (0, 0, 1.0), yaw=np.pi / 2)
    shape, item = room.library.shape("wardrobe_12"), room.objects[0]
    clock = item_at((0, item.size_m[0] / 2 + 0.1, 1.2))
    surface = choose_surface(room.scene(), clock, Support("item", wardrobe, "mounted on"), shape)
    np.testing.assert_allclose(surface.normal, [1.0, 0.0, 0.0])
    np.testing.assert_allclose(surface.to_world(item.pose).normal, [0.0, 1.0, 0.0], atol=1e-12)


def contact(scene: Scene, item: SceneObject, edge: Support | None, surface: RestingSurface | None) -> list[float]:
    return choose_contact(scene, item, edge, surface).tolist()


def test_the_bottom_touches_unless_another_face_looks_down_much_more(room: Room) -> None:
    scene = room.scene()
    floor = plane_surface(scene.architecture.floor)
    item = item_at((0, 0, 0.2))
    edge = Support("item", "floor")
    leaning = replace(item, pose=tilted(item.pose, 50))
    fallen = replace(item, pose=tilted(item.pose, 80))
    assert contact(scene, item, edge, floor) == [0, 0, -1]
    assert contact(scene, leaning, edge, floor) == [0, 0, -1]
    lying = np.array(contact(scene, fallen, edge, floor))
    assert (fallen.pose.R_world_object @ lying)[2] < -0.9
    assert lying[2] == 0
    assert contact(scene, item, replace(edge, child_face="left"), floor) == [0, 1, 0]
    assert contact(scene, item, None, floor) == contact(scene, item, edge, None) == [0, 0, -1]


def test_wall_objects_touch_walls_with_their_back(room: Room) -> None:
    scene = room.scene()
    wall = scene.architecture.by_role("wall")[0]
    surface = plane_surface(wall)
    assert is_wall_like(surface)
    assert not is_wall_like(plane_surface(scene.architecture.floor))
    assert not is_wall_like(None)
    heading = float(np.arctan2(wall.normal[1], wall.normal[0]))
    edge = Support("item", wall.id, "mounted on")
    picture = replace(item_at((0, 0, 1.5)), category="picture", pose=Pose.upright((0, 0, 1.5), heading + np.pi))
    assert contact(scene, picture, edge, surface) == [-1, 0, 0]
    vase = replace(picture, category="vase")
    assert contact(scene, vase, edge, surface) == [1, 0, 0]


@given(yaw=st.floats(-3.1, 3.1), away=st.floats(0.0, 2.0), along=st.floats(-3.0, 3.0))
def test_wall_faces_measure_gap_and_alignment(yaw, away, along) -> None:
    wall = Plane("w", "wall", np.array([[-2, 0, 0], [-2, 0, 2.5], [2, 0, 2.5], [2, 0, 0]], dtype=float)[::-1])
    side = float(np.sign(wall.normal[1]))
    size = np.array([0.6, 0.6, 1.0])
    R = yaw_rotation(yaw)
    faces, gap, parallel = wall_faces(R[None], np.array([[along, side * (0.3 + away), 0.5]]), size[None], wall)
    toward = R.T @ -wall.normal
    if toward[0] < -0.71:
        assert faces[0].tolist() == [-1, 0, 0]
    assert parallel[0] == pytest.approx(float(faces[0] @ toward))
    assert np.count_nonzero(faces[0]) == 1
    centre = np.array([along, side * (0.3 + away), 0.5]) + R @ (faces[0] * 0.3)
    if abs(centre[0]) > 2.51:
        assert gap[0] == np.inf
    elif abs(centre[0]) < 2.49:
        assert gap[0] == pytest.approx(abs(centre[1]))


def test_a_supporter_holds_what_is_not_much_wider(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37))
    scene = room.scene()
    supporter, shape = scene.object(table), room.library.shape("table_0")
    spans = sorted(np.ptp(shape.surfaces[0].polygon, axis=0)[:2])
    fits = item_at((0, 0, 1), (spans[0] / 0.36, spans[1] / 0.36, 0.5))
    large = item_at((0, 0, 1), (spans[0] / 0.34, spans[1] / 0.36, 0.5))
    edge = Support("item", table)
    assert is_wide_enough(fits, edge, supporter, shape)
    assert not is_wide_enough(large, edge, supporter, shape)
    assert is_wide_enough(large, replace(edge, relation="mounted on"), supporter, shape)
    bigger = replace(supporter, pose=Pose.upright((0, 0, 1), 0.0, (1.2, 1.2, 1.0)))
    assert is_wide_enough(large, edge, bigger, shape)


def completed(room: Room, supports: tuple[Support, ...]) -> tuple[dict[str, Support | None], tuple[str, ...]]:
    scene = replace(room.scene(), supports=supports)
    objects = sorted(scene.objects, key=lambda o: o.id)
    shapes: list[Shape] = [room.library.shape(o.shape_id) for o in objects]
    edges, reasons = complete_edges(scene, objects, shapes)
    return {o.id: e for o, e in zip(objects, edges, strict=True)}, reasons


def test_good_edges_are_left_alone(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37))
    cup = room.put("cup_21", (0.2, 0.3, 0.79), on=table)
    stated = room.scene().supports
    edges, reasons = completed(room, stated)
    assert tuple(edges[i] for i in (table, cup)) == stated
    assert reasons == ()


def test_missing_edges_go_where_the_observed_pose_rests(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37))
    on_table = room.put("cup_21", (0.2, 0.3, 0.79))
    on_floor = room.put("cup_21", (2.0, 0.3, 0.05))
    edges, reasons = completed(room, (Support(on_table, "nowhere"),))
    assert edges[on_table].parent == table
    assert edges[on_floor].parent == edges[table].parent == "floor"
    assert len(reasons) == 3
    assert all("taken to rest on" in r for r in reasons)


def test_cycles_are_cut_and_named(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37))
    cup = room.put("cup_21", (0.2, 0.3, 0.79))
    edges, reasons = completed(room, (Support(table, cup), Support(cup, table)))
    assert {edges[table].parent, edges[cup].parent} == {"floor", table}
    assert reasons[0].startswith("cycle:")


def test_what_is_far_larger_than_its_support_is_set_elsewhere(room: Room) -> None:
    cup = room.put("cup_21", (0, 0, 0.05))
    wardrobe = room.put("wardrobe_12", (0, 1.0, 1.1))
    edges, reasons = completed(room, (Support(cup, "floor"), Support(wardrobe, cup)))
    assert edges[wardrobe].parent == "floor"
    assert reasons[0].startswith("larger than its support:")


def test_without_anything_to_rest_on_there_is_no_edge(room: Room) -> None:
    room.put("cup_21", (0, 0, 0.05), on=None)
    scene = replace(room.scene(), architecture=Architecture())
    edges, reasons = complete_edges(scene, scene.objects, [room.library.shape("cup_21")])
    assert edges == [None]
    assert "left at its height" in reasons[0]
