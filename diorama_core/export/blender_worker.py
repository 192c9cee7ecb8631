"""Runs inside Blender's Python, a process of its own: opens a GLB, and saves it as a `.blend` or renders a picture."""

from __future__ import annotations

import json
import re
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
    lens = camera.data
    _set_camera(bpy.context.scene, camera, k)
    if photo is not None:
        behind = lens.background_images.new()
        behind.image = bpy.data.images.load(photo)
        behind.image.name = "photo"
        behind.alpha = 1.0
        lens.show_background_images = True


def render(job: dict[str, Any]) -> None:
    """Load a GLB with its camera, light it and render it with Cycles.

    Args:
        job: `glb`, `width`, `height`, `fx`, `fy`, `cx`, `cy` (pixels), `samples`, `seed`, and `lights` as rectangles in
            the world of the scene file: `matrix` (4 x 4, local -z is where it shines), `width_m`, `height_m`, `watts`,
            and `portal` where daylight comes in. Either `png`, a picture that is ready to be shown, or `exr` and `npy`,
            linear light; those ask for `outdoors` (`sky`, `sun`, `sun_angle_rad`, `sun_matrix`) and take a `lens`
            (`focus_m`, `aperture_m`).
    """
    import bpy  # Blender's Python has it, ours rarely

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=job["glb"])
    scene = bpy.context.scene
    _set_camera(scene, next(o for o in scene.objects if o.type == "CAMERA"), job)
    _blur(scene.camera.data, job.get("lens"))
    for number, light in enumerate(job["lights"]):
        _add_rectangle(bpy, f"light_{number}", light)
    scene.world = _world(bpy, job.get("outdoors"))
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", job["samples"], job["seed"]
    scene.cycles.use_denoising = True
    scene.render.resolution_percentage = 100
    bpy.app.handlers.render_stats.append(report)
    if "png" in job:
        scene.view_settings.view_transform, scene.view_settings.look = "AgX", "AgX - Medium High Contrast"
        scene.render.image_settings.file_format, scene.render.filepath = "PNG", job["png"]
        bpy.ops.render.render(write_still=True)
        return
    scene.cycles.max_bounces, scene.cycles.diffuse_bounces = 12, 6  # white walls hand daylight on many times
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, scene.render.filepath = "OPEN_EXR", "32", job["exr"]
    bpy.ops.render.render(write_still=True)
    _save_values(bpy, job)


def _set_camera(scene: Any, camera: Any, k: dict[str, Any]) -> None:
    """The size of the pictures, and the lens: the principal point need not be in the middle."""
    scene.camera, lens = camera, camera.data
    scene.render.resolution_x, scene.render.resolution_y = int(k["width"]), int(k["height"])
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = 1.0, k["fx"] / k["fy"]
    lens.sensor_fit, lens.sensor_width, lens.lens = "HORIZONTAL", 36.0, 36.0 * k["fx"] / k["width"]
    lens.shift_x = 0.5 - k["cx"] / k["width"]
    lens.shift_y = (k["cy"] - k["height"] / 2) / k["width"]


def _blur(lens: Any, focus: dict[str, float] | None) -> None:
    if focus is not None:
        lens.dof.use_dof, lens.dof.focus_distance = True, focus["focus_m"]
        # Blender takes its focal length in millimetres of a sensor that is 36 mm wide: a large camera.
        lens.dof.aperture_fstop = lens.lens / 1000 / focus["aperture_m"]


def _add_rectangle(bpy: Any, name: str, light: dict[str, Any]) -> None:
    data = bpy.data.lights.new(name, "AREA")
    data.shape, data.size, data.size_y = "RECTANGLE", light["width_m"], light["height_m"]
    data.energy = light["watts"]
    data.cycles.is_portal = light.get("portal", False)
    _add_lamp(bpy, name, data, light["matrix"])


def _add_lamp(bpy: Any, name: str, data: Any, matrix: list[list[float]]) -> None:
    from mathutils import Matrix  # as bpy

    lamp = bpy.data.objects.new(name, data)
    lamp.matrix_world = Matrix(matrix)
    bpy.context.scene.collection.objects.link(lamp)


def _world(bpy: Any, outdoors: dict[str, Any] | None) -> Any:
    """The sky, or a faint light from everywhere; adds the sun."""
    world = bpy.data.worlds.new("sky" if outdoors else "ambient")
    world.use_nodes = True
    inputs = world.node_tree.nodes["Background"].inputs
    if outdoors is None:
        inputs["Strength"].default_value = 0.15
        return world
    inputs["Strength"].default_value, inputs["Color"].default_value = 1.0, (*outdoors["sky"], 1.0)
    sun = bpy.data.lights.new("sun", "SUN")
    strongest = max(outdoors["sun"])
    if strongest > 0:
        sun.energy, sun.color, sun.angle = (
            strongest,
            [c / strongest for c in outdoors["sun"]],
            outdoors["sun_angle_rad"],
        )
        _add_lamp(bpy, "sun", sun, outdoors["sun_matrix"])
    return world


def _save_values(bpy: Any, job: dict[str, Any]) -> None:
    """The linear picture as an array, its first row on top."""
    import numpy as np

    image = bpy.data.images.load(job["exr"])
    image.colorspace_settings.name = "Non-Color"
    values = np.empty(job["width"] * job["height"] * 4, np.float32)
    image.pixels.foreach_get(values)
    np.save(job["npy"], values.reshape(job["height"], job["width"], 4)[::-1, :, :3])


def report(stats: str, *_: Any) -> None:
    """Tell which sample Cycles is at."""
    match = re.search(r"Sample (\d+)/(\d+)", str(stats))
    if match is not None:
        done, total = int(match.group(1)), int(match.group(2))
        print(f"diorama {done / total:.3f} sample {done} of {total}", flush=True)


if __name__ == "__main__":
    told = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    save(told) if "blend" in told else render(told)
