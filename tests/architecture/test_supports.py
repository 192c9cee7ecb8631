from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.supports import ADHERENCE_M, adhering_walls, nearest_wall, resolve_supports
from diorama_core.artefacts import Cuboid, ObjectGeometry
from diorama_core.provenance import ScaleSource
from diorama_core.scene.types import Architecture, Support, yaw_rotation
from tests.synthetic_rooms import box_room, look

PLANES = box_room(-2.0, 2.0, 4.0, 2.6)
ROOM = Architecture(PLANES)
WALLS = ROOM.by_role("wall")


def box(
    name: str, x: float, y: float, z: float, size=(0.4, 0.8, 1.0), yaw_deg: float = 0.0, front: bool = False
) -> Cuboid:
    return Cuboid(name, yaw_rotation(np.deg2rad(yaw_deg)), np.array([x, y, z]), np.array(size), 1.0, front_known=front)


def resolved(cuboid: Cuboid, parent: str | None, planes=PLANES) -> Support:
    edges = () if parent is None else (Support(cuboid.object_id, parent),)
    geometry = ObjectGeometry(look(), (cuboid,), edges, ScaleSource.GIVEN)
    (edge,) = resolve_supports(geometry, Architecture(tuple(planes)))
    return edge


def test_names_become_planes() -> None:
    chair = box("chair", 0, 2, 0.5)
    assert resolved(chair, "floor") == resolved(chair, None) == Support("chair", "floor")
    assert resolved(chair, "ceiling").parent == "ceiling"
    assert resolved(chair, "table") == Support("chair", "table")
    picture = box("picture", -0.5, 3.98, 1.5, (0.04, 0.6, 0.5), -90)
    assert resolved(picture, "wall") == Support("picture", "back", "mounted on")


def test_without_the_plane_the_next_best_holds() -> None:
    lamp = box("lamp", 1.9, 1.0, 2.3, (0.3, 0.3, 0.3))
    no_ceiling = [p for p in PLANES if p.role != "ceiling"]
    assert resolved(lamp, "ceiling", no_ceiling) == Support("lamp", "right", "mounted on")
    assert resolved(lamp, "ceiling", PLANES[:1]) == Support("lamp", "floor")
    assert resolved(lamp, "wall", ()) == Support("lamp", "wall")


@pytest.mark.parametrize(
    ("x", "y", "yaw", "wall"),
    [(-1.95, 1.0, 0, "left"), (1.95, 1.0, 180, "right"), (0.0, 3.95, -90, "back"), (-1.6, 3.95, -90, "back")],
)
def test_objects_hang_on_the_wall_behind_them(x: float, y: float, yaw: float, wall: str) -> None:
    assert nearest_wall(box("p", x, y, 1.5, (0.04, 0.6, 0.5), yaw), WALLS).id == wall


def test_a_flat_object_in_a_corner_hangs_with_its_thin_side_to_the_wall() -> None:
    for yaw, wall in ((0, "left"), (-90, "back")):
        assert nearest_wall(box("p", -1.75, 3.75, 1.5, (0.04, 0.4, 0.5), yaw), WALLS).id == wall


def test_objects_stand_against_walls_that_a_face_nearly_touches() -> None:
    inside = ADHERENCE_M - 0.01
    assert adhering_walls(box("s", -2.0 + 0.2 + inside, 1.0, 0.5), WALLS) == ("left",)
    assert adhering_walls(box("s", -2.0 + 0.2 + ADHERENCE_M + 0.01, 1.0, 0.5), WALLS) == ()
    assert adhering_walls(box("s", -1.75, 1.0, 0.5, yaw_deg=30), WALLS) == ()
    assert adhering_walls(box("s", -1.75, 3.5, 0.5), WALLS) == ("left", "back")


def test_a_known_front_lets_only_the_back_adhere() -> None:
    corner = box("s", -1.75, 3.5, 0.5, front=True)
    assert adhering_walls(corner, WALLS) == ("left",)
    turned = box("s", 1.75, 1.0, 0.5, front=True)
    assert adhering_walls(turned, WALLS) == ()


def test_a_wall_beside_the_object_does_not_count() -> None:
    assert adhering_walls(box("s", -1.75, 9.0, 0.5), WALLS) == ()
