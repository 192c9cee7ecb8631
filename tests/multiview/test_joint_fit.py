from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.taxonomy import category
from diorama_core.multiview.joint_fit import fit_jointly, meeting_point
from tests.multiview.rooms import CAMERAS, THINGS, camera, photo


def _sightings(number: int, cameras) -> list:
    found = []
    for seen in cameras:
        one, whose = photo(seen)
        if number in whose:
            found.append((one.boxes, whose.index(number)))
    return found


@pytest.mark.parametrize("number", range(len(THINGS)))
def test_boxes_of_three_photos_place_a_thing(number: int) -> None:
    thing, sightings = THINGS[number], _sightings(number, CAMERAS)
    start = np.add(thing.centre, (0.4, -0.3, 0.0))
    found = fit_jointly(sightings, category(thing.kind), [start], on_floor=True)
    assert np.linalg.norm(found.centre - thing.centre) < 0.15
    assert found.centre[2] == pytest.approx(found.size_m[2] / 2)
    turn = (found.yaw_rad - thing.yaw_rad) % (np.pi / 2)
    assert min(turn, np.pi / 2 - turn) < np.radians(20)


def test_more_photos_place_better() -> None:
    def error(count: int) -> float:
        cameras = (*CAMERAS, camera(0.2, 3.4, (0.0, 0.5)))[:count]
        off = []
        for number, thing in enumerate(THINGS):
            start = np.add(thing.centre, (0.5, 0.4, 0.0))
            sightings = _sightings(number, cameras)
            off.append(fit_jointly(sightings, category(thing.kind), [start], on_floor=True).centre - thing.centre)
        return float(np.linalg.norm(off, axis=1).mean())

    assert error(4) < error(1)


def test_what_does_not_stand_on_the_floor_gets_its_height_from_the_rays() -> None:
    thing = THINGS[0]
    sightings = _sightings(0, CAMERAS)
    start = np.add(thing.centre, (0.2, 0.2, 0.3))
    found = fit_jointly(sightings, category(thing.kind), [start], on_floor=False)
    assert abs(found.centre[2] - thing.centre[2]) < 0.15


def test_rays_meet_where_the_thing_is() -> None:
    for number, thing in enumerate(THINGS[:3]):  # the last is cut by the borders
        assert np.linalg.norm(meeting_point(_sightings(number, CAMERAS)) - thing.centre) < 0.25
