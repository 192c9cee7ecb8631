"""A GLB for game engines: few materials, few triangles, moving parts and convex colliders as nodes of their own.

Metres, +Y up, objects look along their +Z, no node is scaled. An object's origin is the middle of its foot, a moving
part's is on its joint's axis; `extras` say how it moves. The room is one mesh. Plain colours lie together in one
picture and share one material. Levels of detail are nodes outside the scene, as MSFT_lod has them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.errors import ExportError, UnavailableError
from diorama_core.export.bodies import PhysicalScene, Points, RigidBody, hull_faces
from diorama_core.export.colliders import physical_scene
from diorama_core.export.files import whole_file
from diorama_core.export.gathering import ExportObject, ExportScene, shift
from diorama_core.export.gltf_document import GltfDocument, placement
from diorama_core.export.lights import MainLight
from diorama_core.export.palette import GameMaterials
from diorama_core.export.sharing import with_vertices, without_unused
from diorama_core.library.simplify import LARGEST_ERRORS, simplify
from diorama_core.progress import SILENT, Progress
from diorama_core.render.appearance import Material, Surface

COVERAGES = (0.5, 0.25, 0.0)
"""Share of the picture's height down to which each level is shown. At half the height a quarter of the triangles are as
large on the screen as before."""
MAX_SHARE_OF_FINER = 0.7
"""A level with more of the triangles of the one before it saves less than its change of form costs."""
HALVINGS = 6
"""How often the span of budgets is halved: to 2 % of the largest."""
ERRORS = (0.15, *LARGEST_ERRORS)
"""Of the finest level, which keeps to the triangles that were asked for; coarser ones keep their form first."""
MAX_SHORTER = 0.08
"""Pieces may lose their bevels: without, a keyboard keeps 5,300 triangles."""
Y_UP = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
"""From +Z up to +Y up."""
FRONT_Z = np.array([[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
"""From an object's +X front and +Z up to the +Z front and +Y up of glTF, which importers turn to their engine's."""
Levels = Sequence[Sequence[Surface]]
"""Surfaces in full, then of each coarser level."""
UNSEEN = Material("collider", (0.2, 0.6, 0.9), alpha=0.3)


def write_game(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write the GLB, whole or not at all; raises `ExportError`."""
    if gathered.options.light_uv and gathered.options.compression == "draco":
        raise ExportError(
            f"{path}: Draco holds one set of texture coordinates; leave out its compression or --light-uv"
        )
    document = _Builder(gathered, progress).build()
    with whole_file(path) as temporary, temporary.open("wb") as file:
        document.write(file)


class _Builder:
    """Adds a gathered scene to a document."""

    def __init__(self, gathered: ExportScene, progress: Progress) -> None:
        self._gathered, self._progress = gathered, progress
        self._document = GltfDocument(generator="Diorama", compression=gathered.options.compression)
        self._materials = GameMaterials(gathered.materials)
        self._lighter: dict[tuple[str, float, tuple[float, ...]], tuple[Surface, ...]] = {}

    def build(self) -> GltfDocument:
        self._progress.report(0.0, "preparing colliders")
        physical = physical_scene(self._gathered)
        budget = self._budget()
        nodes = [self._room(physical)] if physical.slabs else []
        for done, body in enumerate(physical.bodies):
            self._progress.report(0.3 + 0.7 * done / len(physical.bodies), f"writing {body.node.name}")
            nodes.append(self._object(body, self._share(body.node, budget)))
        nodes += self._lights()
        root = self._document.add("nodes", {"name": "diorama", **({"children": nodes} if nodes else {})})
        self._document.set_scene(self._gathered.name, root)
        return self._document

    def _triangles(self, item: ExportObject, share: float = 1.0) -> int:
        """Triangles of an object with its moving parts, when so many of them are left."""
        keys = (item.mesh, *(limb.mesh for limb in item.limbs))
        return sum(len(s.faces) for key in keys for s in self._mesh(key, share))

    def _budget(self) -> int:
        """Triangles that each object may have, so that it and all together have as many as were asked for.

        Raises:
            ExportError: the shapes would be lost before so few are left.
        """
        most, total = self._gathered.options.max_triangles, self._gathered.options.max_total_triangles
        if total is None or self._total(most) <= total:
            return most
        if (fewest := self._total(0)) > total:
            raise ExportError(
                f"{self._gathered.name}: its shapes keep {fewest} triangles, {total} were asked for; "
                "ask for more or write fewer objects"
            )
        fits = 0
        for _ in range(HALVINGS):
            middle = (fits + most) // 2
            fits, most = (middle, most) if self._total(middle) <= total else (fits, middle)
        return fits

    def _total(self, budget: int) -> int:
        """Triangles of all when each object may have so many."""
        room = sum(self._gathered.meshes[p.mesh].triangles for p in self._gathered.planes)
        return room + sum(self._triangles(item, self._share(item, budget)) for item in self._gathered.objects)

    def _share(self, item: ExportObject, budget: int) -> float:
        return min(budget / max(self._triangles(item), 1), 1.0)

    def _room(self, physical: PhysicalScene) -> int:
        """Planes as one mesh, with a collider for each convex piece."""
        surfaces = [s for p in self._gathered.planes for s in self._gathered.meshes[p.mesh].surfaces]
        pieces = [piece for slab in physical.slabs for piece in slab.pieces]
        return self._node("room", [surfaces], np.eye(4), Y_UP, pieces, [], {"static": True})

    def _object(self, body: RigidBody, share: float) -> int:
        """An object above the middle of its foot, its moving parts below it, with a share of their triangles."""
        item, name = body.node, body.node.name
        foot = shift(np.array([0.0, 0.0, -0.5 * item.item.size_m[2]]))
        limbs = []
        for moving in body.moving:
            limb, hinge = moving.limb, shift(moving.limb.origin)
            about: dict[str, Any] = {
                "joint": limb.kind,
                "axis": [float(v) for v in FRONT_Z[:3, :3] @ limb.axis],
                "lower": limb.lower,
                "upper": limb.upper,
            }
            levels = self._levels(limb.mesh, item.scale, share)
            placed = FRONT_Z @ np.linalg.inv(foot) @ limb.T_object_limb @ hinge @ FRONT_Z.T
            label, extras = f"{name} {limb.name}", {**about, "open": limb.opened}
            to_pivot = FRONT_Z @ np.linalg.inv(hinge)
            limbs.append(self._node(label, levels, placed, to_pivot, moving.parts, [], extras))
        extras = {"id": item.id, "category": item.item.category, "static": not body.free, "mass_kg": body.mass_kg}
        levels = self._levels(item.mesh, item.scale, share)
        placed = Y_UP @ item.T_world @ foot @ FRONT_Z.T
        return self._node(name, levels, placed, FRONT_Z @ np.linalg.inv(foot), body.parts, limbs, extras)

    def _levels(self, key: str, scale: Float[np.ndarray, "3"], share: float) -> Levels:
        """A mesh at an object's scale with a share of its triangles, and with a quarter of them each time it is half
        as high in the picture."""
        levels = [self._mesh(key, share)]
        for level in range(1, 1 if self._gathered.options.engine == "godot" else len(COVERAGES)):
            coarser = self._mesh(key, share / 4**level, LARGEST_ERRORS)
            if _count(coarser) > MAX_SHARE_OF_FINER * _count(levels[-1]):
                break
            levels.append(coarser)
        return [
            [replace(s, vertices=_single(s.vertices * scale), normals=_normals(s, scale)) for s in one]
            for one in levels
        ]

    def _mesh(self, key: str, share: float, errors: tuple[float, ...] = ERRORS) -> tuple[Surface, ...]:
        """The surfaces of a mesh at scale 1 with about this share of their triangles."""
        mesh = self._gathered.meshes[key]
        if share >= 1.0:
            return mesh.surfaces
        wanted = (key, share, errors)
        if wanted not in self._lighter:
            self._lighter[wanted] = tuple(_lighter(s, share, errors) for s in mesh.surfaces)
        return self._lighter[wanted]

    def _node(
        self,
        name: str,
        levels: Levels,
        T_parent: Float[np.ndarray, "4 4"],
        to_pivot: Float[np.ndarray, "4 4"],
        parts: Iterable[Points],
        below: list[int],
        extras: dict[str, Any],
    ) -> int:
        """One node with its mesh, and its colliders below it.

        Args:
            name: Of the node and its mesh.
            levels: Surfaces in the frame of the object, with its scale.
            T_parent: Where the node is in its parent's frame.
            to_pivot: From the object's frame to the node's.
            parts: Convex colliders in the object's frame.
            below: Further children.
            extras: What is said of it.
        """
        drawn = [self._materials.merge(_move(s, to_pivot) for s in surfaces) for surfaces in levels]
        if self._gathered.options.light_uv:
            drawn = [tuple(unwrap(one)) if one else one for one in drawn]
        children = [*below]
        coarser = len(drawn) > 1
        parts = list(parts) if self._gathered.options.engine in ("godot", "unreal") else []
        shown = f"{name} shape" if coarser and (below or parts) else name  # children would vanish with their level
        for number, part in enumerate(parts):
            corners, faces = hull_faces(part @ to_pivot[:3, :3].T + to_pivot[:3, 3])
            faces = faces.astype(np.int32)
            hull = Surface(_single(corners), _single(_outward(corners)), faces, UNSEEN)
            label = collider_name(shown, number, self._gathered.options.engine)
            children.append(
                self._document.add("nodes", {"name": label, "mesh": self._document.add_mesh(label, (hull,))})
            )
        node: dict[str, Any] = {"name": name, **placement(T_parent), "extras": extras}
        if shown != name:
            children.append(self._document.add("nodes", self._with_levels({"name": shown}, drawn)))
        elif drawn[0]:
            node = self._with_levels(node, drawn)
        if children:
            node["children"] = children
        return self._document.add("nodes", node)

    def _with_levels(self, node: dict[str, Any], drawn: Sequence[tuple[Surface, ...]]) -> dict[str, Any]:
        """A node with its mesh, and with a node for each coarser one at the same place."""
        name = node["name"]
        place: dict[str, Any] = {key: node[key] for key in ("rotation", "translation") if key in node}
        meshes = [
            self._document.add_mesh(f"{name}_LOD{level}" if level else name, surfaces)
            for level, surfaces in enumerate(drawn)
        ]
        node = {**node, "mesh": meshes[0]}
        if len(meshes) == 1:
            return node
        levels = [
            self._document.add("nodes", {"name": f"{name}_LOD{level}", **place, "mesh": mesh})
            for level, mesh in enumerate(meshes[1:], start=1)
        ]
        self._document.use("MSFT_lod")
        covered = [*COVERAGES[: len(levels)], COVERAGES[-1]]
        extras = {**node.get("extras", {}), "MSFT_screencoverage": covered}
        return {**node, "extensions": {"MSFT_lod": {"ids": levels}}, "extras": extras}

    def _lights(self) -> list[int]:
        """Lamps, windows and the photo's main light, in the world."""
        nodes: list[int] = []
        main = self._gathered.main_light
        for light in (*self._gathered.lights, *(() if main is None else (main,))):
            about: dict[str, Any] = {"color": [float(c) for c in light.colour], "name": "light"}
            if isinstance(light, MainLight):
                about |= {"type": "directional", "intensity": light.lux * self._gathered.strength(light)}
            else:
                about |= {"type": "point", "intensity": light.candela * self._gathered.strength(light)}
            index, name = self._document.add_light(about), f"light {len(nodes) + 1}"
            nodes.append(self._document.add_light_node(name, index, Y_UP @ light.T_world))
        return nodes


def unwrap(surfaces: Sequence[Surface]) -> Iterator[Surface]:
    """The surfaces of one mesh with `light_uv` for light that an engine bakes: all in one square from 0 to 1, no two
    triangles on each other; vertices are split at seams.

    Raises:
        UnavailableError: xatlas is not installed.
    """
    try:
        import xatlas
    except ImportError as missing:
        raise UnavailableError("coordinates for baked light need xatlas: pip install 'diorama[game]'") from missing
    starts = np.cumsum([0, *(len(s.vertices) for s in surfaces)])
    faces = np.concatenate([s.faces + start for s, start in zip(surfaces, starts, strict=False)])
    positions = np.concatenate([s.vertices for s in surfaces])
    original, split, uv = xatlas.parametrize(positions, faces.astype(np.uint32))
    rows = np.split(split.astype(np.int64), np.cumsum([len(s.faces) for s in surfaces])[:-1])
    for surface, start, triangles in zip(surfaces, starts, rows, strict=False):
        used, corners = np.unique(triangles, return_inverse=True)
        rows_before = original[used].astype(np.int64) - start
        yield replace(with_vertices(surface, rows_before, corners), light_uv=uv[used])


def collider_name(name: str, number: int, engine: str) -> str:
    """What an engine's import takes for a convex collider without a picture."""
    return f"UCX_{name}_{number:02d}" if engine == "unreal" else f"{name} {number}-convcolonly"


def _lighter(surface: Surface, share: float, errors: tuple[float, ...]) -> Surface:
    triangles = np.ascontiguousarray(surface.faces.reshape(-1), dtype=np.uint32)
    return without_unused(surface, simplify(triangles, surface.vertices, share, errors, MAX_SHORTER))


def _normals(surface: Surface, scale: Float[np.ndarray, "3"]) -> np.ndarray:
    turned = surface.normals / scale
    return _single(turned / np.linalg.norm(turned, axis=1, keepdims=True))


def _move(surface: Surface, T: Float[np.ndarray, "4 4"]) -> Surface:
    vertices, normals = surface.vertices @ T[:3, :3].T + T[:3, 3], surface.normals @ T[:3, :3].T
    return replace(surface, vertices=_single(vertices), normals=_single(normals))


def _outward(corners: Points) -> Points:
    """Directions from the middle: colliders are not seen, but each vertex needs a normal."""
    away = corners - corners.mean(axis=0)
    return away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)


def _count(surfaces: Iterable[Surface]) -> int:
    return sum(len(s.faces) for s in surfaces)


def _single(values: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(values, dtype=np.float32)
