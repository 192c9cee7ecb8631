from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.multiview.joint_fit import JointCuboid
from diorama_core.multiview.mounted_walls import hangs_on_wall, room_holding, walls_at_mounted
from diorama_core.scene.types import Architecture, Plane

WIDTH, DEPTH, TOP = 4.0, 3.0, 2.5


def room() -> Architecture:
    """Walls in order: y = 0, x = 4, y = 3, x = 0; seen from inside."""
    ring = [(0.0, 0.0), (WIDTH, 0.0), (WIDTH, DEPTH), (0.0, DEPTH)]
    planes = [Plane("floor", "floor", np.array([[x, y, 0.0] for x, y in ring]))]
    for number, ((ax, ay), (bx, by)) in enumerate(zip(ring, [*ring[1:], ring[0]], strict=True)):
        corners = [[bx, by, 0.0], [ax, ay, 0.0], [ax, ay, TOP], [bx, by, TOP]]
        planes.append(Plane(f"wall_{number + 1}", "wall", np.array(corners)))
    inward = [p if p.role == "floor" or _faces_in(p) else replace(p, polygon=p.polygon[::-1]) for p in planes]
    return Architecture(tuple(inward))


def _faces_in(wall: Plane) -> bool:
    return bool(wall.normal @ np.array([WIDTH / 2, DEPTH / 2, 1.0]) > wall.offset)


def picture(x: float, y: float) -> JointCuboid:
    """Facing +y or -y, 4 cm thick, its middle there."""
    return JointCuboid(np.array([x, y, 1.5]), np.pi / 2, np.array([0.04, 0.8, 0.6]), 0.0)


def coordinate(found: Architecture, name: str) -> float:
    wall = next(p for p in found.planes if p.id == name)
    return float(wall.polygon[:, 1].mean())


def test_a_wall_moves_to_the_backs_of_what_hangs_on_it_and_the_room_stays_closed() -> None:
    found = walls_at_mounted(room(), [picture(1.0, 0.17), picture(3.0, 0.17)])
    assert coordinate(found, "wall_1") == pytest.approx(0.15)
    assert coordinate(found, "wall_3") == pytest.approx(DEPTH)
    floor = found.floor
    assert floor is not None
    assert floor.polygon[:, 1].min() == pytest.approx(0.15)
    side = next(p for p in found.planes if p.id == "wall_2")
    assert side.polygon[:, 1].min() == pytest.approx(0.15)


def test_the_middle_of_several_counts() -> None:
    things = [picture(0.8, 0.12), picture(2.0, 0.13), picture(3.2, 0.35)]
    assert coordinate(walls_at_mounted(room(), things), "wall_1") == pytest.approx(0.11)


def test_walls_without_things_and_those_that_may_not_move_stay() -> None:
    things = [picture(2.0, 0.17)]
    assert coordinate(walls_at_mounted(room(), things, {"wall_2"}), "wall_1") == 0.0
    assert coordinate(walls_at_mounted(room(), []), "wall_1") == 0.0
    far = walls_at_mounted(room(), [picture(2.0, 1.0)])
    assert coordinate(far, "wall_1") == 0.0
    deep = replace(picture(2.0, 0.4), size_m=np.array([0.6, 0.8, 0.6]))
    assert coordinate(walls_at_mounted(room(), [deep]), "wall_1") == 0.0


def test_what_hangs_on_walls_by_its_kind() -> None:
    assert hangs_on_wall("picture")
    assert hangs_on_wall("door")
    assert not hangs_on_wall("chair")


def test_a_wall_that_something_hangs_on_is_not_given_up() -> None:
    whole = room()
    open_side = Architecture(tuple(p for p in whole.planes if p.id != "wall_1"))
    assert room_holding(open_side, [whole], [picture(1.0, 0.1)]) is whole
    assert room_holding(open_side, [whole], [picture(1.0, 2.9)]) is open_side
    assert room_holding(open_side, [whole], []) is open_side


def test_what_hangs_beside_a_wall_does_not_hang_on_it() -> None:
    whole = room()
    beside = picture(WIDTH + 1.0, 0.1)
    assert room_holding(whole, [longer(whole, 1.3)], [beside]) is not whole


def longer(found: Architecture, stretch: float) -> Architecture:
    """A room, longer along x."""
    return Architecture(tuple(replace(p, polygon=p.polygon * [stretch, 1.0, 1.0]) for p in found.planes))
