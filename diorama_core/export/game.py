"""A GLB for game engines: few materials, few triangles, moving parts and convex colliders as nodes of their own.

Metres, +Y up, no node is scaled. An object's origin is the middle of its foot, a moving part's is on its joint's axis;
`extras` say how it moves. The room is one mesh. Plain colours lie together in one picture and share one material.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.errors import ExportError
from diorama_core.export.bodies import PhysicalScene, Points, RigidBody, hull_faces
from diorama_core.export.colliders import physical_scene
from diorama_core.export.files import whole_file
from diorama_core.export.gathering import ExportScene
from diorama_core.export.gltf import placement
from diorama_core.export.gltf_document import GltfDocument
from diorama_core.export.lights import MainLight
from diorama_core.export.palette import GameMaterials
from diorama_core.export.unwrapping import unwrapped
from diorama_core.library.simplify import LARGEST_ERRORS, simplified_triangles
from diorama_core.progress import Progress
from diorama_core.render.appearance import Material, Surface

MAX_TRIANGLES = 3000
"""Of one object: what shows it in a game's usual distance; a keyboard has three times as many."""
ERRORS = (0.15, *LARGEST_ERRORS)
MAX_SHORTER = 0.08
"""Pieces may lose their bevels: without, a keyboard keeps 5,300 triangles."""
Y_UP = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
"""From +Z up to +Y up."""
UNSEEN = Material("collider", (0.2, 0.6, 0.9), alpha=0.3)


def write_game(gathered: ExportScene, path: Path, progress: Progress | None = None) -> None:
    """Write the GLB, whole or not at all; raises `ExportError`."""
    if gathered.options.light_uv and gathered.options.compression == "draco":
        raise ExportError(
            f"{path}: Draco holds one set of texture coordinates; leave out its compression or --light-uv"
        )
    document = _Builder(gathered, progress or Progress()).built()
    with whole_file(path) as temporary, temporary.open("wb") as file:
        document.write(file)


class _Builder:
    """Adds a gathered scene to a document."""

    def __init__(self, gathered: ExportScene, progress: Progress) -> None:
        self._gathered, self._progress = gathered, progress
        self._document = GltfDocument(generator="Diorama", compression=gathered.options.compression)
        self._materials = GameMaterials(gathered.materials)

    def built(self) -> GltfDocument:
        self._progress.report(0.0, "preparing colliders")
        physical = physical_scene(self._gathered)
        nodes = [self._room(physical)] if physical.slabs else []
        for done, body in enumerate(physical.bodies):
            self._progress.report(0.3 + 0.7 * done / len(physical.bodies), f"writing {body.node.name}")
            nodes.append(self._object(body))
        nodes += self._lights()
        root = self._document.add("nodes", {"name": "diorama", **({"children": nodes} if nodes else {})})
        self._document.set_scene(self._document.add("scenes", {"name": self._gathered.name, "nodes": [root]}))
        return self._document

    def _room(self, physical: PhysicalScene) -> int:
        """Planes as one mesh, with a collider for each convex piece."""
        surfaces = [s for p in self._gathered.planes for s in self._gathered.meshes[p.mesh].surfaces]
        pieces = [piece for slab in physical.slabs for piece in slab.pieces]
        return self._node("room", surfaces, np.eye(4), np.eye(4), pieces, [], {"static": True})

    def _object(self, body: RigidBody) -> int:
        """An object above the middle of its foot, its moving parts below it."""
        item, name = body.node, body.node.name
        foot = _shifted(np.array([0.0, 0.0, -0.5 * item.item.size_m[2]]))
        limbs = []
        for moving in body.moving:
            limb, hinge = moving.limb, _shifted(moving.limb.origin)
            about: dict[str, Any] = {
                "joint": limb.kind,
                "axis": _turned(limb.axis),
                "lower": limb.lower,
                "upper": limb.upper,
            }
            surfaces = self._fitting(limb.mesh, item.scale)
            placed = np.linalg.inv(foot) @ limb.T_object_limb @ hinge
            label, extras = f"{name} {limb.name}", {**about, "open": limb.opened}
            limbs.append(self._node(label, surfaces, placed, hinge, moving.parts, [], extras))
        extras = {"id": item.id, "category": item.item.category, "static": not body.free, "mass_kg": body.mass_kg}
        surfaces = self._fitting(item.mesh, item.scale)
        return self._node(name, surfaces, item.T_world @ foot, foot, body.parts, limbs, extras)

    def _fitting(self, key: str, scale: Float[np.ndarray, "3"]) -> list[Surface]:
        """The surfaces of a mesh at an object's scale, with few triangles."""
        mesh = self._gathered.meshes[key]
        share = MAX_TRIANGLES / max(mesh.triangles, 1)
        lighter = mesh.surfaces if share >= 1.0 else [_lighter(s, share) for s in mesh.surfaces]
        return [replace(s, vertices=_single(s.vertices * scale), normals=_normals(s, scale)) for s in lighter]

    def _node(
        self,
        name: str,
        surfaces: Iterable[Surface],
        T_parent: Float[np.ndarray, "4 4"],
        T_pivot: Float[np.ndarray, "4 4"],
        parts: Iterable[Points],
        below: list[int],
        extras: dict[str, Any],
    ) -> int:
        """One node with its mesh, and its colliders below it.

        Args:
            name: Of the node and its mesh.
            surfaces: In the frame of the object, with its scale.
            T_parent: Where the pivot is in the parent's frame.
            T_pivot: Where it is in the object's frame.
            parts: Convex colliders in the object's frame.
            below: Further children.
            extras: What is said of it.
        """
        to_pivot = Y_UP @ np.linalg.inv(T_pivot)
        drawn = self._materials.merged(_moved(s, to_pivot) for s in surfaces)
        if drawn and self._gathered.options.light_uv:
            drawn = tuple(unwrapped(drawn))
        children = [*below]
        for number, part in enumerate(parts if self._gathered.options.engine in ("godot", "unreal") else ()):
            corners, faces = hull_faces(part @ to_pivot[:3, :3].T + to_pivot[:3, 3])
            faces = faces.astype(np.int32)
            hull = Surface(_single(corners), _single(_outward(corners)), faces, UNSEEN)
            label = collider_name(name, number, self._gathered.options.engine)
            children.append(
                self._document.add("nodes", {"name": label, "mesh": self._document.add_mesh(label, (hull,))})
            )
        node: dict[str, Any] = {"name": name, **placement(Y_UP @ T_parent @ Y_UP.T), "extras": extras}
        if drawn:
            node["mesh"] = self._document.add_mesh(name, drawn)
        if children:
            node["children"] = children
        return self._document.add("nodes", node)

    def _lights(self) -> list[int]:
        """Lamps, windows and the photo's main light, in the world."""
        found: list[int] = []
        main = self._gathered.main_light
        for light in (*self._gathered.lights, *(() if main is None else (main,))):
            about: dict[str, Any] = {"color": [float(c) for c in light.colour], "name": "light"}
            if isinstance(light, MainLight):
                about |= {"type": "directional", "intensity": light.lux * self._gathered.strength(light)}
            else:
                about |= {"type": "point", "intensity": light.candela * self._gathered.strength(light)}
            extension = {"KHR_lights_punctual": {"light": self._document.add_light(about)}}
            node = {"name": f"light {len(found) + 1}", **placement(Y_UP @ light.T_world), "extensions": extension}
            found.append(self._document.add("nodes", node))
        return found


def collider_name(name: str, number: int, engine: str) -> str:
    """What an engine's import takes for a convex collider without a picture."""
    return f"UCX_{name}_{number:02d}" if engine == "unreal" else f"{name} {number}-convcolonly"


def _lighter(surface: Surface, share: float) -> Surface:
    triangles = np.ascontiguousarray(surface.faces.reshape(-1), dtype=np.uint32)
    fewer = simplified_triangles(triangles, surface.vertices, share, ERRORS, MAX_SHORTER)
    used, faces = np.unique(fewer, return_inverse=True)
    uv, colours = surface.uv, surface.colours
    return replace(
        surface,
        vertices=surface.vertices[used],
        normals=surface.normals[used],
        faces=faces.reshape(-1, 3).astype(np.int32),
        uv=None if uv is None else uv[used],
        colours=None if colours is None else colours[used],
    )


def _normals(surface: Surface, scale: Float[np.ndarray, "3"]) -> np.ndarray:
    turned = surface.normals / scale
    return _single(turned / np.linalg.norm(turned, axis=1, keepdims=True))


def _moved(surface: Surface, T: Float[np.ndarray, "4 4"]) -> Surface:
    vertices, normals = surface.vertices @ T[:3, :3].T + T[:3, 3], surface.normals @ T[:3, :3].T
    return replace(surface, vertices=_single(vertices), normals=_single(normals))


def _outward(corners: Points) -> Points:
    """Directions from the middle: colliders are not seen, but each vertex needs a normal."""
    away = corners - corners.mean(axis=0)
    return away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)


def _shifted(offset: Float[np.ndarray, "3"]) -> Float[np.ndarray, "4 4"]:
    T = np.eye(4)
    T[:3, 3] = offset
    return T


def _turned(axis: Float[np.ndarray, "3"]) -> list[float]:
    return [float(v) for v in Y_UP[:3, :3] @ axis]


def _single(values: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(values, dtype=np.float32)
