"""One engine draws an exported room from the photo's camera. Runs in an environment that has the engine.

    python scripts/engine_pictures.py ENGINE FOLDER PICTURE.png

FOLDER holds `room.xml`, `room.urdf` and `room.blend` with what they refer to, and `camera.json`: width, height, and the
camera's `intrinsics` (fx, fy, cx, cy, in pixels) and `T_world_camera` (x right, y down, z forward).
"""

from __future__ import annotations

import json
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np

SAMPLES = 16


def mujoco(folder: Path, camera: dict[str, Any], out: Path) -> None:
    """MJCF, by its own camera; needs MUJOCO_GL=osmesa without a graphics card."""
    import mujoco
    from PIL import Image

    model = mujoco.MjModel.from_xml_path(str(folder / "room.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    with mujoco.Renderer(model, camera["height"], camera["width"]) as renderer:
        renderer.update_scene(data, camera="photo")
        Image.fromarray(renderer.render()).save(out)


def pybullet(folder: Path, camera: dict[str, Any], out: Path) -> None:
    """URDF, drawn by the processor without shadows. It has no lights, so they are those of MJCF."""
    import pybullet as p
    from PIL import Image

    p.connect(p.DIRECT)
    p.loadURDF(str(folder / "room.urdf"), useFixedBase=True)
    for thing in json.loads((folder / "room_urdf" / "poses.json").read_text())["objects"]:
        w, x, y, z = thing["quaternion_wxyz"]
        p.loadURDF(str(folder / "room_urdf" / thing["file"]), thing["position_m"], [x, y, z, w])
    T, (fx, fy, cx, cy) = np.array(camera["T_world_camera"]), camera["intrinsics"]
    width, height, near, far = camera["width"], camera["height"], 0.05, 50.0
    view = p.computeViewMatrix(T[:3, 3], T[:3, 3] + T[:3, 2], -T[:3, 1])
    left, right, bottom, top = -cx / fx, (width - cx) / fx, (cy - height) / fy, cy / fy
    lens = p.computeProjectionMatrix(*(near * side for side in (left, right, bottom, top)), near, far)
    model = ET.parse(folder / "room.xml")
    around, main = model.find("visual/headlight"), model.find("worldbody/light[@name='main_light']")
    toward = T[:3, 3] if main is None else -np.fromstring(main.get("dir"), sep=" ")
    directed = around.get("diffuse") if main is None else main.get("diffuse")
    light = {
        "lightDirection": toward.tolist(),
        "lightAmbientCoeff": float(around.get("ambient").split()[0]),
        "lightDiffuseCoeff": float(directed.split()[0]),
        "lightSpecularCoeff": 0.0,
        "shadow": 0,
    }
    shown = p.getCameraImage(width, height, view, lens, renderer=p.ER_TINY_RENDERER, **light)[2]
    Image.fromarray(np.reshape(shown, (height, width, 4))[..., :3].astype(np.uint8)).save(out)


def blender(folder: Path, camera: dict[str, Any], out: Path) -> None:
    """The Blender file with its own camera and lights, path traced in the *Standard* view."""
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(folder / "room.blend"))
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.cycles.samples, scene.cycles.use_denoising = SAMPLES, True
    scene.render.resolution_x, scene.render.resolution_y = camera["width"], camera["height"]
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform, scene.render.filepath = "Standard", str(out)
    bpy.ops.render.render(write_still=True)


ENGINES = {"mujoco": mujoco, "pybullet": pybullet, "blender": blender}

if __name__ == "__main__":
    where = Path(sys.argv[2])
    ENGINES[sys.argv[1]](where, json.loads((where / "camera.json").read_text()), Path(sys.argv[3]))
