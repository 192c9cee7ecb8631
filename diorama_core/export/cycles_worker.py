"""Runs inside a process of its own, where Blender's Python module may keep its global state: one job, one picture."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any


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
    scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
    _set_lens(scene.camera.data, job)
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = 1.0, job["fx"] / job["fy"]
    for number, light in enumerate(job["lights"]):
        _add_rectangle(bpy, f"light_{number}", light)
    scene.world = _world(bpy, job.get("outdoors"))
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", job["samples"], job["seed"]
    scene.cycles.use_denoising = True
    scene.render.resolution_x, scene.render.resolution_y = job["width"], job["height"]
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


def _set_lens(lens: Any, job: dict[str, Any]) -> None:
    lens.sensor_fit, lens.sensor_width, lens.lens = "HORIZONTAL", 36.0, 36.0 * job["fx"] / job["width"]
    lens.shift_x = 0.5 - job["cx"] / job["width"]
    lens.shift_y = (job["cy"] - job["height"] / 2) / job["width"]
    if "lens" in job:
        lens.dof.use_dof, lens.dof.focus_distance = True, job["lens"]["focus_m"]
        # Blender takes its focal length in millimetres of a sensor that is 36 mm wide: a large camera.
        lens.dof.aperture_fstop = lens.lens / 1000 / job["lens"]["aperture_m"]


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
    render(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8")))
