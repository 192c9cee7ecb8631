from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.clearances import clear_of_walls, clearances, room_before, set_clearance
from diorama_core.editing.plan_edits import empty_room
from diorama_core.errors import EditRefused
from diorama_core.scene.types import Pose, Scene, SceneObject, Support


def box(name: str, x: float, y: float, size=(0.6, 1.0, 0.8), yaw: float = 0.0, base: float = 0.0) -> SceneObject:
    return SceneObject(name, name, "cabinet", "shape", size, Pose.upright((x, y, base + size[2] / 2), yaw))


ROOM = empty_room(4.0, 6.0, 2.5)


def scene_of(*objects: SceneObject) -> Scene:
    return replace(ROOM, objects=objects, supports=tuple(Support(o.id, "floor") for o in objects))


def by_side(scene: Scene, name: str) -> dict[str, tuple[float, str]]:
    return {c.side: (round(c.distance_m, 6), c.other) for c in clearances(scene, name)}


def test_a_free_object_is_measured_to_the_four_walls() -> None:
    found = by_side(scene_of(box("a", 0.5, 1.0)), "a")
    assert found == {
        "front": (1.2, "wall_2"),
        "back": (2.2, "wall_4"),
        "left": (1.5, "wall_1"),
        "right": (3.5, "wall_3"),
    }


def test_neighbours_come_first_even_off_the_middle_and_ends_lie_on_both() -> None:
    scene = scene_of(box("a", 0.0, 0.0), box("b", 1.5, 0.6, (0.4, 0.5, 1.0)))
    found = by_side(scene, "a")
    assert found["front"] == (1.0, "b")
    ends = next(c for c in clearances(scene, "a") if c.side == "front")
    assert ends.start[0] == pytest.approx(0.3)
    assert ends.end[0] == pytest.approx(1.3)
    assert np.linalg.norm(ends.end - ends.start) == pytest.approx(ends.distance_m)


def test_rugs_lamps_overhead_loads_and_hidden_objects_are_no_neighbours() -> None:
    rug = box("rug", 1.0, 0.0, (1.0, 1.0, 0.02))
    above = box("above", 1.0, 0.0, (0.3, 0.3, 0.3), base=2.0)
    hidden = replace(box("hidden", 1.0, 0.0), hidden=True)
    load = box("load", 0.2, 0.0, (0.2, 0.2, 0.2), base=0.8)
    scene = scene_of(box("a", 0.0, 0.0), rug, above, hidden)
    scene = replace(scene, objects=(*scene.objects, load), supports=(*scene.supports, Support("load", "a")))
    assert by_side(scene, "a")["front"] == (1.7, "wall_2")


def test_what_reaches_into_a_neighbour_has_a_negative_distance() -> None:
    assert by_side(scene_of(box("a", 0.0, 0.0), box("b", 0.5, 0.0)), "a")["front"][0] == pytest.approx(-0.1)


def test_a_typed_distance_is_kept_with_everything_on_it() -> None:
    load = box("load", 0.0, 0.0, (0.2, 0.2, 0.2), base=0.8)
    scene = scene_of(box("a", 0.0, 0.0, yaw=np.pi / 2))
    scene = replace(scene, objects=(*scene.objects, load), supports=(*scene.supports, Support("load", "a")))
    moved = set_clearance(scene, "a", "front", 0.25)
    assert by_side(moved, "a")["front"] == (0.25, "wall_1")
    np.testing.assert_allclose(
        moved.object("load").pose.position - load.pose.position,
        moved.object("a").pose.position - scene.object("a").pose.position,
        atol=1e-9,
    )
    with pytest.raises(EditRefused, match="cannot be set"):
        set_clearance(scene, "a", "front", -1.0)
    alone = replace(scene, architecture=Scene().architecture, supports=())
    with pytest.raises(EditRefused, match="nothing to the left"):
        set_clearance(alone, "a", "left", 1.0)


@pytest.mark.parametrize("yaw", [0.0, 0.4, 1.2, -2.0])
def test_distances_stay_with_the_room_when_both_are_turned_by_quarters(yaw: float) -> None:
    first = by_side(scene_of(box("a", 0.3, 0.2, yaw=yaw)), "a")
    turned = by_side(scene_of(box("a", -0.3, -0.2, yaw=yaw + np.pi)), "a")
    assert {s: d for s, (d, _) in first.items()} == pytest.approx({s: d for s, (d, _) in turned.items()})


def test_a_rug_is_measured_to_the_walls_only() -> None:
    found = by_side(scene_of(box("rug", 0.0, 0.0, (1.0, 1.0, 0.01)), box("chair", 1.0, 0.0)), "rug")
    assert found["front"] == (1.5, "wall_2")


def test_the_room_before_a_wall_is_its_length_across() -> None:
    across = room_before(ROOM, "wall_1")
    assert across is not None
    assert (across.distance_m, across.other) == (pytest.approx(6.0), "wall_3")
    assert room_before(ROOM, "ceiling").distance_m == pytest.approx(2.5)
    alone = replace(ROOM, architecture=replace(ROOM.architecture, planes=(ROOM.plane("wall_1"),)))
    assert room_before(alone, "wall_1") is None


@pytest.mark.parametrize(
    ("place", "yaw"),
    [((1.95, 0.0), 0.0), ((1.99, 1.0), 0.7), ((1.9, 2.9), 0.3), ((-1.95, -2.95), 1.2), ((2.05, 0.0), 0.0)],
)
def test_what_is_put_at_a_wall_is_inside_the_room(place: tuple[float, float], yaw: float) -> None:
    put = box("a", *place, yaw=yaw)
    corners = replace(put, pose=clear_of_walls(ROOM, put)).corners_world[:, :2]
    assert (np.abs(corners) <= np.array([2.0, 3.0]) + 1e-6).all()


def test_what_is_free_stays() -> None:
    put = box("a", 0.3, 0.4, yaw=0.5)
    assert clear_of_walls(ROOM, put) == put.pose


def test_walls_that_are_elsewhere_push_nothing() -> None:
    """Behind a wall's end: the wall of another part of the room is in line with it."""
    plane = next(p for p in ROOM.architecture.by_role("wall") if p.normal[0] < -0.9)
    short = replace(plane, polygon=plane.polygon * np.array([1.0, 0.3, 1.0]))
    room = replace(ROOM, architecture=replace(ROOM.architecture, planes=(short,)))
    put = box("a", 1.95, 2.5)
    assert clear_of_walls(room, put) == Pose.upright(put.pose.position, 0.0)
