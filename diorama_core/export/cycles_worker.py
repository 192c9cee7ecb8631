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
        job: `glb`, `png`, `width`, `height`, `fx`, `fy`, `cx`, `cy` (pixels), `samples`, `seed`, and `lights` as
            rectangles in the world of the scene file: `matrix` (4 x 4, local -z is where it shines), `width_m`,
            `height_m`, `watts`.
    """
    import bpy  # type: ignore[import-not-found,unused-ignore]  # Blender's Python has it, ours rarely
    from mathutils import Matrix  # type: ignore[import-not-found,unused-ignore]  # as bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=job["glb"])
    scene = bpy.context.scene
    scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
    lens = scene.camera.data
    lens.sensor_fit, lens.sensor_width, lens.lens = "HORIZONTAL", 36.0, 36.0 * job["fx"] / job["width"]
    lens.shift_x = 0.5 - job["cx"] / job["width"]
    lens.shift_y = (job["cy"] - job["height"] / 2) / job["width"]
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = 1.0, job["fx"] / job["fy"]
    for number, light in enumerate(job["lights"]):
        data = bpy.data.lights.new(f"light_{number}", "AREA")
        data.shape, data.size, data.size_y = "RECTANGLE", light["width_m"], light["height_m"]
        data.energy = light["watts"]
        lamp = bpy.data.objects.new(f"light_{number}", data)
        lamp.matrix_world = Matrix(light["matrix"])
        scene.collection.objects.link(lamp)
    world = bpy.data.worlds.new("ambient")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.15
    scene.world = world
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", job["samples"], job["seed"]
    scene.cycles.use_denoising = True
    scene.view_settings.view_transform, scene.view_settings.look = "AgX", "AgX - Medium High Contrast"
    scene.render.resolution_x, scene.render.resolution_y = job["width"], job["height"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = job["png"]
    bpy.app.handlers.render_stats.append(report)
    bpy.ops.render.render(write_still=True)


def report(stats: str, *_: Any) -> None:
    """Tell which sample Cycles is at."""
    found = re.search(r"Sample (\d+)/(\d+)", str(stats))
    if found is not None:
        done, total = int(found.group(1)), int(found.group(2))
        print(f"diorama {done / total:.3f} sample {done} of {total}", flush=True)


if __name__ == "__main__":
    render(json.loads(Path(sys.argv[1]).read_text()))
