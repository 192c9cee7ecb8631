"""Rooms with exactly known geometry, painted and measured by ray casting, for tests."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.artefacts import (
    CameraEstimate,
    CameraHypothesis,
    Cuboid,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    Photo,
)
from diorama_core.geometry.casting import camera_rays, cast_box, cast_planes
from diorama_core.provenance import CameraSource, ScaleSource
from diorama_core.scene.types import Camera, Intrinsics, Plane, Support, yaw_rotation

PALETTE = np.array(
    [[150, 110, 80], [205, 205, 215], [185, 200, 175], [225, 205, 180], [245, 245, 245], [170, 160, 200]]
)


def look(yaw_deg: float = 0.0, pitch_deg: float = 15.0, height_m: float = 1.5, fov_deg: float = 62.0, size=(640, 480)):
    """A level camera over the origin; yaw turns from +Y to the left, pitch looks down."""
    yaw, pitch = np.deg2rad([yaw_deg, pitch_deg])
    forward_level = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    c, s = np.cos(pitch), np.sin(pitch)
    tilt = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
    T = np.eye(4)
    T[:3, :3] = yaw_rotation(yaw) @ forward_level @ tilt
    T[2, 3] = height_m
    return Camera(Intrinsics.from_fov(*size, np.deg2rad(fov_deg)), T)


def wall(name: str, start, end, top: float) -> Plane:
    """A wall from `start` to `end` (left to right seen from inside)."""
    (ax, ay), (bx, by) = start, end
    return Plane(name, "wall", np.array([[ax, ay, 0], [bx, by, 0], [bx, by, top], [ax, ay, top]], dtype=float))


def floor(*corners) -> Plane:
    """A floor with the given corners, counter-clockwise from above."""
    return Plane("floor", "floor", np.array([[x, y, 0.0] for x, y in corners]))


def box_room(x0: float, x1: float, y1: float, top: float, y0: float = -3.0) -> tuple[Plane, ...]:
    """Floor, back, left and right wall, ceiling."""
    return (
        floor((x0, y0), (x1, y0), (x1, y1), (x0, y1)),
        wall("back", (x0, y1), (x1, y1), top),
        wall("left", (x0, y0), (x0, y1), top),
        wall("right", (x1, y1), (x1, y0), top),
        Plane("ceiling", "ceiling", np.array([[x0, y0, top], [x0, y1, top], [x1, y1, top], [x1, y0, top]])),
    )


def cuboid(name: str, centre, size, yaw_deg: float = 0.0) -> Cuboid:
    """A cuboid whose bottom centre is at `centre` (x, y, base z)."""
    size = np.asarray(size, dtype=float)
    middle = np.asarray(centre, dtype=float) + np.array([0, 0, 0.5 * size[2]])
    return Cuboid(name, yaw_rotation(np.deg2rad(yaw_deg)), middle, size, 1.0)


@dataclass(frozen=True)
class Shot:
    """A picture of a room with everything known about it."""

    inputs: Inputs
    camera: Camera
    planes: tuple[Plane, ...]
    cuboids: tuple[Cuboid, ...]
    objects: tuple[DetectedObject, ...]

    @property
    def geometry(self) -> ObjectGeometry:
        """What a perfect metrology would have found."""
        supports = tuple(Support(c.object_id, "floor") for c in self.cuboids)
        return ObjectGeometry(self.camera, self.cuboids, supports, ScaleSource.GIVEN)

    @property
    def estimate(self) -> CameraEstimate:
        """What a perfect camera stage would have found."""
        best = CameraHypothesis(self.camera.intrinsics, self.camera.T_world_camera[:3, :3], 1.0)
        return CameraEstimate((best,), 1.0, CameraSource.exact(), float(self.camera.position[2]))


def shoot(camera: Camera, planes, cuboids=(), categories=(), noise: float = 0.0, seed: int = 0) -> Shot:
    """Paint and measure a room; each face of a cuboid has its own shade, planes carry a faint grain."""
    rng = np.random.default_rng(seed)
    origin, rays = camera_rays(camera)
    depth, which = cast_planes(origin, rays, tuple(planes), slack_m=0.002)
    rgb = PALETTE[which % len(PALETTE)].astype(float)
    instances = np.zeros(depth.shape, np.int32)
    for index, item in enumerate(cuboids, 1):
        window = _window(camera, item)
        t, normals = cast_box(origin, rays[window], item.R_world_object, item.centre, item.size_m)
        nearer = t < depth[window]
        shade = 60 + 50 * np.abs(normals @ np.array([0.3, 0.6, 1.0]))
        colour = np.array([1.0, 0.5 + 0.1 * (index % 5), 0.4]) * shade[..., None]
        for picture, value in ((rgb, colour), (depth, t), (instances, np.full(t.shape, index))):
            picture[window][nearer] = value[nearer]
    rgb = (rgb + rng.normal(0, 3, rgb.shape)).clip(0, 255).astype(np.uint8)
    measured = np.where(np.isfinite(depth), depth * (1 + noise * rng.standard_normal(depth.shape)), 0.0)
    k = camera.intrinsics
    photo = Photo(rgb, "room", (k.width, k.height))
    inputs = Inputs(photo, instances=instances, depth_m=measured.astype(np.float32), intrinsics=k)
    names = tuple(categories) or ("cabinet",) * len(cuboids)
    objects = tuple(_detected(i, c, n, instances) for i, (c, n) in enumerate(zip(cuboids, names, strict=True), 1))
    return Shot(inputs, camera, tuple(planes), tuple(cuboids), tuple(o for o in objects if o is not None))


def _window(camera: Camera, item: Cuboid) -> tuple[slice, slice]:
    """Rows and columns among which a cuboid is seen; all where it reaches behind the camera."""
    corners = item.corners_world
    if camera.to_camera(corners)[:, 2].min() < 0.05:
        return slice(None), slice(None)
    pixels = camera.project(corners)
    low, high = np.maximum(np.floor(pixels.min(axis=0)) - 1, 0).astype(int), np.ceil(pixels.max(axis=0)) + 1
    columns, rows = (slice(a, max(a, b)) for a, b in zip(low.tolist(), high.astype(int).tolist(), strict=True))
    return rows, columns


def _detected(index: int, item: Cuboid, category: str, instances: np.ndarray) -> DetectedObject | None:
    mask = instances == index
    if not mask.any():
        return None
    rows, columns = np.nonzero(mask)
    box = (float(columns.min()), float(rows.min()), float(columns.max() + 1), float(rows.max() + 1))
    return DetectedObject(item.object_id, category, category, box, mask, index, 1.0)
