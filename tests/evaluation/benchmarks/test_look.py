"""The table of the photo's own look, and what it measures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.evaluation.benchmarks.look import LookBench, ObjectLook, _difference, _outline_iou, _standing
from diorama_core.scene.types import Pose, SceneObject
from tests.pose.rooms import LIBRARY, camera_at

ONE = ObjectLook("room", "measured depth", "table", 6.0, 5.0, 4.0, 0.8, 0.85, 10.0, 5.0)
UNSEEN = replace(ONE, chamfer_after=2.0, colour_before=None, colour_after=None)

LIGHTS = (("measured depth", 10.0), ("measured depth", 30.0), ("picture alone", 90.0))


def table(x: float = 0.0, scale: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> SceneObject:
    size = LIBRARY.shape("table").size_m
    pose = Pose.upright((x, 3.0, size[2] * scale[2] / 2), 0.3, scale)
    return SceneObject("t", "table", "table", "table", size, pose, box_px=(120.0, 120.0, 360.0, 300.0))


def test_objects_of_what_was_given_are_averaged_and_unseen_colours_left_out() -> None:
    bench = LookBench(0, (ONE, UNSEEN, replace(ONE, given="picture alone")), (("measured depth", 0.2, 0.1),), LIGHTS)
    (found,) = bench.tables()
    (row,) = found.rows
    assert row.name == "measured depth"
    assert row.values == (
        2,
        6.0,
        5.0,
        3.0,
        5.0,
        3.0,
        pytest.approx(0.8),
        pytest.approx(0.85),
        10.0,
        5.0,
        20.0,
        0.2,
        0.1,
    )
    assert len(row.values) == len(found.columns)
    assert bench.to_json()["bench"] == "look"


def test_outlines_are_compared_through_their_own_cameras() -> None:
    camera = camera_at()
    assert _outline_iou(table(), camera, table(), camera, LIBRARY) == 1.0
    assert 0.2 < _outline_iou(table(), camera, table(0.2), camera, LIBRARY) < 0.9


def test_shapes_are_compared_in_the_size_at_which_they_stand() -> None:
    size = np.array(LIBRARY.shape("table").size_m) * (1.0, 1.4, 1.0)
    assert np.ptp(_standing(table(scale=(1.0, 1.4, 1.0)), LIBRARY).vertices, axis=0) == pytest.approx(size)


def test_blurred_pictures_differ_by_their_colours_not_their_grain() -> None:
    rng = np.random.default_rng(0)
    grain = np.clip(128 + rng.normal(0, 20, (240, 320, 1)), 0, 255).astype(np.uint8).repeat(3, axis=2)
    other = np.full_like(grain, 128)
    assert _difference(grain, other).mean() < 2.0
    assert _difference(grain, np.full_like(grain, 200)).mean() > 15.0
