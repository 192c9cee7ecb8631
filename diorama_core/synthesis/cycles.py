"""The photo-real path: the same room and camera through Blender's Cycles, where its Python module is at hand."""

from __future__ import annotations

import json
import os
import shutil
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
from diorama_core.export.gltf import write_glb
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Scene
from diorama_core.synthesis.finishes import finish_textures

PYTHON_VARIABLE = "DIORAMA_BLENDER_PYTHON"
WINDOW_W_PER_M2 = 45.0
LAMP_W_PER_M2 = 20.0
"""Of the broad light under the ceiling of a room without windows."""
LAMP_BY_DAY_W_PER_M2 = 4.0


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
    python = blender_python()
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
        # -P: Blender's own add-on is called "cycles" too, and must not find the module beside the worker.
        worker = [python, "-P", str(Path(__file__).with_name("cycles_worker.py")), str(folder / "job.json")]
        try:
            done = subprocess.run(worker, capture_output=True, text=True, timeout=timeout_s, check=False)
        except subprocess.TimeoutExpired:
            raise UnavailableError(f"Cycles took more than {timeout_s:g} s; ask for fewer samples") from None
        if done.returncode or not (folder / "room.png").is_file():
            last = done.stderr.strip().splitlines()[-1:] or ["no message"]
            raise UnavailableError(f"Cycles failed: {last[0]}")
        return np.asarray(Image.open(folder / "room.png").convert("RGB"))


def blender_python() -> str:
    """The Python that has Blender's module: named by `DIORAMA_BLENDER_PYTHON`, or this one.

    The module asks for an older numpy than this program, so it usually lives in an environment of its own; the worker
    needs nothing else.

    Raises:
        UnavailableError: when there is none.
    """
    named = os.environ.get(PYTHON_VARIABLE)
    if named and shutil.which(named) is None:
        raise UnavailableError(f"{PYTHON_VARIABLE} names {named}, which cannot be run; name the Python that has bpy")
    if named or find_spec("bpy") is not None:
        return named or sys.executable
    raise UnavailableError(
        "Cycles needs Blender's module in an environment of its own: python3.11 -m venv blender && "
        f"blender/bin/pip install bpy==5.0.1 && export {PYTHON_VARIABLE}=$PWD/blender/bin/python"
    )


def _lights(scene: Scene) -> list[dict[str, object]]:
    """A rectangle before every window, shining inward, and a broad one under the ceiling."""
    lights = []
    for item in scene.objects:
        if item.category == "window":
            R = item.pose.R_world_object
            centre = item.pose.position + R[:, 0] * (item.size_m[0] / 2 + 0.02)
            wide, tall = float(item.size_m[1]), float(item.size_m[2])
            lights.append(_rectangle(-R[:, 0], R[:, 1], centre, wide, tall, WINDOW_W_PER_M2 * wide * tall))
    corners = np.concatenate([p.polygon for p in scene.architecture.planes])
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = np.array([*(low + high)[:2] / 2, high[2] - 0.03])
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
