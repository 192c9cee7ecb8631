"""A scene reduced once to what every format writes: nodes, shared meshes and materials, camera and lights.

World frame: +Z up, metres. Objects of one shape in one paint share a mesh, equal materials are one object with a
unique name, and equal pictures are one array, so that a writer may tell them apart by identity. Writers never read the
library for what an object looks like; colliders come from `diorama_core.export.colliders`.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.export.lights import ExportLight, lights_of
from diorama_core.export.limbs import ExportLimb, articulation_of, limb_of, surfaces_of
from diorama_core.library.paint import Colour
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.render.appearance import Material, Surface, shape_surfaces
from diorama_core.render.slabs import plane_surfaces
from diorama_core.scene.support import ancestors, top_down
from diorama_core.scene.types import Camera, Finish, Plane, Scene, SceneObject, Support

Picture = UInt8[np.ndarray, "_ _ _"]
Compression = Literal["none", "meshopt"]
Bodies = Literal["free", "welded"]
MIN_AREA_M2 = 1e-12
"""Triangles smaller than this are not written: no format can shade them."""


@dataclass(frozen=True)
class ExportOptions:
    """What is written, and how."""

    ceiling: bool = True
    """Whether ceilings are written; without them a room can be looked into from above."""
    only: frozenset[str] | None = None
    """Ids of the objects to write, without the room around them; None writes everything."""
    max_texture_px: int | None = None
    """Longest side of a picture; larger ones are reduced."""
    compression: Compression = "none"
    """Of geometry, where the format has one (GLB)."""
    bodies: Bodies = "free"
    """Whether simulators may move objects that stand on something; mounted and locked ones never move."""
    joints: bool = False
    """Whether shapes that know their joints are written in parts that move."""


EVERYTHING = ExportOptions()
"""The whole scene, uncompressed."""


@dataclass(frozen=True, eq=False)
class ExportMesh:
    """Geometry that one or more nodes show."""

    key: str
    """Unique identifier: letters, digits and underscores."""
    name: str
    """Shape or plane id."""
    surfaces: tuple[Surface, ...]
    """In the shape's canonical frame at scale 1; of planes in the world. Materials are those of `ExportScene`."""
    shape_id: str | None = None
    """None for planes."""

    @property
    def triangles(self) -> int:
        """Number of triangles."""
        return sum(len(s.faces) for s in self.surfaces)


@dataclass(frozen=True, eq=False)
class ExportObject:
    """One object as a node of the support graph."""

    id: str
    name: str
    """Unique among all nodes, readable."""
    slug: str
    """Unique among all nodes: an ASCII identifier of letters, digits and underscores."""
    parent: str | None
    """Id of the exported object that carries it; None where the room carries it."""
    T_world: Float[np.ndarray, "4 4"]
    """Rigid: rotation and translation."""
    scale: Float[np.ndarray, "3"]
    """Of the mesh along its own axes; children do not inherit it."""
    mesh: str
    """Key of its mesh."""
    item: SceneObject
    """The object itself: label, category, candidates, confidence, ..."""
    support: Support | None
    """Its edge of the support graph, as the scene says it (planes and hidden supporters included)."""
    limbs: tuple[ExportLimb, ...] = ()
    """Its moving parts; `mesh` then is the rest of it. Only with the option `joints`."""


@dataclass(frozen=True, eq=False)
class ExportPlane:
    """One slab of the architecture."""

    id: str
    name: str
    slug: str
    mesh: str
    plane: Plane


@dataclass(frozen=True, eq=False)
class ExportScene:
    """The gathered scene for writers. Objects are listed supporters first."""

    name: str
    objects: tuple[ExportObject, ...]
    planes: tuple[ExportPlane, ...]
    meshes: Mapping[str, ExportMesh]
    materials: tuple[Material, ...]
    """Every material of the meshes once; names are unique."""
    camera: Camera | None
    lights: tuple[ExportLight, ...]
    scene: Scene
    """The whole scene as it was given, for formats that carry it to be read back."""
    library: ShapeLibrary
    options: ExportOptions = EVERYTHING
    photo: Picture | None = None
    provenance: Mapping[str, Any] = field(default_factory=dict)
    """Where the scene comes from, as JSON values: program, photo, profile, warnings."""

    @cached_property
    def _by_id(self) -> dict[str, ExportObject]:
        return {o.id: o for o in self.objects}

    @cached_property
    def _below(self) -> dict[str | None, tuple[ExportObject, ...]]:
        below: dict[str | None, tuple[ExportObject, ...]] = {}
        for item in self.objects:
            below[item.parent] = (*below.get(item.parent, ()), item)
        return below

    def object(self, object_id: str) -> ExportObject:
        """The exported object with this id; raises `KeyError` when it is not exported."""
        return self._by_id[object_id]

    def children_of(self, parent: str | None) -> tuple[ExportObject, ...]:
        """Exported objects directly below an object, or below the root."""
        return self._below.get(parent, ())

    def T_parent(self, item: ExportObject) -> Float[np.ndarray, "4 4"]:
        """The object's rigid transform in the frame of the object that carries it, or in the world."""
        if item.parent is None:
            return item.T_world
        return rigid_inverse(self.object(item.parent).T_world) @ item.T_world


def gather(
    scene: Scene,
    library: ShapeLibrary,
    *,
    options: ExportOptions = EVERYTHING,
    textures: Mapping[str, Picture] | None = None,
    photo: Picture | None = None,
    name: str = "scene",
    provenance: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> ExportScene:
    """Reduce a scene to what is written.

    Args:
        scene: What to write; hidden objects are left out, what they carry moves up to their supporter.
        library: Where its shapes are.
        options: What of it is written.
        textures: Pictures of the planes by `Plane.texture`.
        photo: The photo that the scene was made from.
        name: What the file calls the scene.
        provenance: Where the scene comes from, as JSON values.
        progress: Where shapes are counted and cancelling is noticed.

    Raises:
        LibraryError: when a shape is missing.
        Cancelled: when asked to stop.
    """
    shared, labels = _Shared(options.max_texture_px), _Labels()
    planes, meshes = _planes(scene, options, textures or {}, shared, labels)
    shown = {o.id for o in scene.objects if not o.hidden and (options.only is None or o.id in options.only)}
    order = [scene.object(i) for i in top_down(scene) if i in shown]
    painted: dict[tuple[str, Colour | None, Finish | None], dict[int | None, str]] = {}
    objects = []
    for number, item in enumerate(order):
        if progress is not None:
            progress.report(number / len(order), f"reading {item.label}")
        paint = (item.shape_id, item.colour, item.finish)
        if paint not in painted:
            made = _shape_meshes(library, item, options, shared, labels)
            painted[paint] = {number: mesh.key for number, mesh in made.items()}
            meshes |= {mesh.key: mesh for mesh in made.values()}
        objects.append(_node(scene, library, item, painted[paint], shown, labels))
    lights = lights_of(scene, [o.item for o in objects], {o.id: meshes[o.mesh].surfaces for o in objects})
    return ExportScene(
        name=name,
        objects=tuple(objects),
        planes=tuple(planes),
        meshes=meshes,
        materials=shared.materials,
        camera=scene.camera,
        lights=lights,
        scene=scene,
        library=library,
        options=options,
        photo=photo,
        provenance=dict(provenance or {}),
    )


def rigid_inverse(T: Float[np.ndarray, "4 4"]) -> Float[np.ndarray, "4 4"]:
    """Inverse of a rotation with a translation."""
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = T[:3, :3].T, -T[:3, :3].T @ T[:3, 3]
    return out


def slug_of(text: str) -> str:
    """An ASCII identifier that resembles the text: a letter first, then letters, digits and underscores."""
    plain = re.sub(r"[^A-Za-z0-9]+", "_", text).strip("_")
    return plain if plain[:1].isalpha() else f"n_{plain}".rstrip("_")


def _planes(
    scene: Scene, options: ExportOptions, textures: Mapping[str, Picture], shared: _Shared, labels: _Labels
) -> tuple[list[ExportPlane], dict[str, ExportMesh]]:
    found, meshes = [], {}
    for plane in scene.architecture.planes if options.only is None else ():
        if plane.role == "ceiling" and not options.ceiling:
            continue
        picture = textures.get(plane.texture) if plane.texture else None
        surfaces = shared.surfaces(plane_surfaces(plane, picture))
        name = plane.role if plane.id == plane.role else f"{plane.role} {plane.id}"
        mesh = ExportMesh(labels.key(f"plane_{plane.id}"), plane.id, surfaces)
        meshes[mesh.key] = mesh
        found.append(ExportPlane(plane.id, labels.name(name), labels.slug(name), mesh.key, plane))
    return found, meshes


def _shape_meshes(
    library: ShapeLibrary, item: SceneObject, options: ExportOptions, shared: _Shared, labels: _Labels
) -> dict[int | None, ExportMesh]:
    """The shape's mesh under None; with joints, what each of them moves under its number."""
    pieces = articulation_of(library, item.shape_id) if options.joints else None
    if pieces is None:
        grouped: dict[int | None, tuple[Surface, ...]] = {
            None: shape_surfaces(library, item.shape_id, item.colour, item.finish)
        }
    else:
        grouped = surfaces_of(pieces, item.colour, item.finish)
    made = {}
    for number, surfaces in grouped.items():
        name = item.shape_id if number is None or pieces is None else f"{item.shape_id} {pieces.joints[number].name}"
        made[number] = ExportMesh(labels.key(name), name, shared.surfaces(surfaces), item.shape_id)
    return made


def _node(
    scene: Scene,
    library: ShapeLibrary,
    item: SceneObject,
    made: Mapping[int | None, str],
    shown: set[str],
    labels: _Labels,
) -> ExportObject:
    name = item.label if item.label == item.id else f"{item.label} ({item.id})"
    numbers = [number for number in made if number is not None]
    pieces = articulation_of(library, item.shape_id) if numbers else None
    joints = () if pieces is None else pieces.joints
    return ExportObject(
        id=item.id,
        name=labels.name(name),
        slug=labels.slug(item.id),
        parent=next((a for a in ancestors(scene, item.id) if a in shown), None),
        T_world=item.pose.T_world_object,
        scale=np.asarray(item.pose.scale),
        mesh=made[None],
        item=item,
        support=scene.support_of(item.id),
        limbs=tuple(limb_of(item, joints[n], n, made[n]) for n in numbers),
    )


class _Labels:
    """Names that are each used once: many programs address nodes by name."""

    def __init__(self) -> None:
        self._names: set[str] = set()
        self._slugs: set[str] = set()
        self._keys: set[str] = set()

    def name(self, text: str) -> str:
        return unique_name(text or "object", self._names, " ")

    def slug(self, text: str) -> str:
        return unique_name(slug_of(text), self._slugs, "_")

    def key(self, text: str) -> str:
        return unique_name(slug_of(text), self._keys, "_")


def unique_name(text: str, taken: set[str], separator: str = " ") -> str:
    """The text, with a number where it was used before; `taken` is extended.

    Case is ignored, because some disks do so when files are named by it; `taken` holds case-folded names.
    """
    candidate, number = text, 2
    while candidate.casefold() in taken:
        candidate, number = f"{text}{separator}{number}", number + 1
    taken.add(candidate.casefold())
    return candidate


class _Shared:
    """Materials and pictures, each once, whatever number of shapes brings an equal one."""

    def __init__(self, max_px: int | None) -> None:
        self._max_px = max_px
        self._materials: dict[Any, Material] = {}
        self._names: set[str] = set()
        self._pictures: dict[bytes, Picture] = {}
        self._read: dict[int, tuple[Picture, bytes]] = {}

    @property
    def materials(self) -> tuple[Material, ...]:
        return tuple(self._materials.values())

    def surfaces(self, surfaces: Iterable[Surface]) -> tuple[Surface, ...]:
        """The same surfaces with shared materials, without triangles that have no area, and with unit normals."""
        sound = (_with_unit_normals(_without_slivers(s)) for s in surfaces)
        return tuple(replace(s, material=self._material(s.material)) for s in sound if len(s.faces))

    def _material(self, source: Material) -> Material:
        texture = None if source.texture is None else self._digest(source.texture)
        maps = tuple((slot, self._digest(picture)) for slot, picture in sorted(source.maps.items()))
        values = (source.name, source.colour, source.alpha, source.metallic, source.roughness, source.emissive)
        key = (*values, source.double_sided, source.photographed, texture, maps)
        if key not in self._materials:
            self._materials[key] = replace(
                source,
                name=unique_name(source.name, self._names, " "),
                texture=None if texture is None else self._pictures[texture],
                maps={slot: self._pictures[digest] for slot, digest in maps},
            )
        return self._materials[key]

    def _digest(self, picture: Picture) -> bytes:
        if id(picture) not in self._read:
            digest = hashlib.sha256(f"{picture.shape}".encode() + np.ascontiguousarray(picture).tobytes()).digest()
            self._read[id(picture)] = (picture, digest)  # holding the picture keeps its id from being reused
            if digest not in self._pictures:
                self._pictures[digest] = _limited(picture, self._max_px)
        return self._read[id(picture)][1]


def _limited(picture: Picture, max_px: int | None) -> Picture:
    """The picture, reduced so that its longer side has at most `max_px` pixels."""
    longest = max(picture.shape[:2])
    if max_px is None or longest <= max_px:
        return picture
    width, height = (max(1, round(n * max_px / longest)) for n in (picture.shape[1], picture.shape[0]))
    return np.asarray(cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA))


def _without_slivers(surface: Surface) -> Surface:
    """The surface without triangles that have no area or name a vertex twice."""
    a, b, c = (surface.vertices[surface.faces[:, k]].astype(np.float64) for k in range(3))
    sound = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1) > MIN_AREA_M2
    if sound.all():
        return surface
    faces = surface.faces[sound]
    used = np.unique(faces)
    return replace(
        surface,
        vertices=surface.vertices[used],
        normals=surface.normals[used],
        faces=np.searchsorted(used, faces).astype(np.int32),
        uv=None if surface.uv is None else surface.uv[used],
        colours=None if surface.colours is None else surface.colours[used],
    )


def _with_unit_normals(surface: Surface) -> Surface:
    """The surface with the normals that have no length, where creases cancel out, taken from a face at the vertex."""
    lengths = np.linalg.norm(surface.normals.astype(np.float64), axis=1)
    if (np.abs(lengths - 1.0) < 1e-4).all():
        return surface
    normals = np.divide(surface.normals, np.maximum(lengths, 1e-9)[:, None])
    lost = lengths < 0.5
    a, b, c = (surface.vertices[surface.faces[:, k]].astype(np.float64) for k in range(3))
    flat = np.cross(b - a, c - a)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    of_face = np.zeros_like(normals)
    for corner in range(3):
        of_face[surface.faces[:, corner]] = flat
    return replace(surface, normals=np.where(lost[:, None], of_face, normals).astype(np.float32))
