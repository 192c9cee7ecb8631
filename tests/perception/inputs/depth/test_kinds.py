"""What a depth map's numbers are and how long their unit is, inferred from a room that is known."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.perception.inputs.depth.kinds import depth_readings, near_and_far, rays_of
from diorama_core.perception.inputs.depth.planes import PlaneFit, planes_of, sampled
from diorama_core.perception.inputs.depth.relative import metric_depth
from diorama_core.perception.inputs.depth.scale import focal_of_planes, scale_evidence
from diorama_core.perception.inputs.depth.units import unit_of
from tests.perception.inputs.depth.rooms import CAMERA_M, FOCAL, HEIGHT, WIDTH, room

DEPTH, THINGS = room()
SEEN = np.ones(DEPTH.shape, bool)


def best(values: np.ndarray, boxes=THINGS, focal=None):
    return depth_readings(values.astype(np.float32), SEEN, boxes, focal)[0]


def noisy(values: np.ndarray, share: float) -> np.ndarray:
    return values * (1.0 + share * np.random.default_rng(1).standard_normal(values.shape))


@pytest.mark.parametrize("unit", [1.0, 1000.0, 0.3])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_depth_is_depth_in_any_unit(unit: float, noise: float) -> None:
    assert best(noisy(DEPTH * unit, noise)).kind == "depth"
    assert best(noisy(DEPTH * unit, noise), ()).kind == "depth"


@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (20.0, 1.3), (255.0, 3.0), (0.01, 0.0)])
def test_inverse_depth_is_recognised_with_any_offset(scale: float, offset: float) -> None:
    for values in (scale / DEPTH + offset, noisy(scale / DEPTH + offset, 0.01)):
        reading = best(values)
        assert reading.kind == "inverse"
        assert reading.order > 0.3


def test_distances_along_rays_tell_the_focal_length() -> None:
    reading = best(DEPTH * rays_of(HEIGHT, WIDTH, FOCAL))
    assert reading.kind == "distance"
    assert reading.focal == pytest.approx(FOCAL, rel=0.04)
    known = best(DEPTH * rays_of(HEIGHT, WIDTH, FOCAL), focal=FOCAL)
    assert (known.kind, known.focal) == ("distance", FOCAL)


def test_near_and_far() -> None:
    assert near_and_far(DEPTH, SEEN, THINGS) > 0.3
    assert near_and_far(1.0 / DEPTH, SEEN, THINGS) < -0.3


def test_planes_of_a_room_meet_at_right_angles_under_its_focal_length() -> None:
    fit = planes_of(sampled(DEPTH, SEEN), inverse=False)
    assert fit.explained > 0.7
    turned = np.array([[np.sin(a), 0.0, np.cos(a)] for a in (0.5, 0.5 + np.pi / 2)])  # two walls seen at an angle
    walls = PlaneFit(1.0, turned * [1 / FOCAL, 1 / FOCAL, 1.0], np.array([0.5, 0.4]))
    assert focal_of_planes(walls) == pytest.approx(FOCAL, rel=0.08)


@pytest.mark.parametrize("per_metre", [1000.0, 5000.0, 4000.0, 256.0, 100.0])
def test_the_scale_is_told_by_things_and_the_floor(per_metre: float) -> None:
    values = DEPTH * per_metre
    reading = best(values)
    evidence = scale_evidence(values, SEEN, reading.fit, FOCAL, THINGS)
    assert evidence is not None
    assert np.exp(-evidence.log_scale) == pytest.approx(per_metre, rel=0.2)
    assert evidence.floor_height == pytest.approx(CAMERA_M * per_metre, rel=0.05)
    unit = unit_of(evidence, 1000.0)
    if per_metre == 1000.0:
        assert (unit.per_metre, unit.note, unit.question) == (1000.0, "", "")
    else:
        assert unit.per_metre == per_metre or f"--depth-scale {per_metre:g} " in unit.question + " "


def test_without_things_the_stated_unit_stays_and_an_odd_height_is_remarked() -> None:
    reading = best(DEPTH * 5.0)
    evidence = scale_evidence(DEPTH * 5.0, SEEN, reading.fit, FOCAL, ())
    unit = unit_of(evidence, 1.0)
    assert (unit.per_metre, unit.question) == (1.0, "")
    assert "8.0 m above the floor" in unit.note
    assert unit_of(None, 1000.0).note == ""


def test_inverse_depth_becomes_metric_by_walls_and_things() -> None:
    values = (30.0 / DEPTH + 2.0).astype(np.float32)
    reading = best(values)
    depth, notes = metric_depth("d.npy", values, SEEN, reading.fit, THINGS, FOCAL)
    off = np.log(depth / DEPTH)
    assert abs(np.median(off)) < 0.25
    assert np.percentile(np.abs(off - np.median(off)), 90) < 0.1
    assert "inverse depth" in notes[0]
