"""Runs inside Blender's Python: tells what a `.blend` holds, as one line of JSON."""

from __future__ import annotations

import json
import sys

import bpy
from mathutils import Vector

bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
scene = bpy.context.scene
bpy.context.view_layer.update()


def corners(item: object) -> list[list[float]]:
    """World corners of an object's own mesh, or of the mesh below it that carries its scale."""
    own = [item] if item.type == "MESH" else [c for c in item.children if c.get("diorama_mesh")]
    return [list(o.matrix_world @ Vector(c)) for o in own for c in o.bound_box]


camera = scene.camera
found = {
    "collections": {c.name: len(c.objects) for c in scene.collection.children},
    "objects": {o.name: {"id": o["id"], "corners": corners(o)} for o in bpy.data.objects if "id" in o},
    "planes": sorted(o.name for o in bpy.data.objects if "diorama_plane" in o),
    "materials": sorted(m.name for m in bpy.data.materials if m.users),
    "around": bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value,
    "lights": len([o for o in bpy.data.objects if o.type == "LIGHT"]),
    "photo": bool(camera and camera.data.background_images and camera.data.background_images[0].image.packed_file),
    "camera": None if camera is None else [list(row) for row in camera.matrix_world],
    "unpacked": [i.name for i in bpy.data.images if i.source == "FILE" and i.packed_file is None],
}
print("FOUND " + json.dumps(found))
