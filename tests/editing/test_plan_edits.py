"""Walls are split and rooms drawn: the room stays closed, and what is fastened goes with its wall."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.editing.plan_edits import (
    corners,
    draw_room,
    empty_room,
    move_corner,
    set_wall_length,
    split_wall,
    wall_feet,
)
from diorama_core.errors import EditRefused
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.room_edits import ceiling_height, move_plane, set_surface_finish
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Architecture, Pose, Scene, SceneObject, Support

ROOM = empty_room(4.0, 3.0, 2.5)


def lengths(scene: Scene) -> dict[str, float]:
    return {f.id: round(f.length_m, 6) for f in wall_feet(scene)}


def test_four_walls_meet_in_four_corners_and_look_outward() -> None:
    assert sorted(lengths(ROOM).values()) == [3.0, 3.0, 4.0, 4.0]
    assert len(corners(ROOM)) == 4
    middle = ROOM.plane("floor").centre[:2]
    for foot in wall_feet(ROOM):
        assert float(((foot.start + foot.end) / 2 - middle) @ foot.outward) > 0


def test_a_corner_goes_where_it_is_dragged_and_the_room_stays_closed() -> None:
    corner = corners(ROOM)[0]
    moved = move_corner(ROOM, corner.first, corner.second, np.array([0.3, -0.2]))
    new = next(c for c in corners(moved) if (c.first, c.second) == (corner.first, corner.second))
    np.testing.assert_allclose(new.at, corner.at + np.array([0.3, -0.2]), atol=1e-9)
    assert len(corners(moved)) == 4
    assert any(np.allclose(p[:2], new.at, atol=1e-9) for p in moved.plane("floor").polygon)


@pytest.mark.parametrize("number", range(4))
def test_every_wall_takes_a_typed_length(number: int) -> None:
    wall = wall_feet(ROOM)[number].id
    changed = set_wall_length(ROOM, wall, 5.25)
    assert lengths(changed)[wall] == pytest.approx(5.25)
    assert len(corners(changed)) == 4


def test_a_wall_at_one_end_is_enough_and_none_is_refused() -> None:
    corner = corners(ROOM)[0]
    two = Scene(architecture=Architecture((ROOM.plane("floor"), ROOM.plane(corner.first), ROOM.plane(corner.second))))
    for wall in (corner.first, corner.second):
        assert lengths(set_wall_length(two, wall, 2.2))[wall] == pytest.approx(2.2)
    one = Scene(architecture=Architecture((ROOM.plane("floor"), ROOM.plane(corner.first))))
    with pytest.raises(EditRefused, match="no other wall"):
        set_wall_length(one, corner.first, 2.0)


@pytest.mark.parametrize("length", [0.0, -1.0, 51.0, float("nan")])
def test_what_is_no_length_of_a_wall_is_refused(length: float) -> None:
    with pytest.raises(EditRefused, match="cannot be"):
        set_wall_length(ROOM, "wall_1", length)


def test_walls_that_do_not_meet_have_no_corner() -> None:
    opposite = next(
        (a.id, b.id) for a in wall_feet(ROOM) for b in wall_feet(ROOM) if float(a.outward @ b.outward) < -0.9
    )
    with pytest.raises(EditRefused, match="do not meet"):
        move_corner(ROOM, *opposite, np.array([0.1, 0.1]))


def test_the_room_has_its_lengths_and_everything_faces_inward() -> None:
    scene = empty_room(4.0, 5.0, 2.6)
    middle = np.array([0.0, 0.0, 1.3])
    assert [p.role for p in scene.architecture.planes] == ["floor", *["wall"] * 4, "ceiling"]
    for plane in scene.architecture.planes:
        assert plane.normal @ middle > plane.offset, plane.id
    np.testing.assert_allclose(plane_rectangle(scene.plane("floor"))[2], (4.0, 5.0))
    assert ceiling_height(scene) == pytest.approx(2.6)
    assert scene.plane("wall_1").centre[1] == pytest.approx(2.5)
    assert [round(float(plane_rectangle(w)[2][0]), 6) for w in scene.architecture.by_role("wall")] == [4, 5, 4, 5]


def test_walls_move_with_their_neighbours_and_finishes_come_off() -> None:
    scene = move_plane(empty_room(4.0, 5.0, 2.6), "wall_2", 1.0)
    np.testing.assert_allclose(plane_rectangle(scene.plane("floor"))[2], (5.0, 5.0))
    bare = set_surface_finish(scene, ("floor", "wall_1"), None)
    assert bare.plane("floor").texture is None
    assert bare.plane("floor").finish is None


@pytest.mark.parametrize("lengths", [(0.2, 5, 2.5), (4, 300, 2.5), (4, 5, 0.5), (float("nan"), 5, 2.5)])
def test_lengths_of_no_room_are_refused(lengths) -> None:
    with pytest.raises(EditRefused, match="a room cannot have"):
        empty_room(*lengths)


LETTER_L = np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 2.0], [2.0, 2.0], [2.0, 4.0], [0.0, 4.0]])


def with_picture(scene: Scene, x: float) -> Scene:
    """A picture on the far wall, and a shelf that stands against it."""
    wall = scene.plane("wall_1")
    y = float(wall.centre[1])
    picture = SceneObject(
        "picture_1", "picture", "picture", "p", (0.02, 0.6, 0.4), Pose.upright((x, y - 0.01, 1.5), 0.0)
    )
    shelf = SceneObject("shelf_1", "shelf", "bookshelf", "s", (0.3, 0.6, 1.0), Pose.upright((x, y - 0.15, 0.5), 0.0))
    supports = (Support("picture_1", "wall_1", "mounted on"), Support("shelf_1", "floor", adheres_to=("wall_1",)))
    return replace(scene, objects=(picture, shelf), supports=supports)


def closed(scene: Scene) -> None:
    """Walls stand on the floor's rim one after another, the ceiling lies over the floor, and all look inward."""
    floor, ceiling = scene.plane("floor").polygon, scene.plane("ceiling").polygon
    ring = shapely.Polygon(floor[:, :2])
    assert ring.is_valid
    np.testing.assert_allclose(shapely.Polygon(ceiling[:, :2]).symmetric_difference(ring).area, 0.0, atol=1e-9)
    feet = wall_feet(scene)
    along = shapely.union_all([shapely.LineString([f.start, f.end]) for f in feet])
    assert along.length == pytest.approx(ring.exterior.length)
    assert along.hausdorff_distance(ring.exterior) < 1e-6
    for foot in feet:
        middle = (foot.start + foot.end) / 2
        assert ring.contains(shapely.Point(middle - 0.01 * foot.outward)), foot.id
    check_scene(scene)


def test_a_split_wall_is_two_in_one_plane_and_what_it_holds_goes_with_its_part() -> None:
    for x, holder in ((-1.0, "wall_1"), (1.0, "wall_5")):
        scene = split_wall(with_picture(ROOM, x), "wall_1", np.array([0.4, 0.0]))
        closed(scene)
        lengths = sorted(round(f.length_m, 6) for f in wall_feet(scene) if f.id in ("wall_1", "wall_5"))
        assert lengths == [1.6, 2.4]
        assert scene.support_of("picture_1").parent == holder
        assert scene.support_of("shelf_1").adheres_to == (holder,)


@given(st.floats(-1.7, 1.7), st.floats(-1.5, 2.0).filter(lambda d: abs(d) > 0.05), st.sampled_from([1, 5]))
def test_a_part_that_moves_leaves_a_step_with_a_wall(at: float, distance: float, number: int) -> None:
    scene = split_wall(ROOM, "wall_1", np.array([at, 0.0]))
    before = shapely.Polygon(scene.plane("floor").polygon[:, :2]).area
    part = next(f for f in wall_feet(scene) if f.id == f"wall_{number}")
    moved = move_plane(scene, part.id, distance)
    closed(moved)
    assert len(moved.architecture.by_role("wall")) == 6
    assert shapely.Polygon(moved.plane("floor").polygon[:, :2]).area == pytest.approx(before + distance * part.length_m)


def test_steps_move_like_other_walls() -> None:
    scene = move_plane(split_wall(ROOM, "wall_1", np.zeros(2)), "wall_1", 1.0)
    closed(move_plane(scene, "wall_6", 0.3))
    closed(move_plane(scene, "wall_5", 0.4))


@pytest.mark.parametrize(("wall", "x"), [("floor", 0.0), ("wall_9", 0.0), ("wall_1", 1.95), ("wall_1", -7.0)])
def test_what_cannot_be_split_is_refused(wall: str, x: float) -> None:
    with pytest.raises(EditRefused, match=r"split"):
        split_wall(ROOM, wall, np.array([x, 0.0]))


@pytest.mark.parametrize("turn", [1, -1])
def test_a_drawn_room_has_its_corners_and_the_height_of_the_one_before(turn: int) -> None:
    scene = draw_room(with_picture(empty_room(4.0, 3.0, 2.7), 0.5), LETTER_L[::turn])
    closed(scene)
    assert len(scene.architecture.by_role("wall")) == 6
    assert shapely.Polygon(scene.plane("floor").polygon[:, :2]).area == pytest.approx(14.0)
    assert float(scene.plane("ceiling").polygon[:, 2].max()) == pytest.approx(2.7)
    nearest = min(
        wall_feet(scene), key=lambda f: shapely.LineString([f.start, f.end]).distance(shapely.Point(0.5, 1.5))
    )
    assert scene.support_of("picture_1").parent == nearest.id
    assert scene.support_of("shelf_1").parent == "floor"


@pytest.mark.parametrize(
    ("outline", "words"),
    [
        ([[0.0, 0.0], [3.0, 0.0]], "three corners"),
        ([[0.0, 0.0], [3.0, 3.0], [3.0, 0.0], [0.0, 3.0]], "cross"),
        ([[0.0, 0.0], [3.0, 0.0], [3.0, 0.1]], "long"),
        ([[0.0, 0.0], [0.5, 0.0], [0.5, 0.5]], "square metre"),
        ([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0]], "long"),
    ],
)
def test_what_is_no_room_is_refused(outline: list[list[float]], words: str) -> None:
    with pytest.raises(EditRefused, match=words):
        draw_room(ROOM, np.array(outline))
