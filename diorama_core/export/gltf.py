"""A scene as one GLB file: metres, Y up, one named node per object, identical shapes shared.

The world (+Z up) hangs under a root node that turns it to glTF's Y up, so that every node below keeps the numbers of
the scene file. Objects carry what the scene knows of them in `extras`.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8
from scipy.spatial.transform import Rotation

from diorama_core.export.files import write_whole
from diorama_core.export.gltf_document import GltfDocument
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.appearance import Paint, shape_surfaces
from diorama_core.render.slabs import plane_surfaces
from diorama_core.scene.types import Camera, Plane, Scene, SceneObject, Support

Textures = Mapping[str, UInt8[np.ndarray, "_ _ _"]]
_HALF_TURN = float(np.sqrt(0.5))
_CAMERA_AXES = np.diag([1.0, -1.0, -1.0])
"""glTF cameras look along their -z with y up; ours along +z with y down."""


def write_glb(scene: Scene, library: ShapeLibrary, path: Path, *, textures: Textures | None = None) -> None:
    """Write the scene as a GLB file, whole or not at all.

    Args:
        scene: What to write; hidden objects are left out.
        library: Where its shapes are.
        path: The file; an existing one is replaced.
        textures: Pictures of the planes by `Plane.texture`.

    Raises:
        ExportError: when the file cannot be written.
        LibraryError: when a shape is missing.
    """
    write_whole(Path(path), glb_bytes(scene, library, textures=textures))


def glb_bytes(scene: Scene, library: ShapeLibrary, *, textures: Textures | None = None) -> bytes:
    """The scene as the content of a GLB file; see `write_glb`."""
    document = GltfDocument(generator="Diorama")
    names = _Names()
    children = [_plane_node(document, plane, textures or {}, names) for plane in scene.architecture.planes]
    meshes: dict[tuple[str, Paint], int] = {}
    for item in scene.objects:
        if not item.hidden:
            mesh = _shape_mesh(document, library, item, meshes)
            children.append(document.add("nodes", _object_node(item, scene.support_of(item.id), mesh, names)))
    if scene.camera is not None:
        children.append(_camera_node(document, scene.camera, names))
    root: dict[str, Any] = {
        "name": names.unique("diorama"),
        "rotation": [-_HALF_TURN, 0.0, 0.0, _HALF_TURN],
        "extras": {"units": "metres", "world_up": "+Z below this node, +Y above it"},
    }
    if children:
        root["children"] = children
    document.set_scene(document.add("scenes", {"name": "scene", "nodes": [document.add("nodes", root)]}))
    return document.glb()


class _Names:
    """Node names, each used once: many programs address nodes by name."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def unique(self, name: str) -> str:
        candidate, number = name, 2
        while candidate in self._taken:
            candidate, number = f"{name} {number}", number + 1
        self._taken.add(candidate)
        return candidate


def _plane_node(document: GltfDocument, plane: Plane, textures: Textures, names: _Names) -> int:
    picture = textures.get(plane.texture) if plane.texture else None
    mesh = document.add_mesh(plane.id, plane_surfaces(plane, picture))
    name = plane.role if plane.id == plane.role else f"{plane.role} {plane.id}"
    extras = {"id": plane.id, "role": plane.role, "confidence": plane.confidence}
    return document.add("nodes", {"name": names.unique(name), "mesh": mesh, "extras": extras})


def _shape_mesh(
    document: GltfDocument, library: ShapeLibrary, item: SceneObject, meshes: dict[tuple[str, Paint], int]
) -> int:
    key = (item.shape_id, (item.colour, item.finish))
    if key not in meshes:
        meshes[key] = document.add_mesh(item.shape_id, shape_surfaces(library, item.shape_id, *key[1]))
    return meshes[key]


def _object_node(item: SceneObject, support: Support | None, mesh: int, names: _Names) -> dict[str, Any]:
    extras: dict[str, Any] = {
        "id": item.id,
        "label": item.label,
        "category": item.category,
        "shape": item.shape_id,
        "size_m": [float(v) for v in item.size_m],
        "locked": item.locked,
    }
    if support is not None:
        extras["support"] = {"parent": support.parent, "relation": support.relation, "against": [*support.adheres_to]}
    name = item.label if item.label == item.id else f"{item.label} ({item.id})"
    placement = _placement(item.pose.R_world_object, item.pose.position)
    return {
        "name": names.unique(name),
        "mesh": mesh,
        **placement,
        "scale": [float(v) for v in item.pose.scale],
        "extras": extras,
    }


def _camera_node(document: GltfDocument, camera: Camera, names: _Names) -> int:
    """The photo's camera. glTF cannot say that the principal point is off centre, so `extras` keeps the intrinsics."""
    k = camera.intrinsics
    lens = {
        "yfov": 2.0 * float(np.arctan(0.5 * k.height / k.fy)),
        "aspectRatio": (k.width / k.fx) / (k.height / k.fy),
        "znear": 0.01,
    }
    extras = {"width": k.width, "height": k.height, "fx": k.fx, "fy": k.fy, "cx": k.cx, "cy": k.cy}
    index = document.add("cameras", {"name": "photo", "type": "perspective", "perspective": lens})
    placement = _placement(camera.T_world_camera[:3, :3] @ _CAMERA_AXES, camera.position)
    return document.add("nodes", {"name": names.unique("photo camera"), "camera": index, **placement, "extras": extras})


def _placement(R: Float[np.ndarray, "3 3"], position: Float[np.ndarray, "3"]) -> dict[str, list[float]]:
    """A node's rotation (glTF quaternions are x, y, z, w) and translation."""
    quaternion = Rotation.from_matrix(R).as_quat(canonical=True)
    return {"rotation": [float(v) for v in quaternion], "translation": [float(v) for v in position]}
