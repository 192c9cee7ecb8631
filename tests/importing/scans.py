"""Made scans: a furnished room's surfaces as points, in the files that scanners and scanner apps write."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image
from shapely.geometry import Polygon

from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Camera, Intrinsics, yaw_rotation
from diorama_core.synthesis.cameras import level_pose

WIDTH, DEPTH, HEIGHT = 4.2, 3.4, 2.5
TURN = 0.35
"""Of the room against the file's axes (rad)."""


@dataclass(frozen=True)
class Furniture:
    centre: tuple[float, float, float]
    size_m: tuple[float, float, float]


FURNITURE = (
    Furniture((-1.0, 1.2, 0.4), (2.0, 0.9, 0.8)),
    Furniture((1.75, -0.4, 0.95), (0.6, 1.2, 1.9)),
    Furniture((-0.4, -0.6, 0.36), (1.0, 0.6, 0.72)),
)


def room_meshes(*, corner: bool = False) -> list[trimesh.Trimesh]:
    """Floor, ceiling, walls and blocks; with a corner cut out, an L."""
    x, y = WIDTH / 2, DEPTH / 2
    ring = [(-x, -y), (x, -y), (x, y), (-x, y)]
    if corner:
        ring = [(-x, -y), (x, -y), (x, 0.3), (0.6, 0.3), (0.6, y), (-x, y)]
    plan = trimesh.creation.extrude_polygon(Polygon(ring), HEIGHT)
    things = FURNITURE[:1] if corner else FURNITURE
    blocks = [trimesh.creation.box(f.size_m, trimesh.transformations.translation_matrix(f.centre)) for f in things]
    return [plan, *blocks]


@cache
def room_points(corner: bool = False, count: int = 120_000) -> np.ndarray:
    """Points of the surfaces with a millimetre of noise, +Z up, turned, the floor at 12 m above the file's zero."""
    rng = np.random.default_rng(3)
    whole = trimesh.util.concatenate(room_meshes(corner=corner))
    points = np.asarray(trimesh.sample.sample_surface(whole, count, seed=4)[0])
    under = [(np.abs(points[:, :2] - f.centre[:2]) < np.array(f.size_m[:2]) / 2).all(axis=1) for f in FURNITURE]
    points = points[~((points[:, 2] < 0.01) & np.any(under, axis=0))] if not corner else points
    return (points + rng.normal(0, 0.003, points.shape)) @ yaw_rotation(TURN).T + [0.0, 0.0, 12.0]


def cameras(count: int = 10) -> list[Camera]:
    """A phone turned round in two places of the room; +Z up."""
    k = Intrinsics(256, 192, 210.0, 210.0, 128.0, 96.0)
    places = [np.array([0.6, 0.4, 1.5]), np.array([-1.2, -0.9, 1.5])]
    return [
        Camera(k, level_pose(place, 2 * np.pi * n / count, 0.3 if n % 2 else -0.2))
        for place in places
        for n in range(count)
    ]


Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])
"""From +Z up to ARKit's +Y up."""
FROM_OPENCV = np.diag([1.0, -1.0, -1.0, 1.0])


def write_app_scan(folder: Path, app: str) -> Path:
    """Frames as Polycam's raw data or 3D Scanner App's all data hold them; unsure pixels have wrong depth."""
    caster = MeshCaster([(m, np.eye(4)) for m in room_meshes()])
    rng = np.random.default_rng(1)
    for number, camera in enumerate(cameras()):
        depth = caster.buffers(camera).depth_m
        unsure = rng.random(depth.shape) < 0.1
        depth = np.where(unsure, depth * rng.uniform(0.4, 0.9, depth.shape), depth)
        millimetres = Image.fromarray(np.round(depth * 1000).astype(np.uint16))
        T = Y_UP @ camera.T_world_camera @ FROM_OPENCV
        k = camera.intrinsics
        large = {"fx": 4 * k.fx, "fy": 4 * k.fy, "cx": 4 * k.cx, "cy": 4 * k.cy}
        if app == "polycam":
            frames = folder / "keyframes"
            for name in ("depth", "confidence", "cameras"):
                (frames / name).mkdir(parents=True, exist_ok=True)
            millimetres.save(frames / "depth" / f"{1000 + number}.png")
            Image.fromarray(np.where(unsure, 0, 255).astype(np.uint8)).save(
                frames / "confidence" / f"{1000 + number}.png"
            )
            row = {f"t_{i}{j}": float(T[i, j]) for i in range(3) for j in range(4)}
            row |= {"width": 4 * k.width, "height": 4 * k.height, **large}
            (frames / "cameras" / f"{1000 + number}.json").write_text(json.dumps(row))
        else:
            folder.mkdir(parents=True, exist_ok=True)
            millimetres.save(folder / f"depth_{number:05d}.png")
            Image.fromarray(np.where(unsure, 0, 2).astype(np.uint8)).save(folder / f"conf_{number:05d}.png")
            K = [large["fx"], 0, large["cx"], 0, large["fy"], large["cy"], 0, 0, 1]
            row = {"cameraPoseARFrame": T.ravel().tolist(), "intrinsics": K}
            (folder / f"frame_{number:05d}.json").write_text(json.dumps(row))
    return folder
