"""Metric cuboids on real photos, from camera to supports."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.projection import box_iou, visible_bounds
from diorama_core.perception.camera.estimate import EmbeddedCamera
from diorama_core.perception.masks import EmbeddedMasks
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.progress import Progress
from tests.conftest import PhotoEntry

USUAL_HEIGHTS_M = {"chair": (0.6, 1.25), "table": (0.33, 1.1), "sofa": (0.6, 1.2), "door": (1.8, 2.3)}
USUAL_WIDTHS_M = {"sofa": (0.7, 3.1), "bed": (0.9, 2.3)}
"""Armchairs are called sofas too; usual ones are 0.75 m wide."""


@pytest.mark.parametrize("name", ["im3d_3", "scenegen_00002"])
def test_cuboids_explain_the_boxes_with_plausible_sizes(name: str, photos: list[PhotoEntry]) -> None:
    inputs = next(p for p in photos if p.id == name).inputs
    camera = EmbeddedCamera().estimate(inputs, Progress())
    objects = EmbeddedMasks().segment(inputs, Progress())
    geometry = SingleViewMetrology().measure(inputs, camera, objects, Progress())
    corners = np.array([geometry.camera.to_camera(c.corners_world) for c in geometry.cuboids])
    bounds, _ = visible_bounds(corners, geometry.camera.intrinsics)
    # Cuboids are larger in the picture than the things in them, whose outlines do not reach the corners.
    assert box_iou(bounds, np.array([o.box for o in objects])).mean() >= 0.7
    assert 0.6 < geometry.camera.position[2] < 2.0
    for item, cuboid in zip(objects, geometry.cuboids, strict=True):
        low, high = USUAL_HEIGHTS_M.get(item.category, (0.0, 3.0))
        assert low <= cuboid.size_m[2] <= high
        low, high = USUAL_WIDTHS_M.get(item.category, (0.0, 4.0))
        assert low <= max(cuboid.size_m[:2]) <= high
