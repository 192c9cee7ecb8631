"""A scene reduced once to what every format writes: nodes, shared meshes and materials, camera and lights.

World frame: +Z up, metres. Objects of one shape in one paint share a mesh, equal materials are one object with a
unique name, and equal pictures are one array, so that a writer may tell them apart by identity. Writers never read the
library for what an object looks like; colliders come from `diorama_core.export.colliders`.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from diorama_core.export.door_swings import door_swings, opening_out
from diorama_core.export.lights import EvenLight, ExportLight, MainLight, even_light_of, lights_of, main_light_of
from diorama_core.export.limbs import ExportLimb, OneShape, group_by_joint, limb_of
from diorama_core.export.pictures import MAX_PHOTO_TEXTURES_PX, Picture, fit_pictures, photo_text
from diorama_core.export.sharing import Labels, SharedAppearance
from diorama_core.geometry.openings import with_openings
from diorama_core.geometry.rooms import rooms_of_objects, rooms_of_planes
from diorama_core.io.text import clean_text
from diorama_core.library.opening import OpenedShapes, articulation_of
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.stretch import relative_scale
from diorama_core.progress import SILENT, Progress
from diorama_core.render.appearance import Material, PartsSource, Surface, shape_surfaces
from diorama_core.render.slabs import plane_surfaces
from diorama_core.scene.support import ancestors, top_down
from diorama_core.scene.types import Camera, HomeRoom, Plane, Scene, SceneObject, Support

Compression = Literal["none", "meshopt", "draco"]
Bodies = Literal["free", "welded"]
LightUnits = Literal["unit", "photometric", "none"]
GameEngine = Literal["godot", "unreal", "unity", "three"]


@dataclass(frozen=True)
class ExportOptions:
    """What is written, and how."""

    ceiling: bool = True
    """Whether ceilings are written; without them a room can be looked into from above."""
    only: frozenset[str] | None = None
    """Ids of the objects to write, without the room around them; None writes everything."""
    max_texture_px: int | None = None
    """Longest side of a picture; larger ones are reduced."""
    max_photo_textures_px: int = MAX_PHOTO_TEXTURES_PX
    """Side of a square that would hold all pictures from the photo, of planes and objects; more are reduced alike."""
    compression: Compression = "none"
    """Compression of geometry, where the format has one (GLB)."""
    bodies: Bodies = "free"
    """Whether simulators may move objects that stand on something; mounted and locked ones never move."""
    joints: bool = False
    """Whether shapes that know their joints are written in parts that move."""
    lights: LightUnits = "unit"
    """Whether lights of GLB and USD have unit exposure (a luminance of 1 is white, as programs without a camera's
    exposure show it), are in lumens and lux, or are left out."""
    engine: GameEngine = "godot"
    """Which engine a game's file is for: colliders have its names; for Unity and three.js, which have none, they are
    left out. Godot makes levels of detail itself when it imports."""
    max_triangles: int = 3000
    """About how many each object of a game has at most: what shows it in a game's usual distance."""
    max_total_triangles: int | None = None
    """How many the room and its objects have at most in a game, each in its finest level; None for any number."""
    light_uv: bool = False
    """Whether a game's meshes have a second set of texture coordinates without overlaps, for baked light."""
    robot_radius_m: float = 0.25
    """Radius of the disc for which a robot pack says where it can be: as large as usual bases of arms."""
    photo: bool = False
    """Whether files that can be opened again hold the photo, too (GLB, USD)."""


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
    """Scale of the mesh along its own axes; children do not inherit it."""
    mesh: str
    """Key of its mesh."""
    item: SceneObject
    """The object itself: label, category, candidates, confidence, ..."""
    support: Support | None
    """Its edge of the support graph, as the scene says it (planes and hidden supporters included)."""
    limbs: tuple[ExportLimb, ...] = ()
    """Its moving parts; `mesh` then is the rest of it. Only with the option `joints`."""
    group: tuple[str, ...] = ()
    """Slugs of the storey and the room of a home that it is in."""


@dataclass(frozen=True, eq=False)
class ExportPlane:
    """One slab of the architecture."""

    id: str
    name: str
    slug: str
    mesh: str
    plane: Plane
    group: tuple[str, ...] = ()
    """Slugs of the storey and the room of a home that it is of."""


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
    """Lights of lamps and windows."""
    scene: Scene
    """The whole scene as it was given, for formats that carry it to be read back."""
    library: ShapeLibrary
    options: ExportOptions = EVERYTHING
    textures: Mapping[str, Picture] = field(default_factory=dict)
    """Pictures of the planes and of the objects' materials from the photo, by name, as large as they are written."""
    photo: Picture | None = None
    provenance: Mapping[str, Any] = field(default_factory=dict)
    """Where the scene comes from, as JSON values: program, photo, profile, warnings."""

    @cached_property
    def _objects_by_id(self) -> dict[str, ExportObject]:
        return {o.id: o for o in self.objects}

    @cached_property
    def _objects_by_parent(self) -> dict[str | None, tuple[ExportObject, ...]]:
        below: dict[str | None, tuple[ExportObject, ...]] = {}
        for item in self.objects:
            below[item.parent] = (*below.get(item.parent, ()), item)
        return below

    def lights_of(self, object_id: str) -> list[ExportLight]:
        """The lights of an object."""
        return [light for light in self.lights if light.owner == object_id]

    @cached_property
    def main_light(self) -> MainLight | None:
        """The photo's main light; None where it tells none, and where the room is not written."""
        return main_light_of(self.scene) if self._room_is_lit else None

    @cached_property
    def even_light(self) -> EvenLight | None:
        """The room's even light; None where lights are photometric: there is no such lamp."""
        wanted = self._room_is_lit and self.options.lights == "unit"
        return even_light_of(self.scene, self.lights) if wanted else None

    @cached_property
    def room_of(self) -> Mapping[str, HomeRoom]:
        """The room of each plane and object of a home, by their ids."""
        return _rooms_by_id(self.scene)

    @property
    def floor_m(self) -> float:
        """Height of the floor in the world; 0 without one."""
        floor = self.scene.architecture.floor
        return 0.0 if floor is None else float(floor.centre[2])

    @property
    def _room_is_lit(self) -> bool:
        return self.options.only is None and self.options.lights != "none"

    def strength(self, light: ExportLight | MainLight) -> float:
        """Factor from a light's photometric units to those that are written."""
        return 1.0 if self.options.lights == "photometric" else 1.0 / light.white_nits

    @property
    def photo_text(self) -> str | None:
        """The photo as text for files that hold it; None where it is not asked for, or there is none."""
        return None if self.photo is None or not self.options.photo else photo_text(self.photo)

    def object(self, object_id: str) -> ExportObject:
        """The exported object with this id; raises `KeyError` when it is not exported."""
        return self._objects_by_id[object_id]

    def children_of(self, parent: str | None) -> tuple[ExportObject, ...]:
        """Exported objects directly below an object, or below the root."""
        return self._objects_by_parent.get(parent, ())

    def points_of(self, mesh: str, scale: Float[np.ndarray, "3"]) -> Float[np.ndarray, "n 3"]:
        """All vertices of a mesh at a scale."""
        return np.concatenate([s.vertices for s in self.meshes[mesh].surfaces]) * scale

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
    progress: Progress = SILENT,
) -> ExportScene:
    """Reduce a scene to what is written.

    Args:
        scene: What to write; hidden objects are left out, what they carry moves up to their supporter.
        library: Where its shapes are.
        options: What of it is written.
        textures: Pictures of the planes by `Plane.texture`, and of the objects' materials from the photo.
        photo: The photo that the scene was made from.
        name: What the file calls the scene.
        provenance: Where the scene comes from, as JSON values.
        progress: Where shapes are counted and cancelling is noticed.

    Raises:
        LibraryError: when a shape is missing.
        Cancelled: when asked to stop.
    """
    shared, labels = SharedAppearance(options.max_texture_px), Labels()
    textures = fit_pictures(scene, textures or {}, options.max_photo_textures_px)
    slugs = {r.id: (f"storey_{r.storey}", labels.slug(r.name)) for r in scene.rooms}
    groups = {name: slugs[room.id] for name, room in _rooms_by_id(scene).items()}
    shown = {o.id for o in scene.objects if not o.hidden and (options.only is None or o.id in options.only)}
    gatherer = _Gatherer(scene, library, options, textures, shared, labels, groups, shown)
    planes, meshes = gatherer.planes()
    order = [scene.object(i) for i in top_down(scene) if i in shown]
    painted: dict[tuple[object, ...], dict[int | None, str]] = {}
    swings = door_swings(order, lambda i: articulation_of(library, i)) if options.joints else {}
    objects = []
    for number, item in enumerate(order):
        progress.report(number / len(order), f"reading {item.label}")
        scale = relative_scale(item.pose.scale)
        paint = (item.shape_id, item.colour, item.finish, item.visible_materials, scale, item.open_share)
        if paint not in painted:
            made = gatherer.shape_meshes(item)
            painted[paint] = {number: mesh.key for number, mesh in made.items()}
            meshes |= {mesh.key: mesh for mesh in made.values()}
        outward = item.id in swings and swings[item.id].outward
        objects.append(gatherer.node(item, painted[paint], outward=outward))
    lit = [] if options.lights == "none" else [o.item for o in objects]
    return ExportScene(
        name=clean_text(name),
        objects=tuple(objects),
        planes=tuple(planes),
        meshes=meshes,
        materials=shared.materials,
        camera=scene.camera,
        lights=lights_of(scene, lit, {o.id: meshes[o.mesh].surfaces for o in objects}),
        scene=scene,
        library=library,
        options=options,
        textures=textures,
        photo=photo,
        provenance=dict(provenance or {}),
    )


def T_world_lens(camera: Camera) -> Float[np.ndarray, "4 4"]:
    """Where a camera is that looks along its -z with y up, as glTF, USD and MuJoCo have it; ours looks along +z."""
    return camera.T_world_camera @ np.diag([1.0, -1.0, -1.0, 1.0])


def shift(offset: Float[np.ndarray, "3"]) -> Float[np.ndarray, "4 4"]:
    """A translation."""
    out = np.eye(4)
    out[:3, 3] = offset
    return out


def rigid_inverse(T: Float[np.ndarray, "4 4"]) -> Float[np.ndarray, "4 4"]:
    """Inverse of a rotation with a translation."""
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = T[:3, :3].T, -T[:3, :3].T @ T[:3, 3]
    return out


def _rooms_by_id(scene: Scene) -> dict[str, HomeRoom]:
    rooms = {r.id: r for r in scene.rooms}
    return {name: rooms[room] for name, room in {**rooms_of_planes(scene), **rooms_of_objects(scene)}.items()}


@dataclass(frozen=True)
class _Gatherer:
    """What the parts of a scene are gathered with."""

    scene: Scene
    library: ShapeLibrary
    options: ExportOptions
    textures: Mapping[str, Picture]
    shared: SharedAppearance
    labels: Labels
    groups: Mapping[str, tuple[str, ...]]
    shown: Set[str]
    """Ids of the objects that are written."""

    def planes(self) -> tuple[list[ExportPlane], dict[str, ExportMesh]]:
        planes, meshes, labels = [], {}, self.labels
        for plane in with_openings(self.scene).architecture.planes if self.options.only is None else ():
            if plane.role == "ceiling" and not self.options.ceiling:
                continue
            picture = self.textures.get(plane.texture) if plane.texture else None
            surfaces = self.shared.surfaces(plane_surfaces(plane, picture))
            name = plane.role if plane.id == plane.role else f"{plane.role} {plane.id}"
            mesh = ExportMesh(labels.key(f"plane_{plane.id}"), plane.id, surfaces)
            meshes[mesh.key] = mesh
            named, slug = labels.name(name), labels.slug(name)
            planes.append(ExportPlane(plane.id, named, slug, mesh.key, plane, self.groups.get(plane.id, ())))
        return planes, meshes

    def shape_meshes(self, item: SceneObject) -> dict[int | None, ExportMesh]:
        """The shape's mesh under None; with joints, what each of them moves under its number."""
        pieces = articulation_of(self.library, item.shape_id) if self.options.joints else None
        scale = relative_scale(item.pose.scale)
        opened = item.open_share != 0.0
        as_it_stands: PartsSource = OpenedShapes(self.library, item.open_share, scale) if opened else self.library
        shown = as_it_stands if pieces is None else OneShape(pieces)
        paint = (item.colour, item.finish, item.visible_materials)
        surfaces = shape_surfaces(shown, item.shape_id, *paint, self.textures, scale)
        grouped = {None: surfaces} if pieces is None else group_by_joint(surfaces)
        made = {}
        for number, surfaces in grouped.items():
            of_joint = "" if number is None or pieces is None else f" {pieces.joints[number].name}"
            name = f"{item.shape_id}{of_joint}"
            made[number] = ExportMesh(self.labels.key(name), name, self.shared.surfaces(surfaces), item.shape_id)
        return made

    def node(self, item: SceneObject, made: Mapping[int | None, str], *, outward: bool) -> ExportObject:
        """The node of an object; the hinges of a door may let it open out of the room."""
        name = item.label if item.label == item.id else f"{item.label} ({item.id})"
        numbers = [number for number in made if number is not None]
        pieces = articulation_of(self.library, item.shape_id) if numbers else None
        joints = () if pieces is None else pieces.joints
        if pieces is not None and outward:
            joints = tuple(opening_out(j, pieces, n) if j.kind == "hinge" else j for n, j in enumerate(joints))
        return ExportObject(
            id=item.id,
            name=self.labels.name(name),
            slug=self.labels.slug(item.id),
            parent=next((a for a in ancestors(self.scene, item.id) if a in self.shown), None),
            T_world=item.pose.T_world_object,
            scale=np.asarray(item.pose.scale),
            mesh=made[None],
            item=item,
            support=self.scene.support_of(item.id),
            limbs=tuple(limb_of(item, joints[n], n, made[n]) for n in numbers),
            group=self.groups.get(item.id, ()),
        )
