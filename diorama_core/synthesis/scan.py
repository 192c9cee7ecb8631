"""A furnished room as a phone with a depth sensor scans it, in the files of 3D Scanner App.

The phone is turned round in some places of the room. Doors and windows cut their walls; clear glass reflects nothing to
the sensor, which then sees what is behind, or nothing.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float32, UInt8
from PIL import Image

from diorama_core.geometry.openings import with_openings
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.appearance import Surface
from diorama_core.render.raycast import PinholeView, pixel_centres
from diorama_core.render.world import CLEAR, World, place_surfaces
from diorama_core.scene.types import Camera, Intrinsics, Scene
from diorama_core.synthesis.cameras import level_pose, sample_cameras
from diorama_core.synthesis.truth import Studio

DEPTH_SIZE = (192, 144)
PHOTO_SIZE = (480, 360)
FOV_RAD = 1.1
"""Across."""
PITCHES_RAD = (0.45, -0.15, 0.15, -0.5)
"""Downward, in turn: the phone sees the floor, the walls and the ceiling."""
NOISE_M = 0.004
FARTHEST_M = 5.0
"""Range of the sensor."""
UNSURE_SHARE = 0.05
"""Share of pixels whose depth is wrong and which the sensor says so of."""
GLASS_ROUGHNESS = 0.1
"""Panes are smoother, and no metal."""
Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])
"""From +Z up to ARKit's +Y up."""
OPENGL_FROM_OPENCV = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class SyntheticFrame:
    """One picture of a scan."""

    camera: Camera
    """In the room; its intrinsics are the photo's."""
    depth_m: Float32[np.ndarray, "h w"]
    """Along the viewing axis; 0 where the sensor saw nothing."""
    sure: UInt8[np.ndarray, "h w"]
    """How sure the sensor is, 0 to 2."""
    photo: UInt8[np.ndarray, "hp wp 3"] | None


def scan(
    scene: Scene, library: ShapeLibrary, seed: int, *, places: int = 4, turns: int = 10
) -> tuple[SyntheticFrame, ...]:
    """The frames of a scan.

    Args:
        scene: a furnished room, +Z up, the floor at 0.
        library: has its shapes.
        seed: of the places and of the noise.
        places: where the phone is turned round.
        turns: frames in each place.

    Raises:
        SceneError: nobody could stand in the room.
    """
    rng = np.random.default_rng((seed, 20))
    focal = 0.5 * PHOTO_SIZE[0] / float(np.tan(FOV_RAD / 2))
    k = Intrinsics(*PHOTO_SIZE, focal, focal, PHOTO_SIZE[0] / 2, PHOTO_SIZE[1] / 2)
    solid = _what_reflects(scene, library)
    studio = Studio(scene, library)
    frames = []
    for place, stand in enumerate(sample_cameras(scene, library, seed, places)):
        for turn in range(turns):
            yaw = 2 * np.pi * (turn + place / places) / turns
            camera = Camera(k, level_pose(stand.position, yaw, PITCHES_RAD[turn % len(PITCHES_RAD)]))
            depth = _depth(solid, Camera(k.resize(*DEPTH_SIZE), camera.T_world_camera))
            depth = np.where(depth > 0, depth + rng.normal(0.0, NOISE_M, depth.shape), 0.0)
            unsure = rng.random(depth.shape) < UNSURE_SHARE
            depth = np.where(unsure, depth * rng.uniform(0.5, 0.95, depth.shape), depth).astype(np.float32)
            photo = studio.photograph(camera, PHOTO_SIZE)[0]
            frames.append(SyntheticFrame(camera, depth, np.where(unsure, 0, 2).astype(np.uint8), photo))
    return tuple(frames)


def write_scan(folder: Path, frames: Sequence[SyntheticFrame]) -> Path:
    """Write frames as 3D Scanner App's "all data"; returns the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, frame in enumerate(frames):
        k = frame.camera.intrinsics
        millimetres = np.clip(np.round(frame.depth_m * 1000.0), 0, 65535).astype(np.uint16)
        Image.fromarray(millimetres).save(folder / f"depth_{number:05d}.png")
        Image.fromarray(frame.sure).save(folder / f"conf_{number:05d}.png")
        if frame.photo is not None:
            Image.fromarray(frame.photo).save(folder / f"frame_{number:05d}.jpg", quality=92)
        T = Y_UP @ frame.camera.T_world_camera @ OPENGL_FROM_OPENCV
        K = [k.fx, 0.0, k.cx, 0.0, k.fy, k.cy, 0.0, 0.0, 1.0]
        row = {"cameraPoseARFrame": T.ravel().tolist(), "intrinsics": K}
        (folder / f"frame_{number:05d}.json").write_text(json.dumps(row))
    return folder


def _what_reflects(scene: Scene, library: ShapeLibrary) -> World:
    """Everything but clear glass, walls with their openings."""
    placed = place_surfaces(with_openings(scene), library)
    return World([replace(p, surfaces=tuple(s for s in p.surfaces if not _is_glass(s))) for p in placed])


def _is_glass(surface: Surface) -> bool:
    m = surface.material
    return m.alpha <= CLEAR or (m.roughness < GLASS_ROUGHNESS and m.metallic == 0.0)


def _depth(world: World, camera: Camera) -> Float32[np.ndarray, "h w"]:
    k = camera.intrinsics
    rays = PinholeView(camera).rays(pixel_centres(k.width, k.height))
    distance = world.caster.first_hits(rays).distance
    return np.where(distance < FARTHEST_M, distance, 0.0).astype(np.float32)
