"""Rooms joined at a door: the two sides are one, names stay apart, and undo takes it back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.homes import as_one_door, draw_room_of_home, join
from diorama_core.errors import EditRefused
from diorama_core.geometry.rooms import doorways, rooms_of_objects, rooms_of_planes
from diorama_core.multiview.one_scene import move_to_room
from diorama_core.scene import edits
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Camera, Intrinsics, Pose, Scene, SceneObject, Support, rigid, yaw_rotation
from diorama_core.synthesis.cameras import level_pose
from tests.app.small_room import furnished_scene


def with_door(
    scene: Scene,
    name: str,
    wall_id: str,
    along_m: float,
    shape: tuple[str, tuple[float, float, float]] = ("door-flush-white", (0.06, 0.9, 2.0)),
) -> Scene:
    """A door of 0.9 x 2 m in a wall, so far from the middle of its foot to the right seen from inside."""
    wall = scene.plane(wall_id)
    right = np.cross([0.0, 0.0, 1.0], wall.normal)
    middle = (wall.polygon.min(axis=0) + wall.polygon.max(axis=0)) / 2 + along_m * right + 0.03 * wall.normal
    middle[2] = float(wall.polygon[:, 2].min()) + 1.0
    yaw = float(np.arctan2(wall.normal[1], wall.normal[0]))
    pose = Pose.upright(middle, yaw, tuple(np.divide((0.06, 0.9, 2.0), shape[1])))
    item = SceneObject(name, "door", "door", *shape, pose)
    return edits.insert(scene, item, Support(name, wall_id, "mounted on", child_face="back"))


@pytest.fixture
def home() -> Scene:
    return with_door(furnished_scene(), "door", "wall_3", 0.4)


@pytest.fixture
def turned() -> Scene:
    """A furnished room elsewhere, turned, with its door in another wall."""
    T = rigid(yaw_rotation(0.7), np.array([11.0, -3.0, 0.4]))
    return move_to_room(with_door(furnished_scene(), "way-in", "wall_2", -0.3), T)


def test_the_two_sides_of_the_door_are_one(home: Scene, turned: Scene) -> None:
    made = join(home, turned, "door", "way-in", names=("hall", "study"), wall_m=0.2).scene
    check_scene(made)
    assert scene_from_json(scene_to_json(made)) == made
    assert [(r.name, r.storey) for r in made.rooms] == [("hall", 0), ("study", 0)]
    (doorway,) = doorways(made)
    assert set(doorway.rooms) == {r.id for r in made.rooms}
    assert doorway.depth_m == pytest.approx(0.2)
    face, behind = (made.plane(w) for w in doorway.walls)
    np.testing.assert_allclose(face.normal, -behind.normal, atol=1e-9)
    assert face.thickness + behind.thickness == pytest.approx(0.2)
    floors = [made.plane(r.floor) for r in made.rooms]
    assert floors[0].centre[2] == pytest.approx(floors[1].centre[2])
    assert len(made.objects) == len(home.objects) + len(turned.objects) - 1
    along = np.cross([0.0, 0.0, 1.0], behind.normal)
    here = (made.object("door").pose.position - behind.centre) @ along
    assert here == pytest.approx(-0.3), "where the other room has it"


def photographed(scene: Scene, door: str, wall_id: str, aside_rad: float) -> Scene:
    """The room with a photo of a door from 2.5 m before it, the view turned aside, and the door's box in it."""
    wall, item = scene.plane(wall_id), scene.object(door)
    yaw = float(np.arctan2(-wall.normal[1], -wall.normal[0])) + aside_rad
    eye = item.pose.position * (1, 1, 0) + 2.5 * wall.normal + (0, 0, 1.5)
    camera = Camera(Intrinsics(640, 480, 320.0, 320.0, 320.0, 240.0), level_pose(eye, yaw, 0.3))
    corners = item.corners_world
    on_wall = corners - np.outer(corners @ wall.normal - wall.offset, wall.normal)
    px = camera.project(on_wall).clip(0, (640, 480))
    box = (float(px[:, 0].min()), float(px[:, 1].min()), float(px[:, 0].max()), float(px[:, 1].max()))
    return replace(
        scene, camera=camera, objects=tuple(replace(o, box_px=box if o is item else None) for o in scene.objects)
    )


@pytest.mark.parametrize("aside_rad", [0.9, -0.9])
def test_a_door_that_one_photo_cuts_off_is_as_the_other_shows_it(home: Scene, aside_rad: float) -> None:
    cut = photographed(home, "door", "wall_3", aside_rad)
    whole = photographed(with_door(furnished_scene(), "way-in", "wall_2", -0.3), "way-in", "wall_2", 0.0)
    true, box = cut.object("door"), cut.object("door").box_px
    assert box is not None
    assert (box[0] == 0.0) != (box[2] == 640.0)
    badly = replace(true, pose=replace(true.pose.move((0.1, 0.1, 0.0)), scale=(1.0, 0.6, 1.0)))
    built = replace(cut, objects=tuple(badly if o is true else o for o in cut.objects))
    first, second = as_one_door(built, whole, "door", "way-in")
    assert first.object("door").size_m[1] == pytest.approx(0.9, abs=0.01)
    along = np.cross([0.0, 0.0, 1.0], home.plane("wall_3").normal)
    assert (first.object("door").pose.position - true.pose.position) @ along == pytest.approx(0.0, abs=0.01)
    np.testing.assert_allclose(second.object("way-in").pose.position, whole.object("way-in").pose.position, atol=0.01)
    placed = replace(built, objects=tuple(replace(o, by_hand=True) for o in built.objects))
    assert as_one_door(placed, whole, "door", "way-in")[0] is placed, "somebody knows better"


def test_names_are_apart_and_everything_keeps_its_room(home: Scene, turned: Scene) -> None:
    made = join(home, turned, "door", "way-in").scene
    assert [r.name for r in made.rooms] == ["room", "room 2"]
    ids = [v.id for v in (*made.objects, *made.architecture.planes, *made.rooms)]
    assert len(ids) == len(set(ids))
    in_rooms = {**rooms_of_objects(made), **rooms_of_planes(made)}
    first = {o.id for o in home.objects} | {p.id for p in home.architecture.planes}
    assert {name for name, room in in_rooms.items() if room == made.rooms[0].id} == first
    for edge in made.supports[-3:]:
        assert made.has_object(edge.parent) or made.has_plane(edge.parent)


def test_a_third_room_joins_at_another_door(home: Scene, turned: Scene) -> None:
    two = join(with_door(home, "second", "wall_1", 0.0), turned, "door", "way-in").scene
    three = join(two, turned, "second", "way-in", names=("x", "bath")).scene
    assert [r.name for r in three.rooms] == ["room", "room 2", "bath"]
    assert len(doorways(three)) == 2


def test_pictures_of_both_stay(home: Scene, turned: Scene) -> None:
    def papered(scene: Scene) -> Scene:
        planes = (replace(p, texture=p.role) if p.role == "floor" else p for p in scene.architecture.planes)
        return edits.set_planes(scene, planes)

    made = join(papered(home), papered(turned), "door", "way-in")
    assert made.textures == {"floor": "floor-2"}
    assert [p.texture for p in made.scene.architecture.by_role("floor")] == ["floor", "floor-2"]


def test_what_cannot_be_joined_says_why(home: Scene, turned: Scene) -> None:
    with pytest.raises(EditRefused, match="choose one of: way-in"):
        join(home, turned, "door", "door")
    with pytest.raises(EditRefused, match="no door 'table'"):
        join(home, turned, "table", "way-in")
    with pytest.raises(EditRefused, match="without a floor"):
        join(home, Scene(), "door", "way-in")
    with pytest.raises(EditRefused, match="2 m thick"):
        join(home, turned, "door", "way-in", wall_m=2.0)
    free = edits.detach(edits.move(home, "door", Pose.upright((0.0, 0.0, 1.0))), "door")
    with pytest.raises(EditRefused, match="in no wall"):
        join(free, turned, "door", "way-in")


def square(x: float, y: float, side: float = 3.0) -> np.ndarray:
    return np.array([[x, y], [x + side, y], [x + side, y + side], [x, y + side]])


def test_a_room_drawn_beside_others_is_one_more_and_over_one_another_outline_of_it(home: Scene) -> None:
    low, high = home.plane("floor").polygon.min(axis=0), home.plane("floor").polygon.max(axis=0)
    two = draw_room_of_home(home, square(high[0] + 0.1, low[1]))
    check_scene(two)
    assert scene_from_json(scene_to_json(two)) == two
    assert [r.name for r in two.rooms] == ["room", "room 2"]
    assert two.objects == home.objects
    assert two.supports == home.supports
    assert set(rooms_of_objects(two).values()) == {two.rooms[0].id}
    assert np.isclose(two.plane("ceiling-2").centre[2], home.plane("ceiling").centre[2])

    wider = draw_room_of_home(two, square(high[0] + 0.1, low[1], 4.0))
    check_scene(wider)
    assert [r.id for r in wider.rooms] == [r.id for r in two.rooms]
    assert len(wider.architecture.planes) == len(two.architecture.planes)
    assert np.ptp(wider.plane(wider.rooms[1].floor).polygon[:, 0]) == pytest.approx(4.0)
    around = np.array(
        [low[:2] - 0.2, [high[0] + 0.05, low[1] - 0.2], high[:2] + np.array([0.05, 0.2]), [low[0] - 0.2, high[1] + 0.2]]
    )
    first = draw_room_of_home(two, around)
    check_scene(first)
    assert set(rooms_of_objects(first).values()) == {two.rooms[0].id}
    assert len(first.supports) == len(two.supports)
    assert draw_room_of_home(home, around).rooms == ()  # one room stays one

    with pytest.raises(EditRefused, match="over room and room 2"):
        draw_room_of_home(two, square(high[0] - 1.5, low[1]))
    with pytest.raises(EditRefused, match="storey 1 has no room"):
        draw_room_of_home(two, square(high[0] + 8.0, low[1]), storey=1)
