"""Runs inside Blender's Python: installs the add-on from its archive and does what a line of standard input says.

Each line is Python; `answer` of it is written as one line of JSON.
"""

from __future__ import annotations

import json
import sys
import traceback

import bpy

print(
    "installing", bpy.ops.extensions.package_install_files(filepath=sys.argv[1], repo="user_default"), file=sys.stderr
)
bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
names: dict = {"bpy": bpy}


def item(object_id: str) -> object:
    """The object of the room that has this id."""
    return next(o for o in bpy.context.scene.objects if o.get("diorama_id") == object_id)


def corners(object_id: str) -> list[list[float]]:
    """World corners of an object's box, as Blender has evaluated it."""
    from mathutils import Vector

    bpy.context.view_layer.update()
    return [list(item(object_id).matrix_world @ Vector(c)) for c in item(object_id).bound_box]


names |= {"item": item, "corners": corners}
print("READY", flush=True)
for line in sys.stdin:
    names["answer"] = None
    try:
        exec(json.loads(line), names)
        print("ANSWER " + json.dumps(names["answer"]), flush=True)
    except RuntimeError as error:
        print("ANSWER " + json.dumps({"error": str(error).strip()}), flush=True)
    except Exception:
        print("ANSWER " + json.dumps({"error": traceback.format_exc()}), flush=True)
