"""Path-traced pictures: a scene and a camera through Blender's Cycles, where its Python module is at hand."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_core.errors import SceneError
from diorama_core.export.blender import blender_python, run_in_blender
from diorama_core.export.gltf import write_glb
from diorama_core.export.pictures import Picture
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.scene.types import Architecture, Camera, Scene

WINDOW_W_PER_M2 = 45.0
LAMP_W_PER_M2 = 20.0
"""Of the broad light under the ceiling of a room without windows."""
LAMP_BY_DAY_W_PER_M2 = 4.0


def cycles_picture(
    scene: Scene,
    library: ShapeLibrary,
    *,
    camera: Camera | None = None,
    textures: Mapping[str, Picture] | None = None,
    samples: int = 64,
    seed: int = 0,
    timeout_s: float = 1800.0,
    progress: Progress | None = None,
) -> UInt8[np.ndarray, "h w 3"]:
    """A path-traced picture of a scene; a minute or more on a processor.

    Args:
        scene: What to draw; hidden objects are left out.
        library: Where its shapes are.
        camera: Where from; None takes the scene's own. Planes that face away from it are left out.
        textures: Pictures of the planes by `Plane.texture`.
        samples: Paths per pixel before the denoiser.
        seed: Of the paths.
        timeout_s: When to give up.
        progress: Told which sample it is at; a cancel ends Blender.

    Raises:
        UnavailableError: when Blender's module is not installed, or fails.
        SceneError: when there is no camera.
        Cancelled: when asked to stop.
    """
    camera = camera or scene.camera
    if camera is None:
        raise SceneError("the scene has no camera; choose a view such as front or orbit:30")
    blender_python()
    k = camera.intrinsics
    seen = replace(scene, camera=camera, architecture=facing(scene, camera))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_glb(seen, library, folder / "room.glb", textures=textures)
        job = {
            "glb": str(folder / "room.glb"), "png": str(folder / "room.png"), "width": k.width, "height": k.height,
            "fx": k.fx, "fy": k.fy, "cx": k.cx, "cy": k.cy, "samples": samples, "seed": seed,
            "lights": room_lights(scene),
        }  # fmt: skip
        worker = Path(__file__).with_name("cycles_worker.py")
        run_in_blender(worker, job, name="Cycles", progress=progress, timeout_s=timeout_s)
        with Image.open(folder / "room.png", formats=("PNG",)) as drawn:
            return np.asarray(drawn.convert("RGB"))


def facing(scene: Scene, camera: Camera) -> Architecture:
    """The planes whose inner face the camera sees: from outside one looks into the room."""
    planes = scene.architecture.planes
    return Architecture(tuple(p for p in planes if float((camera.position - p.centre) @ p.normal) > 0))


def room_lights(scene: Scene) -> list[dict[str, object]]:
    """Area lights for Blender: a rectangle before every window, shining inward, and a broad one under the ceiling."""
    lights = []
    for item in scene.objects:
        if item.category == "window":
            R = item.pose.R_world_object
            centre = item.pose.position + R[:, 0] * (item.size_m[0] / 2 + 0.02)
            wide, tall = float(item.size_m[1]), float(item.size_m[2])
            lights.append(_rectangle(-R[:, 0], R[:, 1], centre, wide, tall, WINDOW_W_PER_M2 * wide * tall))
    corners = [p.polygon for p in scene.architecture.planes] or [o.corners_world for o in scene.objects]
    low, high = np.concatenate(corners).min(axis=0), np.concatenate(corners).max(axis=0)
    middle = np.array([*(low + high)[:2] / 2, max(high[2] - 0.03, low[2] + 2.2)])
    wide, deep = (float(v) for v in 0.5 * (high - low)[:2])
    power = LAMP_BY_DAY_W_PER_M2 if lights else LAMP_W_PER_M2
    lights.append(_rectangle(np.eye(3)[2], np.eye(3)[0], middle, wide, deep, power * wide * deep))
    return lights


def _rectangle(
    away: np.ndarray, across: np.ndarray, centre: np.ndarray, width_m: float, height_m: float, watts: float
) -> dict[str, object]:
    """A light whose local x is `across` and which shines against `away`."""
    T = np.eye(4)
    T[:3, :3] = np.stack([across, np.cross(away, across), away], axis=1)
    T[:3, 3] = centre
    return {"matrix": T.tolist(), "width_m": width_m, "height_m": height_m, "watts": float(watts)}
