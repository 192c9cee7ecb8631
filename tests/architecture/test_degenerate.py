"""Pictures and depths that show hardly a room: every solver gives what is known, with a reason, and never fails."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.architecture.plainrecon.stage import PlainRecon
from diorama_core.architecture.single_view.stage import PhotoRoom
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod, RoomSource
from tests import synthetic_rooms
from tests.synthetic_rooms import box_room, cuboid, shoot

SOLVERS = {"closed": PlanarRoom(), "plainrecon": PlainRecon(), "photo": PhotoRoom()}
CASES = (
    "no floor seen", "floor only", "one plane", "corridor", "mirror", "all masked", "empty depth", "fifty points",
    "not a number", "a wall before the nose",
)  # fmt: skip


look = partial(synthetic_rooms.look, size=(320, 240))


@cache
def room():
    return shoot(look(0, 12), box_room(-2.0, 2.0, 3.5, 2.6), (cuboid("stand", (0, 2, 0), (0.5, 0.5, 0.5)),))


@cache
def seen(case):
    """The room, the camera or the measured depth of a case."""
    shot = room()
    depth = shot.inputs.depth_m
    rows, columns = np.indices(depth.shape)
    if case == "no floor seen":
        return shoot(look(0, -25), box_room(-2.0, 2.0, 3.5, 2.6))
    if case == "corridor":
        return shoot(look(3, 6), box_room(-0.6, 0.6, 14.0, 2.4))
    if case == "a wall before the nose":
        return shoot(look(0, 5), box_room(-2.0, 2.0, 0.6, 2.6))
    if case == "floor only":
        return _measured(shot, np.where(rows > 200, depth, 0))
    if case == "one plane":
        return _measured(shot, np.where((rows < 75) & (np.abs(columns - 160) < 30), depth, 0))
    if case == "mirror":
        deep = (np.abs(columns - 160) < 35) & (rows > 45) & (rows < 100)
        return _measured(shot, np.where(deep, 2.0 * depth, depth))
    if case == "all masked":
        return replace(shot, objects=tuple(replace(o, mask=np.ones_like(o.mask)) for o in shot.objects))
    if case == "empty depth":
        return _measured(shot, np.zeros_like(depth))
    if case == "not a number":
        return _measured(shot, np.where(rows % 7 == 0, np.nan, np.where(rows % 11 == 0, np.inf, depth)))
    return _measured(shot, np.where((rows % 48 == 0) & (columns % 32 == 0), depth, 0))


def _measured(shot, depth):
    return replace(shot, inputs=replace(shot.inputs, depth_m=depth.astype(np.float32)))


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("solver", SOLVERS)
def test_what_is_known_comes_back_with_a_reason(solver, case):
    shot = seen(case)
    estimate = SOLVERS[solver].reconstruct(shot.inputs, shot.objects, shot.geometry, Progress())
    planes = estimate.architecture.planes
    assert estimate.architecture.floor is not None
    assert isinstance(estimate.source, RoomSource)
    assert 0.0 < estimate.confidence <= 1.0
    assert all(np.isfinite(p.polygon).all() and np.isfinite(p.normal).all() for p in planes)
    if solver != "plainrecon":
        assert estimate.architecture.by_role("wall")


@pytest.mark.parametrize(
    ("case", "floor", "walls"),
    [
        ("empty depth", False, False), ("fifty points", False, False), ("all masked", True, False),
        ("no floor seen", False, True), ("one plane", False, True), ("corridor", True, True),
    ],
)  # fmt: skip
def test_the_source_states_what_was_found(case, floor, walls):
    shot = seen(case)
    estimate = PlanarRoom().reconstruct(shot.inputs, shot.objects, shot.geometry, Progress())
    source = estimate.source
    assert (source.floor_found, source.walls_found > 0) == (floor, walls)
    assert source.walls_assumed > 0 or walls
    assert source.method is RoomMethod.DEPTH_PLANES


def test_a_mirror_opens_no_room_behind_the_wall():
    shot = seen("mirror")
    planes = PlanarRoom().reconstruct(shot.inputs, shot.objects, shot.geometry, Progress()).architecture.planes
    back = max((p for p in planes if p.role == "wall"), key=lambda p: -p.normal[1])
    assert back.offset == pytest.approx(-3.5, abs=0.05)


def test_a_corridor_has_its_two_walls():
    shot = seen("corridor")
    walls = PlanarRoom().reconstruct(shot.inputs, (), shot.geometry, Progress()).architecture.by_role("wall")
    for side in (1.0, -1.0):
        wall = max(walls, key=lambda w: side * w.normal[0])
        assert wall.offset == pytest.approx(-0.6, abs=0.05)
