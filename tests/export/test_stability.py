"""Gravity and pushes: what rests stays, what is pushed goes."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.export.gathering import gather
from diorama_core.export.stability import Playground, stability
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.primitives import PrimitiveLibrary, furnished_room

pytest.importorskip("mujoco", reason="playing needs MuJoCo (extra 'sim')")

LIBRARY = PrimitiveLibrary()


@pytest.fixture(scope="module")
def room() -> Scene:
    return furnished_room(LIBRARY)


def _moved(scene: Scene, playground: Playground) -> dict[str, float]:
    poses = playground.poses()
    return {i: float(np.linalg.norm(p.position - scene.object(i).pose.position)) for i, p in poses.items()}


def test_after_two_seconds_all_is_where_an_export_simulates_it(room: Scene) -> None:
    playground = Playground(gather(room, LIBRARY))
    playground.step(2.0)
    assert playground.seconds == pytest.approx(2.0, abs=0.01)
    report = stability(gather(room, LIBRARY), seconds=2.0)
    free = {d.object_id for d in report.drifts if d.free}
    assert playground.movable == free
    moved = _moved(room, playground)
    for drift in report.drifts:
        if drift.free:  # of their centres of mass there, of their boxes here
            assert moved[drift.object_id] == pytest.approx(drift.moved_m, abs=1e-3)


def test_a_push_moves_one_and_what_is_locked_stays(room: Scene) -> None:
    chair = next(o for o in room.objects if o.category == "chair")
    table = next(o for o in room.objects if o.category == "table")
    locked = edits.set_locked(room, table.id, True)
    playground = Playground(gather(locked, LIBRARY))
    away = chair.pose.position - table.pose.position
    assert not playground.push(table.id, away)
    assert playground.push(chair.id, np.array([away[0], away[1], 0.0]))
    playground.step(1.0)
    assert _moved(locked, playground)[chair.id] > 0.1
    assert table.id not in playground.poses()
