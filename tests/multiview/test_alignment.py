from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from diorama_core.artefacts import CameraEstimate, CameraHypothesis
from diorama_core.multiview.alignment import PhotoReading, align
from diorama_core.provenance import CameraSource
from diorama_core.scene.types import Camera, rigid
from tests.multiview.rooms import CAMERAS, K, photo


def _readings(G: np.ndarray, scale: float, t: np.ndarray) -> list[PhotoReading]:
    """The made photos in another world, with what the camera stage would read of each."""
    found = []
    for camera in CAMERAS:
        T = rigid(G @ camera.T_world_camera[:3, :3], scale * G @ camera.position + t)
        reading = CameraHypothesis(K, camera.T_world_camera[:3, :3], 1.0)
        estimate = CameraEstimate((reading,), 1.0, CameraSource.exact())
        found.append(PhotoReading(Camera(K, T), estimate, photo(camera)[0].boxes.observations))
    return found


def test_gravity_axes_scale_and_floor_are_found_in_any_world(rng: np.random.Generator) -> None:
    G, scale, t = Rotation.random(rng=rng).as_matrix(), float(np.exp(rng.uniform(-2, 2))), rng.normal(size=3)
    readings = _readings(G, scale, t)
    found = align(readings)
    turned = found.R @ G
    np.testing.assert_allclose(np.abs(turned @ [0, 0, 1]), [0, 0, 1], atol=1e-6)
    assert np.abs(turned @ [1, 0, 0]).max() == pytest.approx(1.0, abs=1e-6), "along a room axis"
    assert found.scale * scale == pytest.approx(1.0, rel=0.12)
    for reading, camera in zip(readings, CAMERAS, strict=True):
        assert abs(found.camera(reading.camera).position[2] - camera.position[2]) < 0.25


def test_metres_and_gravity_that_are_given_are_kept() -> None:
    G = Rotation.from_euler("x", -90, degrees=True).as_matrix()  # +Y up
    found = align(_readings(G, 1.0, np.zeros(3)), metric=True, up=np.array([0.0, 1.0, 0.0]))
    assert found.scale == 1.0
    np.testing.assert_allclose(found.R @ [0.0, 1.0, 0.0], [0, 0, 1], atol=1e-9)
