from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from diorama_core.artefacts import ArchitectureEstimate
from diorama_core.perception.foundation.depth_prediction import (
    NetworkCamera,
    NetworkDepth,
    NetworkDepthPrediction,
    with_depth,
)
from diorama_core.perception.measured import MeasuredGeometry
from diorama_core.pipeline.findings import camera_sentence, geometry_sentence
from diorama_core.progress import Progress
from diorama_core.provenance import DepthSource, RoomMethod, RoomSource
from diorama_core.scene.types import Architecture
from tests.synthetic_rooms import Shot, box_room, cuboid, look, shoot

SHOT: Shot = shoot(
    look(0, 12, 1.5, 70, (160, 120)),
    box_room(-2.2, 2.2, 4.0, 2.6),
    (cuboid("table", (0.3, 2.6, 0), (0.8, 1.4, 0.75), -90),),
    ("table",),
)


class TrueNetwork:
    """Sees the shot's own depth; normals toward the camera everywhere."""

    def predict(self, rgb: np.ndarray, intrinsics):
        normals = np.zeros((*rgb.shape[:2], 3), np.float32)
        normals[..., 2] = -1.0
        return SimpleNamespace(
            depth_m=SHOT.inputs.depth_m, normals_camera=normals, intrinsics=intrinsics or SHOT.camera.intrinsics
        )


def seen_inputs(given=None):
    prediction = NetworkDepthPrediction(TrueNetwork()).predict(SHOT.inputs.photo, given, Progress())
    return with_depth(replace(SHOT.inputs, depth_m=None, intrinsics=given), prediction)


def test_the_inputs_say_whose_depth_it_is_and_keep_what_was_given() -> None:
    inputs = seen_inputs()
    assert inputs.depth_source == "network"
    np.testing.assert_array_equal(inputs.depth_m, SHOT.inputs.depth_m)
    assert inputs.intrinsics == SHOT.camera.intrinsics
    other = replace(SHOT.camera.intrinsics, fx=99.0)
    assert seen_inputs(other).intrinsics == other


def test_nothing_claims_to_be_measured() -> None:
    inputs = seen_inputs()
    camera = NetworkCamera().estimate(inputs, Progress())
    geometry = MeasuredGeometry().measure(inputs, SHOT.estimate, SHOT.objects, Progress())
    for sentence in (camera_sentence(camera, DepthSource.NETWORK), geometry_sentence(geometry, DepthSource.NETWORK)):
        assert sentence
        assert "measured" not in sentence
    assert camera.height_m == pytest.approx(1.5, abs=0.1)
    (table,) = geometry.cuboids
    np.testing.assert_allclose(table.centre[:2], [0.3, 2.6], atol=0.15)


def test_holes_are_filled_from_the_room() -> None:
    inputs = seen_inputs()
    holes = inputs.depth_m.copy()
    holes[:20] = 0.0
    estimate = ArchitectureEstimate(Architecture(SHOT.planes), (), 1.0, RoomSource(RoomMethod.GIVEN))
    found = NetworkDepth().depth(replace(inputs, depth_m=holes), SHOT.objects, SHOT.geometry, estimate, Progress())
    assert found.source == "network"
    np.testing.assert_allclose(found.depth_m[:20], SHOT.inputs.depth_m[:20], rtol=0.05)
    np.testing.assert_array_equal(found.depth_m[60:], SHOT.inputs.depth_m[60:])
    with pytest.raises(ValueError, match="needs depth and normals"):
        NetworkDepth().depth(replace(inputs, normals_camera=None), SHOT.objects, SHOT.geometry, estimate, Progress())
