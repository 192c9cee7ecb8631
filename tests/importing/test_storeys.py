"""Flats, storeys, half walls and sloping ceilings of measured rooms."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.importing.measured_room import open_room
from diorama_core.importing.measured_types import MeasuredBox, MeasuredFloor, MeasuredRoom, MeasuredWall
from diorama_core.importing.storeys import ceiling_planes, floor_planes, floors_below, storeys_of
from diorama_core.library.catalogue import built_in_library


def ring(x: float, y: float, width: float = 3.0, depth: float = 3.0) -> np.ndarray:
    return np.array([[x, y], [x + width, y], [x + width, y + depth], [x, y + depth]], float)


def walls(outline: np.ndarray, low: float, high: float, stem: str) -> list[MeasuredWall]:
    ends = zip(outline, np.roll(outline, -1, axis=0), strict=True)
    return [
        MeasuredWall(f"{stem}-{k}", np.array([[*a, low], [*b, low], [*b, high], [*a, high]]))
        for k, (a, b) in enumerate(ends)
    ]


def bed(x: float, y: float, z: float) -> MeasuredBox:
    return MeasuredBox("bed", {"bed": 1.0}, np.eye(3), np.array([x, y, z + 0.25]), np.array([2.0, 1.6, 0.5]))


def test_every_room_and_storey_has_its_floor_and_what_stands_on_it() -> None:
    rooms = [(ring(0, 0), -1.35), (ring(3.1, 0), -1.35), (ring(0, 0), 1.45)]
    made = [w for k, (r, z) in enumerate(rooms) for w in walls(r, z, z + 2.5, f"w{k}")]
    floors = tuple(MeasuredFloor(r, z) for r, z in rooms)
    boxes = (bed(1.5, 1.5, -1.35), bed(4.6, 1.5, -1.35), bed(1.5, 1.5, 1.45))
    scene = open_room(MeasuredRoom(tuple(made), boxes, floors=floors), built_in_library()).scene
    assert [p.id for p in scene.architecture.by_role("floor")] == ["floor", "floor-2", "floor-3"]
    assert len(scene.architecture.by_role("ceiling")) == 3
    held = [scene.support_of(o.id) for o in scene.objects]
    assert [edge.parent for edge in held if edge is not None] == ["floor", "floor-2", "floor-3"]
    for wall, (outline, _) in zip(
        scene.architecture.by_role("wall"), [r for r in rooms for _ in range(4)], strict=True
    ):
        inward = np.append(outline.mean(axis=0), 0.0) - wall.centre
        assert wall.normal[:2] @ inward[:2] > 0


def test_a_half_wall_leaves_the_ceiling_and_a_gable_is_said() -> None:
    outline = ring(0, 0, 5, 4)
    half = MeasuredWall("half", np.array([[1, 1, 0], [2, 1, 0], [2, 1, 0.8], [1, 1, 0.8]], float))
    room = MeasuredRoom((*walls(outline, 0, 2.5, "w"), half), (), floors=(MeasuredFloor(outline, 0.0),))
    scene = open_room(room, built_in_library()).scene
    (ceiling,) = scene.architecture.by_role("ceiling")
    assert ceiling.centre[2] == pytest.approx(2.5)
    gable = MeasuredWall("g", np.array([[0, 0, 0], [5, 0, 0], [5, 0, 2.5], [2.5, 0, 3.6], [0, 0, 2.5]], float))
    attic = MeasuredRoom((gable, *walls(outline, 0, 2.5, "w")[1:]), (), floors=room.floors)
    opened = open_room(attic, built_in_library())
    assert not opened.scene.architecture.by_role("ceiling")
    assert any("slopes" in line for line in opened.changes)


def test_without_floors_the_walls_enclose_one() -> None:
    room = MeasuredRoom(tuple(walls(ring(0, 0), 0.5, 3.0, "w")), ())
    (storey,) = storeys_of(room)
    assert storey.height_m == 0.5
    assert storey.outline.area == pytest.approx(9.0)
    assert floor_planes((storey,))[0].centre[2] == pytest.approx(0.5)
    assert floors_below([bed(1.0, 1.0, 0.5)], (storey,)) == [0]
    assert ceiling_planes((storey,), ()) == ((), ())
