from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.settled import Settled
from diorama_core.progress import Progress
from tests.layout.small_rooms import Room


def bottom(scene, name):
    return float(scene.object(name).corners_world[:, 2].min())


def top(scene, name):
    return float(scene.object(name).corners_world[:, 2].max())


def settled(scene):
    return Settled().optimise(scene, Progress())


def test_what_floats_comes_down_onto_what_supports_it(room: Room) -> None:
    table = room.put("table_1", (0.0, 0.0, 1.4))
    cup = room.put("cup_21", (0.1, 0.0, 2.3), table)
    after, _ = settled(room.scene())
    assert bottom(after, table) == pytest.approx(0.0, abs=1e-9)
    assert bottom(after, cup) == pytest.approx(top(after, table))


def test_what_overlaps_goes_apart_and_carries_its_things_along(room: Room) -> None:
    one = room.put("table_1", (0.0, 0.0, 0.4))
    cup = room.put("cup_21", (0.0, 0.0, 1.0), one)
    two = room.put("table_1", (0.3, 0.05, 0.4))
    before = room.scene()
    after, report = settled(before)
    assert report.before["overlap"] > 0.05
    assert report.after["overlap"] == pytest.approx(0.0, abs=1e-2)
    went = after.object(one).pose.position - before.object(one).pose.position
    assert np.linalg.norm(went[:2]) > 0.05
    np.testing.assert_allclose(
        (after.object(cup).pose.position - before.object(cup).pose.position)[:2], went[:2], atol=1e-9
    )
    assert after.object(two).pose.R_world_object == pytest.approx(before.object(two).pose.R_world_object)


def test_what_is_locked_stays_and_the_other_goes_all_the_way(room: Room) -> None:
    one = room.put("table_1", (0.0, 0.0, 0.4), locked=True)
    room.put("table_1", (0.3, 0.05, 0.4))
    before = room.scene()
    after, report = settled(before)
    assert after.object(one) == before.object(one)
    assert report.after["overlap"] < report.before["overlap"]
