"""The photo-real path: the same room and camera through Blender's Cycles, where its Python module is installed."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_core.errors import SceneError, UnavailableError
from diorama_core.evaluation.dataset.finishes import finish_textures
from diorama_core.export.gltf import write_glb
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Scene


def cycles_picture(
    scene: Scene, library: ShapeLibrary, *, samples: int = 64, seed: int = 0, timeout_s: float = 1800.0
) -> UInt8[np.ndarray, "h w 3"]:
    """A path-traced picture of a scene from its own camera; minutes on a processor.

    Args:
        scene: A truth scene with its camera (`TruthView.scene`); planes named after finishes get their pictures.
        library: Where its shapes are.
        samples: Paths per pixel before the denoiser.
        seed: Of the paths.
        timeout_s: When to give up.

    Raises:
        UnavailableError: when Blender's module is not installed, or fails.
        SceneError: when the scene has no camera.
    """
    if scene.camera is None:
        raise SceneError("the scene has no camera; render a truth view's scene")
    if find_spec("bpy") is None:
        raise UnavailableError("Cycles needs Blender's module; install it with: pip install 'diorama[cycles]'")
    k = scene.camera.intrinsics
    planes = tuple(replace(p, texture=p.id) for p in scene.architecture.planes)
    named = replace(scene, architecture=replace(scene.architecture, planes=planes))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_glb(named, library, folder / "room.glb", textures=finish_textures(scene.architecture))
        job = {
            "glb": str(folder / "room.glb"), "png": str(folder / "room.png"), "width": k.width, "height": k.height,
            "samples": samples, "seed": seed, "lights": _lights(scene),
        }  # fmt: skip
        (folder / "job.json").write_text(json.dumps(job))
        worker = [sys.executable, "-m", "diorama_core.evaluation.dataset.cycles_worker", str(folder / "job.json")]
        try:
            done = subprocess.run(worker, capture_output=True, text=True, timeout=timeout_s, check=False)
        except subprocess.TimeoutExpired:
            raise UnavailableError(f"Cycles took more than {timeout_s:g} s; ask for fewer samples") from None
        if done.returncode or not (folder / "room.png").is_file():
            last = done.stderr.strip().splitlines()[-1:] or ["no message"]
            raise UnavailableError(f"Cycles failed: {last[0]}")
        return np.asarray(Image.open(folder / "room.png").convert("RGB"))


def _lights(scene: Scene) -> list[dict[str, object]]:
    """A rectangle before every window, shining inward, and a broad one under the ceiling."""
    lights = []
    for item in scene.objects:
        if item.category == "window":
            R = item.pose.R_world_object
            centre = item.pose.position + R[:, 0] * (item.size_m[0] / 2 + 0.02)
            wide, tall = float(item.size_m[1]), float(item.size_m[2])
            lights.append(_rectangle(-R[:, 0], R[:, 1], centre, wide, tall, 60 * wide * tall))
    corners = np.concatenate([p.polygon for p in scene.architecture.planes])
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = np.array([*(low + high)[:2] / 2, high[2] - 0.03])
    wide, deep = (float(v) for v in 0.5 * (high - low)[:2])
    lights.append(_rectangle(np.eye(3)[2], np.eye(3)[0], middle, wide, deep, 30 * wide * deep))
    return lights


def _rectangle(
    away: np.ndarray, across: np.ndarray, centre: np.ndarray, width_m: float, height_m: float, watts: float
) -> dict[str, object]:
    """A light whose local x is `across` and which shines against `away`."""
    T = np.eye(4)
    T[:3, :3] = np.stack([across, np.cross(away, across), away], axis=1)
    T[:3, 3] = centre
    return {"matrix": T.tolist(), "width_m": width_m, "height_m": height_m, "watts": float(watts)}
