"""A scene as one GLB file: metres, Y up, a named node per object under its supporter, identical shapes shared.

The world (+Z up) hangs under a root node that turns it to glTF's Y up, so that every node below keeps the numbers of
the scene file. Below the root are three branches: the architecture, the objects, and the photo's camera. The root's
`extras` carry the whole scene document and where it came from, each object's `extras` its own entry, so that a file can
be read back even after other programs moved or deleted nodes. `docs/export.md` describes them.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import UInt8

from diorama_core.export.files import whole_file
from diorama_core.export.gathering import (
    EVERYTHING,
    ExportObject,
    ExportOptions,
    ExportPlane,
    ExportScene,
    T_world_lens,
    gather,
    rigid_inverse,
    shift,
)
from diorama_core.export.gltf_document import GltfDocument, placement
from diorama_core.export.lights import ExportLight
from diorama_core.export.sharing import unique_name
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.schema import scene_to_json
from diorama_core.scene.types import Camera, Scene

Textures = Mapping[str, UInt8[np.ndarray, "_ _ _"]]
_HALF_TURN = float(np.sqrt(0.5))
_WIDEST_CONE_RAD = 1.5


def write_glb(
    scene: Scene,
    library: ShapeLibrary,
    path: Path,
    *,
    textures: Textures | None = None,
    options: ExportOptions = EVERYTHING,
) -> None:
    """Write the scene as a GLB file, whole or not at all.

    Args:
        scene: What to write; hidden objects are left out.
        library: Where its shapes are.
        path: The file; an existing one is replaced.
        textures: Pictures of the planes by `Plane.texture`.
        options: What of the scene is written.

    Raises:
        ExportError: when the file cannot be written.
        LibraryError: when a shape is missing.
    """
    write_gathered(gather(scene, library, textures=textures, options=options, name=Path(path).stem), Path(path))


def glb_bytes(
    scene: Scene,
    library: ShapeLibrary,
    *,
    textures: Textures | None = None,
    options: ExportOptions = EVERYTHING,
) -> bytes:
    """The scene as the content of a GLB file; see `write_glb`.

    Args:
        scene: As it is.
        library: Where shapes come from.
        textures: Pictures by name.
        options: Of the export.
    """
    return _document(gather(scene, library, textures=textures, options=options), Progress()).glb()


def write_gathered(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write a gathered scene as a GLB file, whole or not at all; raises `ExportError`."""
    document = _document(gathered, progress)
    with whole_file(path) as temporary, temporary.open("wb") as file:
        document.write(file)


def _document(gathered: ExportScene, progress: Progress) -> GltfDocument:
    document = GltfDocument(generator="Diorama", compression=gathered.options.compression)
    return _Builder(gathered, document, progress).build()


class _Builder:
    """Adds a gathered scene to a document."""

    def __init__(self, gathered: ExportScene, document: GltfDocument, progress: Progress) -> None:
        self._gathered = gathered
        self._document = document
        self._progress = progress
        self._meshes: dict[str, int] = {}
        names = [o.name for o in gathered.objects] + [p.name for p in gathered.planes]
        self._names = {name.casefold() for name in names}
        self._scene_text = scene_to_json(gathered.scene)
        self._entries = {o["id"]: o for o in json.loads(self._scene_text)["objects"]}

    def build(self) -> GltfDocument:
        planes = self._group([(p.group, self._plane(p)) for p in self._gathered.planes])
        objects = self._group([(o.group, self._object(o)) for o in self._gathered.children_of(None)])
        children = [
            self._branch(name, nodes) for name, nodes in (("architecture", planes), ("objects", objects)) if nodes
        ]
        if self._gathered.camera is not None:
            children.append(self._camera(self._gathered.camera))
        children += self._room_lights()
        root: dict[str, Any] = {
            "name": self._unique("diorama"),
            "rotation": [-_HALF_TURN, 0.0, 0.0, _HALF_TURN],
            "extras": {
                "units": "metres",
                "world_up": "+Z below this node, +Y above it",
                "diorama": self._scene_text,
                "diorama_objects": json.dumps([o.id for o in self._gathered.objects]),
                "provenance": dict(self._gathered.provenance),
            },
        }
        if self._gathered.photo_text is not None:
            root["extras"]["diorama_photo"] = self._gathered.photo_text
        if children:
            root["children"] = children
        node = self._document.add("nodes", root)
        self._document.set_scene(self._gathered.name, node)
        return self._document

    def _unique(self, name: str) -> str:
        return unique_name(name, self._names)

    def _group(self, nodes: Sequence[tuple[tuple[str, ...], int]]) -> list[int]:
        """The nodes of a home below a node a storey, and below it a node a room."""
        grouped = [node for group, node in nodes if not group]
        for name in dict.fromkeys(group[0] for group, _ in nodes if group):
            inside = [(group[1:], node) for group, node in nodes if group[:1] == (name,)]
            grouped.append(self._branch(name, self._group(inside)))
        return grouped

    def _branch(self, name: str, children: list[int]) -> int:
        return self._document.add("nodes", {"name": self._unique(name), "children": children})

    def _mesh(self, key: str) -> int:
        if key not in self._meshes:
            mesh = self._gathered.meshes[key]
            self._progress.report(len(self._meshes) / len(self._gathered.meshes), f"writing {mesh.name}")
            self._meshes[key] = self._document.add_mesh(mesh.name, mesh.surfaces)
        return self._meshes[key]

    def _plane(self, slab: ExportPlane) -> int:
        plane = slab.plane
        extras = {
            "diorama_plane": plane.id,
            "role": plane.role,
            "thickness_m": plane.thickness,
            "confidence": plane.confidence,
            "bounds": self._bounds(slab.mesh),
        }
        return self._document.add("nodes", {"name": slab.name, "mesh": self._mesh(slab.mesh), "extras": extras})

    def _object(self, item: ExportObject) -> int:
        """The object's node: rigid with its mesh below where it carries others, which must not inherit its scale."""
        node: dict[str, Any] = {"name": item.name, **placement(self._gathered.T_parent(item))}
        mesh = {"mesh": self._mesh(item.mesh), "scale": [float(v) for v in item.scale]}
        below = [self._light(item, light) for light in self._gathered.lights_of(item.id)]
        below += [self._object(child) for child in self._gathered.children_of(item.id)]
        if below and not np.allclose(item.scale, 1.0, atol=1e-9):
            name = self._unique(f"{item.name} shape")
            below.insert(0, self._document.add("nodes", {"name": name, **mesh, "extras": {"diorama_mesh": item.id}}))
        else:
            node |= mesh
        node["extras"] = self._extras(item)
        if below:
            node["children"] = below
        return self._document.add("nodes", node)

    def _extras(self, item: ExportObject) -> dict[str, Any]:
        obj, support = item.item, item.support
        extras: dict[str, Any] = {
            "id": obj.id,
            "label": obj.label,
            "category": obj.category,
            "shape": obj.shape_id,
            "size_m": [float(v) for v in obj.size_m],
            "bounds": self._bounds(item.mesh),
            "confidence": obj.confidence,
            "locked": obj.locked,
        }
        if support is not None:
            extras["support"] = {
                "parent": support.parent,
                "relation": support.relation,
                "against": [*support.adheres_to],
            }
        if obj.candidates:
            extras["candidates"] = [{"shape": c.shape_id, "score": c.score} for c in obj.candidates]
        extras["diorama"] = json.dumps(self._entries[obj.id], ensure_ascii=False)
        return extras

    def _bounds(self, key: str) -> list[list[float]]:
        """Corners of a mesh's box in its own frame, by which a reader knows stored integers from a person's scaling."""
        points = [s.vertices for s in self._gathered.meshes[key].surfaces]
        ends = np.min([p.min(axis=0) for p in points], axis=0), np.max([p.max(axis=0) for p in points], axis=0)
        return [[float(v) for v in end] for end in ends]

    def _light(self, item: ExportObject, light: ExportLight) -> int:
        entry: dict[str, Any] = {
            "name": f"{item.name} {light.kind}",
            "type": "point" if light.kind == "lamp" else "spot",
            "color": [float(c) for c in light.colour],
            "intensity": light.candela * self._gathered.strength(light),
        }
        if light.kind == "window":
            entry["spot"] = {"innerConeAngle": 0.0, "outerConeAngle": _WIDEST_CONE_RAD}
        index = self._document.add_light(entry)
        name, T = self._unique(f"{item.name} light"), rigid_inverse(item.T_world) @ light.T_world
        return self._document.add_light_node(name, index, T, extras={"diorama_light": item.id})

    def _room_lights(self) -> list[int]:
        """The main light, and for the light from all sides parallel lights and points within the room, half of it each.

        Programs without shadows show parallel lights evenly; those with shadows keep them out of a closed room.
        """
        main, even, found = self._gathered.main_light, self._gathered.even_light, []
        if main is not None:
            about: dict[str, Any] = {"type": "directional", "color": [float(c) for c in main.colour]}
            about |= {"name": "main light", "intensity": main.lux * self._gathered.strength(main)}
            found.append((self._document.add_light(about), main.T_world, "main light"))
        if even is not None:
            for T in even.T_world:  # three.js aims only the first of nodes that share a light
                about = {"type": "directional", "name": "even light", "intensity": even.lux / 2.0}
                found.append((self._document.add_light(about), T, "even light"))
            about = {"type": "point", "name": "even light", "intensity": even.candela / 2.0}
            point = self._document.add_light(about)
            found += [(point, shift(position), "even light") for position in even.positions]
        return [self._document.add_light_node(self._unique(name), light, T) for light, T, name in found]

    def _camera(self, camera: Camera) -> int:
        """The photo's camera. glTF knows no principal point off the centre, so `extras` keeps the intrinsics."""
        k = camera.intrinsics
        lens = {
            "yfov": 2.0 * float(np.arctan(0.5 * k.height / k.fy)),
            "aspectRatio": (k.width / k.fx) / (k.height / k.fy),
            "znear": 0.01,
        }
        extras = {"width": k.width, "height": k.height, "fx": k.fx, "fy": k.fy, "cx": k.cx, "cy": k.cy}
        index = self._document.add("cameras", {"name": "photo", "type": "perspective", "perspective": lens})
        node = {"name": self._unique("photo camera"), "camera": index, **placement(T_world_lens(camera))}
        return self._document.add("nodes", {**node, "extras": extras})
