"""Runs inside a process of its own, where Blender's Python module may keep its global state: one job, one picture."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any


def render(job: dict[str, Any]) -> None:
    """Load a GLB with its camera, light it and render it with Cycles.

    Args:
        job: `glb`, `png`, `width`, `height`, `samples`, `seed`, and `lights` as rectangles in the world of the scene
            file: `matrix` (4 x 4, local -z is where it shines), `width_m`, `height_m`, `watts`.
    """
    import bpy  # type: ignore[import-not-found,unused-ignore]
    from mathutils import Matrix  # type: ignore[import-not-found,unused-ignore]

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=job["glb"])
    scene = bpy.context.scene
    scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
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
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    render(json.loads(Path(sys.argv[1]).read_text()))
