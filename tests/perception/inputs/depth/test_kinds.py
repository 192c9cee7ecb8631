"""What a depth map's numbers are and how long their unit is, inferred from a room that is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.perception.inputs.depth.kinds import Known, depth_order, depth_readings, rays_of
from diorama_core.perception.inputs.depth.planes import PlaneFit, planes_of, sample_depth
from diorama_core.perception.inputs.depth.reading import choose_reading
from diorama_core.perception.inputs.depth.scale import (
    AmbiguousDepthError,
    ScaleEvidence,
    focal_of_planes,
    metric_depth,
    metric_of_bent,
    scale_evidence,
    unit_of,
)
from tests.perception.inputs.depth.rooms import CAMERA_M, CEILING_M, FOCAL, HEIGHT, WIDTH, room

DEPTH, THINGS = room()
KNOWN, NOTHING = Known(THINGS, FOCAL), Known()


def best(values: np.ndarray, boxes=THINGS, focal=None):
    return depth_readings(values.astype(np.float32), Known(boxes, focal))[0]


def noisy(values: np.ndarray, share: float) -> np.ndarray:
    return values * (1.0 + share * np.random.default_rng(1).standard_normal(values.shape))


@pytest.mark.parametrize(("unit", "noise"), [(1.0, 0.0), (1000.0, 0.01), (0.3, 0.01)])
def test_depth_is_depth_in_any_unit(unit: float, noise: float) -> None:
    assert best(noisy(DEPTH * unit, noise)).kind == "depth"
    assert best(noisy(DEPTH * unit, noise), ()).kind == "depth"


@pytest.mark.parametrize(("scale", "offset"), [(255.0, 3.0), (0.01, 0.0)])
def test_inverse_depth_is_recognised_with_any_offset(scale: float, offset: float) -> None:
    reading = best(noisy(scale / DEPTH + offset, 0.01))
    assert reading.kind == "inverse"
    assert reading.order > 0.3


def test_distances_along_rays_tell_the_focal_length() -> None:
    reading = best(DEPTH * rays_of(HEIGHT, WIDTH, FOCAL))
    assert reading.kind == "distance"
    assert reading.focal == pytest.approx(FOCAL, rel=0.04)
    known = best(DEPTH * rays_of(HEIGHT, WIDTH, FOCAL), focal=FOCAL)
    assert (known.kind, known.focal) == ("distance", FOCAL)


def test_near_and_far() -> None:
    assert depth_order(DEPTH, THINGS) > 0.3
    assert depth_order(1.0 / DEPTH, THINGS) < -0.3


def test_planes_of_a_room_meet_at_right_angles_under_its_focal_length() -> None:
    fit = planes_of(sample_depth(DEPTH))
    assert fit.explained > 0.7
    turned = np.array([[np.sin(a), 0.0, np.cos(a)] for a in (0.5, 0.5 + np.pi / 2)])  # two walls seen at an angle
    walls = PlaneFit(1.0, turned * [1 / FOCAL, 1 / FOCAL, 1.0], np.array([0.5, 0.4]))
    assert focal_of_planes(walls) == pytest.approx(FOCAL, rel=0.08)


@pytest.mark.parametrize("per_metre", [1000.0, 5000.0, 100.0])
def test_the_scale_is_told_by_things_and_the_floor(per_metre: float) -> None:
    values = DEPTH * per_metre
    reading = best(values)
    evidence = scale_evidence(values, reading.fit, FOCAL, THINGS)
    assert np.exp(-evidence.log_scale) == pytest.approx(per_metre, rel=0.2)
    assert evidence.floor_height == pytest.approx(CAMERA_M * per_metre, rel=0.05)
    unit = unit_of(evidence, 1000.0)
    if per_metre == 1000.0:
        assert (unit.per_metre, unit.note, unit.question) == (1000.0, "", "")
    else:
        assert unit.per_metre == per_metre or f"--depth-scale {per_metre:g} " in unit.question + " "


def test_without_things_the_stated_unit_stays_and_an_odd_height_is_remarked() -> None:
    reading = best(DEPTH * 5.0)
    evidence = scale_evidence(DEPTH * 5.0, reading.fit, FOCAL, ())
    assert "13.0 m high and the camera 8.0 m above the floor" in unit_of(evidence, 1.0).note
    unit = unit_of(replace(evidence, room_height=None), 1.0)
    assert (unit.per_metre, unit.question) == (1.0, "")
    assert "8.0 m above the floor" in unit.note
    assert unit_of(None, 1000.0).note == ""


def test_inverse_depth_becomes_metric_by_walls_and_things() -> None:
    values = (30.0 / DEPTH + 2.0).astype(np.float32)
    reading = best(values)
    depth, notes = metric_depth("d.npy", values, reading.fit, KNOWN)
    off = np.log(depth / DEPTH)
    assert abs(np.median(off)) < 0.25
    assert np.percentile(np.abs(off - np.median(off)), 90) < 0.1
    assert "inverse depth" in notes[0]


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        ("root", np.sqrt(DEPTH) * 90.0),
        ("logarithm", np.log10(1000.0 * DEPTH)),
        ("logarithm", 255.0 * np.log(DEPTH / 0.3) / np.log(40.0)),
        ("shifted", 1.0 + 65000.0 * (DEPTH - DEPTH.min()) / np.ptp(DEPTH)),
    ],
)
def test_roots_and_logarithms_are_asked_for_without_any_box(kind: str, values: np.ndarray) -> None:
    values = values.astype(np.float32)
    readings = depth_readings(values, NOTHING)
    with pytest.raises(AmbiguousDepthError, match=f"--depth-kind {kind}") as asked:
        choose_reading("d.npy", readings, None, "auto")
    assert [c.kind for c in asked.value.choices] == [kind, "depth"]
    reading, _ = choose_reading("d.npy", depth_readings(values, NOTHING, kind), None, kind)
    depth, notes = metric_of_bent("d.npy", values, reading, KNOWN, None)
    off = np.log(depth / DEPTH)
    assert abs(np.median(off)) < 0.25
    assert np.percentile(np.abs(off - np.median(off)), 90) < 0.03
    assert kind in notes[0]


def test_roots_and_logarithms_in_a_stated_unit_are_exact() -> None:
    for kind, values in (("root", 8.0 * np.sqrt(DEPTH)), ("logarithm", 8.0 * np.log(DEPTH))):
        reading = depth_readings(values, NOTHING, kind)
        chosen, _ = choose_reading("d.npy", reading, None, kind)
        depth, notes = metric_of_bent("d.npy", values, chosen, NOTHING, 8.0)
        np.testing.assert_allclose(depth, DEPTH, rtol=1e-5)
        assert notes == ()


@pytest.mark.parametrize("kind", ["depth", "distance", "inverse", "root", "logarithm", "shifted"])
def test_a_kind_that_is_given_is_among_the_readings(kind: str) -> None:
    assert kind in {r.kind for r in depth_readings(DEPTH, NOTHING, kind)}


def test_depth_whose_planes_noise_hides_is_no_other_function() -> None:
    for share in (0.005, 0.02, 0.05):
        readings = depth_readings(noisy(DEPTH, share), NOTHING)
        assert choose_reading("d.npy", readings, None, "auto")[0].kind == "depth"
        assert choose_reading("d.npy", readings, None, "auto")[1] == ()


@pytest.mark.parametrize(("unit", "likely"), [(512.0, {500.0, 512.0}), (256.0, {256.0}), (5000.0, {5000.0, 4000.0})])
def test_the_heights_of_room_and_camera_contradict_a_unit_without_any_box(unit: float, likely: set[float]) -> None:
    values = (DEPTH * unit).astype(np.float32)
    evidence = scale_evidence(values, best(values, ()).fit, FOCAL, ())
    assert evidence.heights_agree
    assert evidence.room_height == pytest.approx((CAMERA_M + CEILING_M) * unit, rel=0.05)
    found = unit_of(evidence, 1000.0)
    assert "the room is" in found.note + found.question
    assert likely & {found.per_metre, *(u for u, _ in found.choices)}


def test_a_high_hall_contradicts_nothing() -> None:
    evidence = ScaleEvidence(float(np.log(0.7)), 0.1, 0, 1.6, 5.2)
    assert not evidence.heights_agree
    assert unit_of(evidence, 1.0) == unit_of(None, 1.0)
