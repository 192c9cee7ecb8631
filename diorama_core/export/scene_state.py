"""A scene as `scene@1.0.2`, the scene state of SmartScenes that SceneEval and HSSD tooling read.

World: metres, +Z up, front +Y. `transform` is the 4x4 matrix, column by column, from the frame of the model's file
(glTF: +Y up, +Z front) to the world; ids of models are `source.id`. Ended .json, the file is the state alone; ended
.zip it also holds every model as `assets/<id>/<id>.glb` with its description, as SceneEval keeps assets.
Format: https://github.com/smartscenes/sstk/wiki/Scene-State-Format
"""

from __future__ import annotations

import json
import re
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from diorama_core.export.files import Entry, add_entry, whole_file, write_whole
from diorama_core.export.gathering import ExportMesh, ExportObject, ExportScene
from diorama_core.export.gltf_document import GltfDocument, TextureFiles
from diorama_core.export.pictures import OncePerPicture, texture_file
from diorama_core.geometry.wall_lines import DrawnWall, Opening, wall_lines
from diorama_core.library.record import record_of
from diorama_core.progress import SILENT, Progress
from diorama_core.render.appearance import Surface
from diorama_core.scene.types import Plane

SOURCE = "diorama"
"""Prefix of model ids: the asset source."""
ROOM = "room"
R_SHAPE_FILE = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""The frame of the model's file (glTF: +Y up, +Z front) in the shape's (+Z up, +X front)."""


def write_scene_state(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write the state (.json), or the state with its models (.zip), as `Writer` says."""
    path = Path(path)
    text = json.dumps(scene_state(scene), indent=1, allow_nan=False)
    if path.suffix.lower() != ".zip":
        progress.check()
        write_whole(path, text.encode())
        return
    with whole_file(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        add_entry(archive, f"{path.stem}.json", text.encode())
        for name, content in _assets(scene, progress):
            add_entry(archive, name, content)


def scene_state(scene: ExportScene) -> dict[str, Any]:
    """The document."""
    index = {o.id: number for number, o in enumerate(scene.objects)}
    return {
        "format": "sceneState",
        "scene": {
            "version": "scene@1.0.2",
            "id": scene.name,
            "unit": 1.0,
            "up": [0, 0, 1],
            "front": [0, 1, 0],
            "assetSource": [SOURCE],
            "arch": _architecture(scene),
            "object": [_object(scene, o, index) for o in scene.objects],
            "modifications": [],
            **({"camera": _camera(scene)} if scene.camera is not None else {}),
        },
        "selected": [],
    }


def model_id(mesh: ExportMesh) -> str:
    """The model's id without its source: readers split at the one full stop and make file names of the rest."""
    return re.sub(r"[^A-Za-z0-9_-]+", "_", mesh.key)


def _object(scene: ExportScene, item: ExportObject, index: dict[str, int]) -> dict[str, Any]:
    T = item.T_world.copy()
    T[:3, :3] = T[:3, :3] * item.scale @ R_SHAPE_FILE
    supporter = None if item.support is None else item.support.parent
    rotation = Rotation.from_matrix(item.T_world[:3, :3] @ R_SHAPE_FILE)
    return {
        "id": item.id,
        "modelId": f"{SOURCE}.{model_id(scene.meshes[item.mesh])}",
        "index": index[item.id],
        "parentId": item.parent or supporter,
        "parentIndex": index.get(item.parent or "", -1),
        "transform": {
            "rows": 4,
            "cols": 4,
            "data": [float(v) for v in T.T.reshape(-1)],
            "rotation": [float(v) for v in rotation.as_quat(canonical=True)],
            "translation": [float(v) for v in T[:3, 3]],
            "scale": [float(v) for v in R_SHAPE_FILE.T @ item.scale],
        },
        "label": item.item.label,
        "category": item.item.category,
        "supportRelation": None if item.support is None else item.support.relation,
    }


def _architecture(scene: ExportScene) -> dict[str, Any]:
    planes = [p.plane for p in scene.planes]
    walls = wall_lines(planes, [o.item for o in scene.objects], scene.scene)
    flat = [_flat(p) for p in planes if p.role != "wall"]
    elements = [*flat, *(_wall(w) for w in walls)]
    numbers = [n for n, e in enumerate(elements) if e["type"] == "Wall"]
    return {
        "version": "arch@1.0.2",
        "id": f"{scene.name}-arch",
        "up": [0, 0, 1],
        "front": [0, 1, 0],
        "coords2d": [0, 1],
        "scaleToMeters": 1.0,
        "defaults": {
            "Wall": {"depth": 0.05, "extraHeight": 0.0},
            "Floor": {"depth": 0.05},
            "Ceiling": {"depth": 0.05},
        },
        "elements": elements,
        "regions": [{"id": ROOM, "type": "Other", "walls": numbers}],
    }


def _flat(plane: Plane) -> dict[str, Any]:
    return {
        "id": plane.id,
        "type": "Floor" if plane.role == "floor" else "Ceiling",
        "roomId": ROOM,
        "points": [[float(v) for v in p] for p in plane.polygon],
        "depth": plane.thickness,
        "materials": [{"name": "inside", "diffuse": _hex(plane)}],
    }


def _wall(wall: DrawnWall) -> dict[str, Any]:
    """A wall from left to right seen from inside the room, its holes measured from its first point."""
    return {
        "id": wall.plane.id,
        "type": "Wall",
        "roomId": ROOM,
        "height": wall.top_m - wall.bottom_m,
        "depth": wall.plane.thickness,
        "points": [[*(float(v) for v in p), wall.bottom_m] for p in (wall.start, wall.end)],
        "holes": [_hole(o, wall) for o in wall.openings],
        "materials": [{"name": "inside", "diffuse": _hex(wall.plane)}],
    }


def _hole(opening: Opening, wall: DrawnWall) -> dict[str, Any]:
    box = {
        "min": [opening.from_m, opening.bottom_m - wall.bottom_m],
        "max": [opening.to_m, opening.top_m - wall.bottom_m],
    }
    return {"id": opening.id, "type": "Door" if opening.is_door else "Window", "box": box}


def _hex(plane: Plane) -> str:
    return "#" + "".join(f"{round(255 * min(max(c, 0.0), 1.0)):02x}" for c in plane.colour)


def _camera(scene: ExportScene) -> dict[str, Any]:
    camera = scene.camera
    assert camera is not None
    T = camera.T_world_camera
    return {
        "name": "photo",
        "position": [float(v) for v in T[:3, 3]],
        "direction": [float(v) for v in T[:3, 2]],
        "up": [float(-v) for v in T[:3, 1]],
        "vfov": float(np.degrees(camera.intrinsics.vertical_fov_rad)),
        "aspect": camera.intrinsics.width / camera.intrinsics.height,
    }


def _assets(scene: ExportScene, progress: Progress) -> Iterator[Entry]:
    """Each model as a GLB in the usual frame, and what it is, under the names SceneEval looks for."""
    used = {o.mesh: o.item for o in scene.objects}
    texture_files = OncePerPicture(texture_file)
    for number, (key, item) in enumerate(used.items()):
        progress.report(number / len(used), f"writing {item.label}")
        mesh = scene.meshes[key]
        name = f"assets/{model_id(mesh)}"
        yield f"{name}/{model_id(mesh)}.glb", _asset(mesh, texture_files)
        record = record_of(scene.library, item.shape_id)
        said = {"category": item.category, "description": record.caption, "materials": _materials(mesh)}
        yield f"{name}/data.json", json.dumps({"annotations": said}, indent=1).encode()


def _materials(mesh: ExportMesh) -> list[str]:
    return list(dict.fromkeys(s.material.name for s in mesh.surfaces))


def _asset(mesh: ExportMesh, texture_files: TextureFiles) -> bytes:
    document = GltfDocument(generator="Diorama", texture_files=texture_files)
    index = document.add_mesh(mesh.name, tuple(_turn(s, R_SHAPE_FILE) for s in mesh.surfaces))
    node = document.add("nodes", {"name": mesh.name, "mesh": index})
    document.set_scene("scene", node)
    return document.glb()


def _turn(surface: Surface, R: Float[np.ndarray, "3 3"]) -> Surface:
    """The surface in a frame whose axes are the columns of `R`."""
    return replace(
        surface,
        vertices=(surface.vertices @ R).astype(np.float32),
        normals=(surface.normals @ R).astype(np.float32),
    )
