"""Path-traced pictures: a scene and a camera through Blender's Cycles, where its Python module is at hand."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image

from diorama_core.errors import SceneError
from diorama_core.export.blender import WORKER, blender_python, run_in_blender
from diorama_core.export.gathering import ExportOptions
from diorama_core.export.gltf import write_glb
from diorama_core.export.pictures import Picture
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.types import Architecture, Camera, Scene

WINDOW_W_PER_M2 = 45.0
LAMP_W_PER_M2 = 20.0
"""Power of the broad light under the ceiling of a room without windows."""
LAMP_BY_DAY_W_PER_M2 = 4.0


@dataclass(frozen=True, eq=False)
class LightPortal:
    """A hole in the room's walls through which daylight comes: paths that leave the room are sent there first."""

    centre: Float[np.ndarray, "3"]
    """In the world, metres."""
    inward: Float[np.ndarray, "3"]
    """Unit, horizontal, into the room."""
    width_m: float
    height_m: float


@dataclass(frozen=True, eq=False)
class Outdoors:
    """What lies outside a room: a sky that is equally bright everywhere, and the sun."""

    sky: Float[np.ndarray, "3"]
    """Radiance, W/(m2 sr) in linear red, green and blue."""
    sun: Float[np.ndarray, "3"]
    """Irradiance of a surface that faces it, W/m2."""
    sun_direction: Float[np.ndarray, "3"]
    """Unit, toward the sun."""
    sun_angle_rad: float
    """Across its disc: 0.0093 in a clear sky, more through haze or a net curtain."""
    openings: tuple[LightPortal, ...]


@dataclass(frozen=True)
class CyclesLens:
    """Depth of field."""

    focus_m: float
    """Distance, along the optical axis, of what is sharp."""
    aperture_m: float
    """Diameter of the entrance pupil."""


def cycles_picture(
    scene: Scene,
    library: ShapeLibrary,
    *,
    camera: Camera | None = None,
    textures: Mapping[str, Picture] | None = None,
    samples: int = 64,
    seed: int = 0,
    timeout_s: float = 1800.0,
    progress: Progress = SILENT,
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
    seen = replace(scene, camera=camera, architecture=facing(scene, camera))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        job = _job(seen, library, folder, textures, samples, seed)
        job |= {"png": str(folder / "room.png"), "lights": room_lights(scene)}
        run_in_blender(WORKER, job, name="Cycles", progress=progress, timeout_s=timeout_s)
        with Image.open(folder / "room.png", formats=("PNG",)) as drawn:
            return np.asarray(drawn.convert("RGB"))


def cycles_radiance(
    scene: Scene,
    library: ShapeLibrary,
    outdoors: Outdoors,
    *,
    lens: CyclesLens | None = None,
    textures: Mapping[str, Picture] | None = None,
    samples: int = 256,
    seed: int = 0,
    timeout_s: float = 7200.0,
    progress: Progress = SILENT,
) -> Float[np.ndarray, "h w 3"]:
    """Light that reaches the scene's camera by day: path-traced, linear, before any exposure; minutes on a processor.

    Args:
        scene: What to draw, with its camera; hidden objects are left out, lamps that are on shine.
        library: Where its shapes are.
        outdoors: Sky and sun, and the holes in the walls that they come through.
        lens: Depth of field; None draws everything sharp.

    Returns:
        Radiance, W/(m2 sr) in linear red, green and blue.

    The other arguments and what is raised are those of `cycles_picture`.
    """
    if scene.camera is None:
        raise SceneError("the scene has no camera; give it one")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        job = _job(scene, library, folder, textures, samples, seed)
        portals = [_portal(o) for o in outdoors.openings]
        job |= {"exr": str(folder / "room.exr"), "npy": str(folder / "room.npy"), "lights": portals}
        sun = _rectangle(outdoors.sun_direction, _across(outdoors.sun_direction), np.zeros(3), 1.0, 1.0, 0.0)
        job["outdoors"] = {
            "sky": outdoors.sky.tolist(), "sun": outdoors.sun.tolist(), "sun_angle_rad": outdoors.sun_angle_rad,
            "sun_matrix": sun["matrix"],
        }  # fmt: skip
        if lens is not None:
            job["lens"] = {"focus_m": lens.focus_m, "aperture_m": lens.aperture_m}
        run_in_blender(WORKER, job, name="Cycles", progress=progress, timeout_s=timeout_s)
        return np.load(folder / "room.npy")


def _job(
    scene: Scene,
    library: ShapeLibrary,
    folder: Path,
    textures: Mapping[str, Picture] | None,
    samples: int,
    seed: int,
) -> dict[str, Any]:
    """What the worker is told of a scene and its camera, whose GLB is written in the folder."""
    blender_python()
    assert scene.camera is not None
    k = scene.camera.intrinsics
    write_glb(scene, library, folder / "room.glb", textures=textures, options=ExportOptions(lights="photometric"))
    return {
        "glb": str(folder / "room.glb"), "width": k.width, "height": k.height,
        "fx": k.fx, "fy": k.fy, "cx": k.cx, "cy": k.cy, "samples": samples, "seed": seed,
    }  # fmt: skip


def _portal(opening: LightPortal) -> dict[str, object]:
    """The hole as a light that gives none of its own: it says where daylight comes from."""
    up = np.array([0.0, 0.0, 1.0])
    across = np.cross(up, -opening.inward)
    light = _rectangle(-opening.inward, across, opening.centre, opening.width_m, opening.height_m, 1.0)
    return light | {"portal": True}


def _across(direction: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """A unit vector at right angles to one that is not vertical."""
    across = np.cross([0.0, 0.0, 1.0], direction)
    return across / np.linalg.norm(across)


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
