"""A room in Blender's scene: objects in the frames of the scene file, each under what holds it up."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import bpy
from mathutils import Matrix

from . import transforms
from .transforms import OpenedObject

ID, PART, ROOM = "diorama_id", "diorama_part", "diorama_room"
"""Custom properties: of objects, of everything that belongs to the room, and of the scene."""
_TURN = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
"""The importer turns each shape from glTF's Y up; the nodes of a room are Z up already."""


def objects_by_id(scene: Any) -> dict[str, Any]:
    """The room's objects that are in the scene.

    Raises:
        UnsendableError: one was copied.
    """
    found: dict[str, Any] = {}
    for item in scene.objects:
        if ID in item and found.setdefault(item[ID], item) != item:
            first = found[item[ID]].name
            raise transforms.UnsendableError(
                f"{first} and {item.name} are the same object of the room; delete the copy, and copy it in the editor"
            )
    return found


def world_matrices(scene: Any) -> dict[str, transforms.Matrix]:
    """World matrices of the room's objects, by id."""
    bpy.context.view_layer.update()
    return {i: tuple(tuple(row) for row in o.matrix_world) for i, o in objects_by_id(scene).items()}


def about(scene: Any) -> dict[str, Any] | None:
    """The open room's project, title and version; None where none is open."""
    return dict(json.loads(scene[ROOM])) if ROOM in scene else None


def opened_objects(scene: Any) -> list[OpenedObject]:
    """The room's objects as they were opened."""
    rows = (about(scene) or {"objects": []})["objects"]
    return [OpenedObject(**{**r, "matrix": tuple(map(tuple, r["matrix"])), "size_m": tuple(r["size_m"])}) for r in rows]


def note(scene: Any, project: str, version: str, entries: Iterable[Mapping[str, Any]]) -> None:
    """Keep with the scene which room is open, and how it was.

    Args:
        scene: Blender's.
        project: its name.
        version: that was opened.
        entries: its objects in the scene file.
    """
    rows = [asdict(transforms.opened_object(e)) for e in entries]
    scene[ROOM] = json.dumps({"project": project, "version": version, "objects": rows})


def show(scene: Any, project: str, version: str, glb: bytes) -> None:
    """Put a room into the scene, in place of the one that is there.

    Args:
        scene: Blender's.
        project: its name.
        version: of the room.
        glb: its export.
    """
    remove(o for o in scene.objects if PART in o)
    new = _imported(glb)
    entries = {o["id"]: json.loads(o["diorama"]) for o in new if "diorama" in o and "id" in o}
    shapes = {o.get("diorama_mesh") or o["id"]: o for o in new if o.type == "MESH" and _owner(o) in entries}
    nodes = {o["id"]: o for o in new if o.get("id") in entries}
    worlds = {o: o.matrix_world.copy() for o in new}
    for mesh in {o.data for o in shapes.values()}:
        mesh.transform(_TURN)
    for object_id, item in shapes.items():
        entry = entries[object_id]
        _describe(item, nodes[object_id], entry)
        worlds[item] = Matrix(transforms.matrix_of_entry(entry))
        item.parent = shapes.get((entry["support"] or {}).get("parent"))
    others = [o for o in new if o not in shapes.values() and o.type != "EMPTY"]
    for item in others:
        item.parent = shapes.get(item.get("diorama_light"))
        _set_aside(scene, item)
    kept = [*shapes.values(), *others]
    put({o: worlds[o] for o in kept})
    bpy.data.batch_remove([o for o in new if o not in kept])
    _collect(scene, project, kept)
    note(scene, project, version, [entries[i] for i in shapes])


def put(worlds: Mapping[Any, Any]) -> None:
    """Give objects their world matrices, whatever their parents' are.

    Args:
        worlds: `mathutils.Matrix` by object; parents that are not in it stay where they are.
    """
    for item, world in worlds.items():
        if item.parent is not None:
            above = worlds.get(item.parent, item.parent.matrix_world)
            item.matrix_parent_inverse = above.inverted_safe()
        item.rotation_mode = "XYZ"
        item.matrix_basis = world
    bpy.context.view_layer.update()


def remove(items: Iterable[Any]) -> None:
    """Delete objects and what only they used."""
    gone = list(items)
    data = {o.data for o in gone if o.data is not None}
    materials = {m for d in data for m in getattr(d, "materials", ()) if m is not None}
    images = {n.image for m in materials if m.node_tree for n in m.node_tree.nodes if getattr(n, "image", None)}
    bpy.data.batch_remove(gone)
    for used in (data, materials, images):
        bpy.data.batch_remove([d for d in used if d.users == 0])


def _imported(glb: bytes) -> set[Any]:
    before = set(bpy.data.objects)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "room.glb"
        path.write_bytes(glb)
        # The file's candela are relative to its white; taken for physical ones they are dark in Blender's exposure.
        bpy.ops.import_scene.gltf(filepath=str(path), export_import_convert_lighting_mode="COMPAT")
    bpy.context.view_layer.update()
    return set(bpy.data.objects) - before


def _owner(item: Any) -> str | None:
    return item.get("diorama_mesh") or item.get("id")


def _describe(item: Any, node: Any, entry: Mapping[str, Any]) -> None:
    """Name a shape and give it the properties of its object."""
    name = node.name
    if item is not node:
        node.name = f"{name} node"
        item.name = name
        for key in ("label", "category", "shape", "confidence"):
            item[key] = node[key]
    for key in ("diorama", "diorama_mesh", "bounds", "candidates", "id"):
        item.pop(key, None)
    item[ID] = entry["id"]
    if entry["locked"]:
        item.lock_location = item.lock_rotation = item.lock_scale = (True, True, True)


def _set_aside(scene: Any, item: Any) -> None:
    """What cannot be sent back cannot be selected; the ceiling would hide the room."""
    item.hide_select = True
    if item.get("role") == "ceiling":
        item.hide_viewport = True
    if item.type == "CAMERA":
        scene.camera = item
        scene.render.resolution_x, scene.render.resolution_y = int(item["width"]), int(item["height"])


def _collect(scene: Any, project: str, items: Iterable[Any]) -> None:
    """Put objects into the room's own collection."""
    name = f"Diorama {project}"
    collection = scene.collection.children.get(name)
    if collection is None:
        collection = bpy.data.collections.new(name)
        scene.collection.children.link(collection)
    for item in items:
        for other in item.users_collection:
            other.objects.unlink(item)
        collection.objects.link(item)
        item[PART] = project
