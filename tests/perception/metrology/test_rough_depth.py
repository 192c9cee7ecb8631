"""Rough depth as evidence: it tells the scale where sizes mislead, and pixels that see something else count little."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from diorama_core.artefacts import CameraEstimate, CameraHypothesis, DetectedObject, Inputs, ObjectGeometry, Photo
from diorama_core.geometry.casting import camera_rays, cast_box
from diorama_core.models.seen_depth import SeenDepth
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.perception.metrology.box_observations import observe_depths
from diorama_core.perception.metrology.problem import UNTOLD, View
from diorama_core.progress import Progress
from diorama_core.provenance import CameraSource
from diorama_core.scene.types import Camera, Intrinsics, yaw_rotation
from tests.perception.metrology.test_metrology import ROOM, K, RequestedObject, rotation, seen

R, HEIGHT_M, LARGER = rotation(12.0), 1.5, 1.3
LARGE_ROOM = tuple(
    RequestedObject(
        t.category,
        (LARGER * t.centre[0], LARGER * t.centre[1], LARGER * t.centre[2]),
        (LARGER * t.size[0], LARGER * t.size[1], LARGER * t.size[2]),
        t.yaw,
    )
    for t in ROOM
)


@dataclass(frozen=True)
class KnownDepth:
    """Says a depth that is known."""

    depth_m: np.ndarray

    def predict(self, rgb: np.ndarray, intrinsics: Intrinsics | None) -> SeenDepth:
        assert intrinsics is not None
        sigma = np.full_like(self.depth_m, 0.1)
        return SeenDepth(self.depth_m, np.zeros_like(rgb, np.float32), intrinsics, sigma, 0.1)


def shot(items: tuple[RequestedObject, ...], height_m: float) -> tuple[np.ndarray, tuple[DetectedObject, ...]]:
    """Depth of boxes before a far wall on a floor, and the objects with their masks."""
    pose = np.eye(4)
    pose[:3, :3], pose[2, 3] = R, height_m
    origin, rays = camera_rays(Camera(K, pose))
    depth = np.minimum(np.where(rays[..., 2] < 0, -height_m / rays[..., 2], np.inf), 6.0 * LARGER)
    shown = np.full(depth.shape, -1)
    for k, item in enumerate(items):
        distance = cast_box(origin, rays, yaw_rotation(item.yaw), np.array(item.centre), np.array(item.size))[0]
        shown, depth = np.where(distance < depth, k, shown), np.minimum(distance, depth)
    masked = tuple(replace(o, mask=shown == k) for k, o in enumerate(seen(items, R, height_m)))
    return depth.astype(np.float32), masked


def measured(objects: tuple[DetectedObject, ...], depth: KnownDepth | None) -> ObjectGeometry:
    inputs = Inputs(Photo(np.zeros((K.height, K.width, 3), np.uint8), "synthetic", (K.width, K.height)))
    camera = CameraEstimate((CameraHypothesis(K, R, 0.8),), 0.9, CameraSource.exact())
    return SingleViewMetrology(depth=depth).measure(inputs, camera, objects, Progress())


def test_depth_tells_the_scale_of_a_room_in_which_everything_is_large() -> None:
    depth, objects = shot(LARGE_ROOM, LARGER * HEIGHT_M)
    alone, helped = (measured(objects, network).camera.position[2] for network in (None, KnownDepth(depth)))
    assert alone < 0.87 * LARGER * HEIGHT_M, "sizes alone mislead"
    assert alone + 0.05 < helped < 1.05 * LARGER * HEIGHT_M


def test_depth_tells_how_far_away_an_object_is_that_is_larger_than_its_kind() -> None:
    """A large chair of which the upper half alone is marked looks like a near one of usual size."""
    large = RequestedObject("chair", (-1.3, 4.6, 0.65), (0.85, 0.8, 1.3), 0.0)
    room = (ROOM[0], large, *ROOM[2:])
    depth, objects = shot(room, HEIGHT_M)
    x1, y1, x2, y2 = objects[1].box
    mask = objects[1].mask.copy()
    mask[int((y1 + y2) / 2) :] = False
    cut = (objects[0], replace(objects[1], box=(x1, y1, x2, (y1 + y2) / 2), mask=mask), *objects[2:])
    off = [abs(measured(cut, network).cuboids[1].centre[1] - large.centre[1]) for network in (None, KnownDepth(depth))]
    assert off[0] > 0.5
    assert off[1] < 0.75 * off[0]


def test_the_scale_of_the_depth_hardly_matters_to_where_objects_are() -> None:
    depth, objects = shot(ROOM, HEIGHT_M)
    near, far = (measured(objects, KnownDepth(factor * depth)) for factor in (0.8, 1.25))
    for a, b in zip(near.cuboids, far.cuboids, strict=True):
        scale = near.camera.position[2] / far.camera.position[2]
        np.testing.assert_allclose(a.centre[:2], scale * b.centre[:2], atol=0.15)


def test_objects_without_an_outline_have_no_depth_and_a_marked_picture_no_scale() -> None:
    depth, objects = shot(ROOM, HEIGHT_M)
    view, what = View(K, R), KnownDepth(depth).predict(np.zeros((K.height, K.width, 3), np.uint8), K)
    blank = replace(objects[0], mask=np.zeros_like(objects[0].mask))
    known = observe_depths(what, (blank, *objects[1:]), view)
    assert known is not None
    assert known.log_sigma[0] == UNTOLD
    assert np.exp(known.log_height) == pytest.approx(HEIGHT_M, rel=0.05)
    assert observe_depths(what, (replace(blank, mask=np.ones_like(blank.mask)),), view) is None
