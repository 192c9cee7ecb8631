"""Random rooms of exactly known geometry, photographed from inside: the hard cases of reconstruction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np

from diorama_core.geometry.casting import camera_rays, cast_box, cast_planes
from diorama_core.geometry.planes import clip_polygon
from diorama_core.scene.types import Camera, Plane
from tests.synthetic_rooms import Shot, cuboid, floor, look, shoot, wall

KINDS = ("box", "l_shape", "slanted", "sloped", "gable", "one_wall", "alcove", "five_walls")
SIZE = (640, 480)
BASELINE_STEPS = 8 * 580 * 0.075
"""Focal length in pixels times baseline in metres, in eighths of a pixel of disparity."""


@dataclass(frozen=True)
class Ceiling:
    """A half-space `normal . p >= offset` that holds the room; its border is a piece of ceiling."""

    normal: tuple[float, float, float]
    offset: float


def flat(height_m: float) -> Ceiling:
    return Ceiling((0.0, 0.0, -1.0), -height_m)


def slope(low_m: float, tilt_deg: float, toward: tuple[float, float], at: tuple[float, float]) -> Ceiling:
    """A ceiling that comes down to `low_m` above `at`, falling in the direction `toward` by `tilt_deg`."""
    direction = np.array(toward) / np.linalg.norm(toward)
    run = np.tan(np.deg2rad(tilt_deg))
    normal = -np.array([*(run * direction), 1.0]) / np.hypot(run, 1.0)
    return Ceiling(tuple(normal), float(normal @ np.array([*at, low_m])))


def open_room(*corners, top: float = 2.6) -> tuple[Plane, ...]:
    """Floor, and walls along corners from left to right seen from inside, without one behind the camera."""
    return (floor(*reversed(corners)), *(wall(f"wall_{k}", a, b, top) for k, (a, b) in enumerate(pairwise(corners), 1)))


L_SHAPE = open_room((-2.2, -3), (-2.2, 4.8), (0.3, 4.8), (0.3, 3), (2.6, 3), (2.6, -3))


def prism(corners, ceilings) -> tuple[Plane, ...]:
    """Floor, walls and ceilings over a footprint given clockwise from above (left to right seen from inside)."""
    corners = np.asarray(corners, dtype=float)
    ground = np.concatenate([corners[::-1], np.zeros((len(corners), 1))], axis=1)
    planes = [Plane("floor", "floor", ground)]
    for number, (a, b) in enumerate(zip(corners, np.roll(corners, -1, axis=0), strict=True), 1):
        polygon = np.array([[*a, 0.0], [*b, 0.0], [*b, 9.0], [*a, 9.0]])
        for c in ceilings:
            polygon = clip_polygon(polygon, np.array(c.normal), c.offset)
        planes.append(Plane(f"wall_{number}", "wall", polygon))
    for number, c in enumerate(ceilings, 1):
        normal = np.array(c.normal)
        height = (c.offset - corners @ normal[:2]) / normal[2]
        polygon = np.concatenate([corners, height[:, None]], axis=1)
        for other in ceilings:
            if other is not c:
                polygon = clip_polygon(polygon, np.array(other.normal), other.offset)
        planes.append(Plane(f"ceiling_{number}", "ceiling", polygon))
    return tuple(planes)


def known_room(kind: str, seed: int) -> tuple[tuple[Plane, ...], Camera]:
    """A room of a kind with everything random about it, and a camera in it, at the origin."""
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    u = rng.uniform
    x0, x1, y0, y1 = -u(1.5, 2.8), u(1.5, 2.8), -u(1.0, 2.0), u(3.2, 5.5)
    top = flat(u(2.3, 2.8))
    yaw, pitch, fov = u(-20, 20), u(3, 20), u(58, 72)
    rectangle = [(x0, y0), (x0, y1), (x1, y1), (x1, y0)]
    if kind == "box":
        footprint, ceilings = rectangle, [top]
        yaw, pitch = u(-40, 40), u(-12, 20)
    elif kind == "l_shape":
        bx, by = u(0.2, 0.8), y1 - u(1.2, 2.0)
        footprint = [(x0, y0), (x0, y1), (bx, y1), (bx, by), (x1 + 0.8, by), (x1 + 0.8, y0)]
        ceilings, yaw = [top], u(-12, 12)
    elif kind == "slanted":
        footprint = [(x0, y0), (x0, y1 - u(0.8, 2.2)), (x1, y1), (x1, y0)]
        ceilings = [top]
    elif kind == "sloped":
        footprint = rectangle
        ceilings = [flat(u(2.4, 2.7)), slope(u(1.0, 1.6), u(30, 50), (1.0, 0.0), (x1, 0.0))]
        yaw, pitch, fov = u(-25, 5), u(-8, 2), u(66, 75)
    elif kind == "gable":
        tilt = u(20, 35)
        footprint = rectangle
        ceilings = [slope(2.0, tilt, (1.0, 0.0), (x1, 0.0)), slope(2.0, tilt, (-1.0, 0.0), (x0, 0.0))]
        yaw, pitch, fov = u(-10, 10), u(-12, -2), u(68, 76)
    elif kind == "one_wall":
        footprint = [(-5.0, y0), (-5.0, y1), (5.0, y1), (5.0, y0)]
        ceilings, yaw, pitch = [flat(3.2)], u(-5, 5), u(8, 18)
    elif kind == "alcove":
        ax, bx, by = x0 + u(0.8, 1.2), x1 - u(0.4, 0.8), y1 + u(0.5, 1.0)
        footprint = [(x0, y0), (x0, y1), (ax, y1), (ax, by), (bx, by), (bx, y1), (x1, y1), (x1, y0)]
        ceilings, yaw, pitch, fov = [top], u(-6, 6), u(2, 12), u(66, 75)
    else:
        cut = u(0.8, 1.4)
        footprint = [(x0, y0), (x0, y1 - cut), (x0 + cut, y1), (x1 - cut, y1), (x1, y1 - cut), (x1, y0)]
        ceilings, yaw, pitch, fov = [top], u(-5, 5), u(2, 12), u(70, 78)
    return prism(footprint, ceilings), look(yaw, pitch, u(1.3, 1.65), fov, SIZE)


def furniture(planes: tuple[Plane, ...], camera: Camera, seed: int, count: int = 20, max_hidden: float = 0.6):
    """Boxes, most of them along the walls, that hide at most a share of the visible feet of the walls."""
    rng = np.random.default_rng([seed, 77])
    feet = visible_feet(planes, camera)
    if len(feet) == 0:
        return ()
    chosen: list = []
    hidden = np.zeros(len(feet), dtype=bool)
    for _ in range(400):
        if len(chosen) == count:
            break
        point, normal = feet[rng.integers(len(feet))].reshape(2, 3)
        w, d, h = rng.uniform([0.2, 0.2, 0.3], [1.0, 0.6, 1.7 if len(chosen) < 4 else 0.9])
        away = d / 2 + 0.02 + (rng.uniform(0.2, 1.5) if rng.random() < 0.4 else 0.0)
        centre = point + normal * away
        if np.linalg.norm(centre[:2]) < 1.2:
            continue
        box = cuboid(f"thing_{len(chosen)}", centre, (d, w, h), np.rad2deg(np.arctan2(normal[1], normal[0])))
        if not _inside(box, planes):
            continue
        covers = hidden | _hides(camera, box, feet[:, :3])
        if covers.mean() <= max_hidden:
            chosen.append(box)
            hidden = covers
    return tuple(chosen)


def visible_feet(planes: tuple[Plane, ...], camera: Camera):
    """Points along the feet of walls in view, with the walls' normals."""
    found = []
    for plane in planes:
        if plane.role != "wall":
            continue
        feet = plane.polygon[plane.polygon[:, 2] < 1e-9][:2]
        points = feet[0] + np.linspace(0.01, 0.99, 80)[:, None] * (feet[1] - feet[0]) + [0, 0, 0.01]
        pixels, depth = camera.project(points), camera.to_camera(points)[:, 2]
        k = camera.intrinsics
        seen = (depth > 0.3) & (pixels > 0).all(axis=1) & (pixels < [k.width, k.height]).all(axis=1)
        nearest = cast_planes(camera.position, points - camera.position, planes)[0]
        found += [[*p, *plane.normal] for p, s in zip(points, seen & (nearest > 0.98), strict=True) if s]
    return np.array(found).reshape(-1, 6)


def _inside(box, planes) -> bool:
    solid = [p for p in planes if p.role != "floor"]
    middle = box.centre
    rays = box.corners_world * 0.999 + middle * 0.001 - middle
    return bool((cast_planes(middle, rays, tuple(solid))[0] > 1.0).all())


def _hides(camera: Camera, box, points):
    t, _ = cast_box(camera.position, points - camera.position, box.R_world_object, box.centre, box.size_m)
    return t < 0.99


def photographed(kind: str, seed: int, *, items: int = 0, noise: float = 0.0) -> Shot:
    """A room of a kind with furniture; relative noise comes with a structured-light sensor's steps of depth."""
    shot = _clean(kind, seed, items)
    if not noise:
        return shot
    depth = shot.inputs.depth_m.astype(float)
    depth *= 1.0 + noise * np.random.default_rng(seed).standard_normal(depth.shape)
    steps = np.round(BASELINE_STEPS / np.maximum(depth, 1e-6))
    coarse = np.where(depth > 0, BASELINE_STEPS / np.maximum(steps, 1.0), 0.0)
    return replace(shot, inputs=replace(shot.inputs, depth_m=coarse.astype(np.float32)))


@cache
def _clean(kind: str, seed: int, items: int) -> Shot:
    planes, camera = known_room(kind, seed)
    return shoot(camera, planes, furniture(planes, camera, seed, items))


def all_rays_hit(planes, camera) -> bool:
    """Whether the room has no gap in the camera's view."""
    origin, rays = camera_rays(camera, 4)
    return bool(np.isfinite(cast_planes(origin, rays, planes)[0]).all())
