"""Runs inside Blender's Python: opens a GLB, sorts it into collections, sets up the camera, and saves a `.blend`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

BRANCHES = {"architecture": "Architecture", "objects": "Objects"}
"""Nodes below the scene's root, and the collections of what hangs below them."""
NEAR_M = 1.0
"""What is nearer holds light from all sides off."""


def save(job: dict[str, Any]) -> None:
    """Open a GLB and save it as a `.blend`.

    Args:
        job: `glb`, `blend`, and where there are any, `camera` (`width`, `height`, `fx`, `fy`, `cx`, `cy`, in pixels)
            and `photo` (a picture's file); `lighting` as the glTF import calls the units of lights; `around` is the
            radiance of the light from all sides.
    """
    import bpy  # Blender's Python has it, ours rarely

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=job["glb"], export_import_convert_lighting_mode=job["lighting"])
    if "around" in job:
        _surroundings(bpy, job["around"])
    print("diorama 0.5 sorting collections", flush=True)
    _collections(bpy)
    camera = next((o for o in bpy.data.objects if o.type == "CAMERA"), None)
    if camera is not None and "camera" in job:
        _camera(bpy, camera, job["camera"], job.get("photo"))
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.unit_settings.system = "METRIC"
    scene.view_settings.view_transform = "Standard"
    bpy.ops.file.pack_all()
    print("diorama 0.9 saving", flush=True)
    bpy.ops.wm.save_as_mainfile(filepath=job["blend"], compress=True)


def _surroundings(bpy: Any, radiance: float) -> None:
    """Light from all sides as Blender has it: the world's, which comes past walls but not past what is near."""
    for light in list(bpy.data.lights):
        if light.name.startswith("even light"):
            bpy.data.lights.remove(light)
    scene, world = bpy.context.scene, bpy.data.worlds.new("World")
    scene.world = world
    colour, strength = world.node_tree.nodes["Background"].inputs[:2]
    colour.default_value, strength.default_value = (1.0, 1.0, 1.0, 1.0), radiance
    world.light_settings.ao_factor, world.light_settings.distance = radiance, NEAR_M
    scene.cycles.use_fast_gi, scene.cycles.fast_gi_method = True, "ADD"


def _collections(bpy: Any) -> None:
    """Architecture, Objects, Lights and Camera, each object in one of them."""
    scene = bpy.context.scene
    made = {}
    for name in ("Architecture", "Objects", "Lights", "Camera"):
        made[name] = bpy.data.collections.new(name)
        scene.collection.children.link(made[name])
    for item in list(bpy.data.objects):
        kinds: dict[str, str] = {"LIGHT": "Lights", "CAMERA": "Camera"}
        collection = kinds.get(item.type) or _branch(item)
        for old in list(item.users_collection):
            old.objects.unlink(item)
        (scene.collection if collection is None else made[collection]).objects.link(item)


def _branch(item: Any) -> str | None:
    """The collection of the branch that an object hangs below; None for the branches themselves and the root."""
    while item.parent is not None and item.parent.parent is not None:
        item = item.parent
        if item.parent.parent is None and item.name in BRANCHES:
            return BRANCHES[item.name]
    return None


def _camera(bpy: Any, camera: Any, k: dict[str, float], photo: str | None) -> None:
    """The photo's lens and size, and the photo behind the view."""
    scene, lens = bpy.context.scene, camera.data
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = int(k["width"]), int(k["height"])
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = 1.0, k["fx"] / k["fy"]
    lens.sensor_fit, lens.sensor_width, lens.lens = "HORIZONTAL", 36.0, 36.0 * k["fx"] / k["width"]
    lens.shift_x = 0.5 - k["cx"] / k["width"]
    lens.shift_y = (k["cy"] - k["height"] / 2) / k["width"]
    if photo is not None:
        behind = lens.background_images.new()
        behind.image = bpy.data.images.load(photo)
        behind.image.name = "photo"
        behind.alpha = 1.0
        lens.show_background_images = True


if __name__ == "__main__":
    save(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8")))
