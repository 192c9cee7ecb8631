"""Rooms of a home: which things are whose, and the doors that join them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapely.geometry import Point, Polygon

from diorama_core.editing.clipboard import clip_of, paste_at
from diorama_core.editing.placing import free_spot
from diorama_core.errors import EditRefused, SceneError
from diorama_core.geometry.openings import with_openings
from diorama_core.geometry.rooms import (
    doorways,
    floor_under,
    part_of_home,
    room_around,
    rooms_of_objects,
    rooms_of_planes,
    storeys_of,
)
from diorama_core.importing.scene_import import import_scene
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene import edits
from diorama_core.scene.history import Entry, History, move_last
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.types import Scene
from diorama_core.synthesis import sample_cameras
from tests.app.small_room import furnished_scene
from tests.importing.home_files import THICK_M, MadeHome, made_home, write_rooms, write_structure


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> tuple[MadeHome, Scene]:
    made = made_home(3)  # six rooms on two storeys
    return made, import_scene(write_structure(tmp_path_factory.mktemp("home") / "home.json", made)).opened.scene


def check_home(made: MadeHome, scene: Scene) -> None:
    """Walls within 1 cm, every door once and between its rooms, nothing doubled."""
    assert len(scene.rooms) == len(made.rooms)
    rooms = {r.id: r for r in scene.rooms}
    number_of = {}
    for number, room in enumerate(made.rooms):
        truth = Polygon(made.placed(room.ring))
        floors = [r for r in scene.rooms if truth.contains(Polygon(scene.plane(r.floor).polygon[:, :2]).centroid)]
        (of_room,) = [r for r in floors if r.storey == room.storey]
        number_of[of_room.id] = number
        floor = scene.plane(of_room.floor)
        assert Polygon(floor.polygon[:, :2]).hausdorff_distance(truth) < 0.01
        assert floor.centre[2] == pytest.approx(made.floor_m(room), abs=0.01)
    of_planes = rooms_of_planes(scene)
    walls = scene.architecture.by_role("wall")
    assert len(walls) == 4 * len(made.rooms)
    for wall in walls:
        ring = made.placed(made.rooms[number_of[of_planes[wall.id]]].ring)
        assert np.linalg.norm(wall.polygon[:, None, :2] - ring, axis=2).min(axis=1).max() < 0.01
    found = doorways(scene)
    assert len(found) == len(made.doors) == sum(o.category == "door" for o in scene.objects)
    for doorway in found:
        pair = sorted(number_of[r] for r in doorway.rooms)
        (at,) = [made.placed(d[2][None])[0] for d in made.doors if sorted(d[:2]) == pair]
        np.testing.assert_allclose(doorway.at, at, atol=0.01)
        assert doorway.depth_m == pytest.approx(THICK_M, abs=1e-3)
        assert rooms[doorway.rooms[0]].storey == rooms[doorway.rooms[1]].storey


@pytest.mark.parametrize("seed", range(6))
def test_a_home_of_room_plan_comes_as_it_is(seed: int, tmp_path: Path) -> None:
    made = made_home(seed)
    scene = import_scene(write_structure(tmp_path / "home.json", made)).opened.scene
    check_home(made, scene)
    assert sum(r.name.startswith("bedroom") for r in scene.rooms) == sum(r.name == "bedroom" for r in made.rooms)
    assert len({r.name for r in scene.rooms}) == len(scene.rooms)


@pytest.mark.parametrize("seed", [0, 3])
def test_rooms_of_several_files_are_placed_by_their_origin(seed: int, tmp_path: Path) -> None:
    made = made_home(seed)
    check_home(made, import_scene(write_rooms(tmp_path / "home", made)).opened.scene)


def test_things_are_in_the_room_whose_floor_is_under_them(home: tuple[MadeHome, Scene]) -> None:
    _, scene = home
    tables = [o for o in scene.objects if o.category != "door"]
    assert len({rooms_of_objects(scene)[o.id] for o in tables}) == len(scene.rooms) == len(tables)
    first, second = tables[0], tables[1]
    moved = edits.move(scene, first.id, replace(first.pose, position=second.pose.position))
    assert rooms_of_objects(moved)[first.id] == rooms_of_objects(scene)[second.id]


def test_a_part_of_a_home_is_a_scene_of_its_own(home: tuple[MadeHome, Scene]) -> None:
    _, scene = home
    ground = storeys_of(scene)[0]
    part = part_of_home(scene, [r.id for r in ground])
    assert part.rooms == ground
    assert {p.role for p in part.architecture.planes} == {"floor", "wall", "ceiling"}
    assert len(part.architecture.by_role("wall")) == 4 * len(ground)
    assert set(rooms_of_objects(part).values()) == {r.id for r in ground}
    both = sum(len(part_of_home(scene, [r.id]).architecture.planes) for r in scene.rooms)
    assert both == len(scene.architecture.planes)


def test_what_is_put_into_a_home_comes_to_the_room_looked_at(home: tuple[MadeHome, Scene]) -> None:
    _, scene = home
    library = built_in_library()
    table = next(o for o in scene.objects if o.category not in ("door", "window"))
    for room in scene.rooms:
        floor = scene.plane(room.floor)
        seen = floor.centre + np.array([0.0, 0.0, 1.0])
        part = room_around(scene, seen)
        assert part.rooms == (room,)
        assert room_around(scene, seen, {r.id for r in scene.rooms if r != room}).rooms != (room,)
        after, heads = paste_at(scene, clip_of(scene, [table.id]), seen)
        assert {rooms_of_objects(after)[i] for i in heads} == {room.id}
        assert {edge.parent for edge in after.supports if edge.child in heads} == {room.floor}
        lowest = min(float(after.object(i).corners_world[:, 2].min()) for i in heads)
        assert lowest == pytest.approx(float(floor.centre[2]), abs=1e-6)
        x, y = free_spot(part, library.shape(table.shape_id), seen)
        assert Polygon(floor.polygon[:, :2]).contains(Point(x, y))
    storeys = {room_around(scene, c.position).rooms[0].storey for c in sample_cameras(scene, library, 1, 6, (64, 48))}
    assert storeys == set(storeys_of(scene))


def test_a_door_opens_both_faces_of_its_wall(home: tuple[MadeHome, Scene]) -> None:
    _, scene = home
    cut = with_openings(scene)
    for doorway in doorways(scene):
        for wall in doorway.walls:
            assert len(cut.plane(wall).polygon) > len(scene.plane(wall).polygon)


def test_rooms_survive_the_file_and_old_files_are_one_room(home: tuple[MadeHome, Scene]) -> None:
    _, scene = home
    assert scene_from_json(scene_to_json(scene)) == scene
    assert '"rooms"' not in scene_to_json(furnished_scene())
    text = scene_to_json(scene).replace('"floor": "floor-2"', '"floor": "wall-1"')
    with pytest.raises(SceneError, match="has no floor 'wall-1'"):
        scene_from_json(text)
    text = scene_to_json(scene).replace('"floor": "floor-2"', '"floor": "floor"')
    with pytest.raises(SceneError, match="share one floor"):
        scene_from_json(text)


def test_rooms_are_renamed_and_undone_apart_from_each_other(home: tuple[MadeHome, Scene]) -> None:
    _, scene = home
    first, second = scene.rooms[:2]
    named = edits.set_room(scene, first.id, name="  study ", storey=4)
    assert (named.rooms[0].name, named.rooms[0].storey, named.rooms[0].floor) == ("study", 4, first.floor)
    both = edits.set_room(named, second.id, name="office")
    history = History.start(scene).commit(Entry("name the study", named, author="Ann"))
    history = history.commit(Entry("name the office", both, author="Bo"))
    undone = move_last(history, 1).undo().current.scene
    assert [r.name for r in undone.rooms[:2]] == [first.name, "office"]
    again = edits.set_room(named, first.id, name="den")
    history = History.start(scene).commit(Entry("a", named, author="Ann")).commit(Entry("b", again, author="Bo"))
    with pytest.raises(EditRefused, match="the room"):
        move_last(history, 1)
    for room, name in (("nothing", "study"), (first.id, " ")):
        with pytest.raises(EditRefused):
            edits.set_room(scene, room, name=name)


def test_a_room_goes_with_its_floor(home: tuple[MadeHome, Scene]) -> None:
    _, scene = home
    gone = scene.rooms[2]
    left = edits.set_planes(scene, [p for p in scene.architecture.planes if p.id != gone.floor])
    assert [r.id for r in left.rooms] == [r.id for r in scene.rooms if r is not gone]


def test_floors_at_about_one_height_go_by_distance_and_others_by_height() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    outlines, heights = [square, np.add(square, (1.1, 0.0)), square * 0.9], [0.0, 0.1, 2.8]
    feet = np.array([[0.5, 0.5, 0.0], [1.02, 0.5, 0.0], [1.5, 0.5, 0.1], [1.0, 0.5, 2.8], [0.5, 0.5, -1.0]])
    assert floor_under(feet, outlines, heights) == [0, 0, 1, 2, None]
    assert floor_under(feet[:1], [np.zeros((0, 2))], [0.0]) == [0]
