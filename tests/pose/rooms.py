"""Rooms of simple furniture with exactly known poses, seen by ray casting, for retrieval and pose."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh

from diorama_core.artefacts import (
    Cuboid,
    DepthMap,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    Photo,
    RankedShapes,
)
from diorama_core.errors import LibraryError
from diorama_core.library.record import Shape
from diorama_core.provenance import DepthSource, ScaleSource
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Camera, Intrinsics, Pose, Support, yaw_rotation
from tests.primitives import material

Block = tuple[tuple[float, float, float], tuple[float, float, float]]
"""Size and centre."""

BLOCKS: dict[str, tuple[str, int, list[Block]]] = {
    "chair": ("chair", 1, [
        ((0.45, 0.45, 0.05), (0, 0, 0.45)), ((0.05, 0.45, 0.45), (-0.2, 0, 0.7)),
        *[((0.04, 0.04, 0.44), (x, y, 0.22)) for x in (-0.2, 0.2) for y in (-0.2, 0.2)],
    ]),
    "low chair": ("chair", 1, [((0.6, 0.5, 0.4), (0, 0, 0.2)), ((0.12, 0.5, 0.4), (-0.24, 0, 0.6))]),
    "sofa": ("sofa", 1, [
        ((0.9, 1.9, 0.4), (0, 0, 0.2)), ((0.22, 1.9, 0.45), (-0.34, 0, 0.62)),
        *[((0.9, 0.18, 0.2), (0, y, 0.5)) for y in (-0.86, 0.86)],
    ]),
    "bed": ("bed", 1, [((2.0, 1.5, 0.45), (0, 0, 0.22)), ((0.08, 1.5, 0.6), (-1.0, 0, 0.7))]),
    "desk": ("desk", 1, [
        ((0.7, 1.4, 0.04), (0, 0, 0.73)), ((0.6, 0.4, 0.7), (0, 0.48, 0.36)), ((0.6, 0.04, 0.7), (0, -0.66, 0.36)),
    ]),
    "table": ("table", 2, [
        ((0.8, 1.4, 0.05), (0, 0, 0.7)),
        *[((0.06, 0.06, 0.68), (x, y, 0.34)) for x in (-0.35, 0.35) for y in (-0.65, 0.65)],
    ]),
    "carton": ("box", 2, [((0.4, 0.5, 0.4), (0, 0, 0.2))]),
}  # fmt: skip


def _mug() -> trimesh.Trimesh:
    body = trimesh.creation.cylinder(0.2, 0.4, sections=40)
    handle = trimesh.creation.box((0.12, 0.04, 0.2), trimesh.transformations.translation_matrix((0.25, 0, 0)))
    return trimesh.util.concatenate([body, handle])


def _tripod() -> trimesh.Trimesh:
    legs = [
        trimesh.creation.cylinder(0.02, segment=[(0.3 * np.cos(a), 0.3 * np.sin(a), 0), (0, 0, 1.2)], sections=8)
        for a in np.deg2rad([0, 120, 240])
    ]
    shade = trimesh.creation.cylinder(
        0.32, 0.3, sections=48, transform=trimesh.transformations.translation_matrix((0, 0, 1.3))
    )
    return trimesh.util.concatenate([*legs, shade])


def _carton() -> trimesh.Trimesh:
    return trimesh.creation.box((0.4, 0.5, 0.4))


MODELS: dict[str, tuple[str, int, Callable[[], trimesh.Trimesh]]] = {
    "mug": ("cup", 1, _mug),
    "tripod": ("floor lamp", 3, _tripod),
    "red front": ("box", 1, _carton),
}
"""What tells their turns apart is small, or colour alone."""


@dataclass(frozen=True)
class BlockLibrary:
    """Furniture of blocks, a round table, a lone triangle, and models that look alike from many sides."""

    def _mesh(self, shape_id: str) -> trimesh.Trimesh:
        if shape_id in BLOCKS:
            blocks = [
                trimesh.creation.box(size, trimesh.transformations.translation_matrix(at))
                for size, at in BLOCKS[shape_id][2]
            ]
            mesh = trimesh.util.concatenate(blocks)
        elif shape_id == "round table":
            mesh = trimesh.creation.cylinder(0.5, 0.7, sections=48)
        elif shape_id in MODELS:
            mesh = MODELS[shape_id][2]()
        elif shape_id == "triangle":
            mesh = trimesh.Trimesh([[0, 0, 0], [0.4, 0, 0], [0, 0.4, 0]], [[0, 1, 2]])
        else:
            raise LibraryError(f"there is no shape {shape_id!r} in the library")
        mesh.apply_translation(-mesh.bounds.mean(axis=0))
        return mesh

    def shapes(self) -> tuple[Shape, ...]:
        return tuple(self.shape(s) for s in (*BLOCKS, "round table", "triangle", *MODELS))

    def shape(self, shape_id: str) -> Shape:
        others = {"round table": ("table", 36), "triangle": ("toy", 1)}
        name, fold = others.get(shape_id) or (BLOCKS | MODELS)[shape_id][:2]
        size = tuple(float(e) for e in self._mesh(shape_id).extents)
        return Shape(
            shape_id, name, shape_id, size, symmetry=fold, content_hash=hashlib.sha256(shape_id.encode()).hexdigest()
        )

    def in_category(self, category: str) -> tuple[Shape, ...]:
        return tuple(s for s in self.shapes() if s.category == category)

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        return self._mesh(shape_id)

    def parts(self, shape_id: str) -> trimesh.Scene:
        mesh = self._mesh(shape_id)
        if shape_id == "red front":
            front = mesh.face_normals[:, 0] > 0.5
            mesh.visual.face_colors = np.where(front[:, None], (190, 40, 40, 255), (170, 165, 150, 255))
            return trimesh.Scene({"all": mesh})
        mesh.visual = trimesh.visual.TextureVisuals(material=material("oak", (0.5, 0.35, 0.2)))
        return trimesh.Scene({"all": mesh})

    def glb(self, shape_id: str) -> bytes:
        return self.parts(shape_id).export(file_type="glb")


LIBRARY = BlockLibrary()


def camera_at(height_m: float = 1.5, pitch_deg: float = 15.0, size: tuple[int, int] = (480, 360)) -> Camera:
    """Above the origin, looking along +Y and down."""
    pitch = np.deg2rad(pitch_deg)
    forward = np.array([0.0, np.cos(pitch), -np.sin(pitch)])
    right = np.array([1.0, 0.0, 0.0])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.stack([right, np.cross(forward, right), forward], axis=1), [0.0, 0.0, height_m]
    return Camera(Intrinsics.from_fov(*size, np.deg2rad(62.0)), T)


@dataclass(frozen=True)
class Placed:
    """One piece of furniture with its true pose."""

    shape_id: str
    pose: Pose

    @property
    def size_m(self) -> np.ndarray:
        return np.array(LIBRARY.shape(self.shape_id).size_m) * self.pose.scale


def standing(shape_id: str, x: float, y: float, yaw_deg: float, scale=(1.0, 1.0, 1.0)) -> Placed:
    """A shape on the floor."""
    height = LIBRARY.shape(shape_id).size_m[2] * scale[2]
    return Placed(shape_id, Pose.upright((x, y, height / 2), np.deg2rad(yaw_deg), scale))


@dataclass(frozen=True)
class Room:
    """Placed things seen by a camera, with every artefact a perfect perception would hand on.

    The cuboids know the objects' axes only up to a quarter turn.
    """

    camera: Camera
    placed: tuple[Placed, ...]
    quarter_turns: tuple[int, ...]

    @cached_property
    def buffers(self):
        return MeshCaster([(LIBRARY.mesh(p.shape_id), p.pose.matrix) for p in self.placed]).buffers(self.camera)

    @cached_property
    def seen(self) -> tuple[int, ...]:
        """Indices of things of which something is seen."""
        return tuple(i for i in range(len(self.placed)) if (self.buffers.instance == i).sum() >= 30)

    @cached_property
    def objects(self) -> tuple[DetectedObject, ...]:
        found = []
        for i in self.seen:
            mask = self.buffers.instance == i
            rows, columns = np.nonzero(mask)
            box = (float(columns.min()), float(rows.min()), float(columns.max() + 1), float(rows.max() + 1))
            name = LIBRARY.shape(self.placed[i].shape_id).category
            found.append(DetectedObject(f"o{i}", name, name, box, mask, i + 1, 1.0))
        return tuple(found)

    @cached_property
    def geometry(self) -> ObjectGeometry:
        cuboids = []
        for i in self.seen:
            item, turn = self.placed[i], self.quarter_turns[i]
            R = item.pose.R_world_object @ yaw_rotation(turn * np.pi / 2)
            size = item.size_m if turn % 2 == 0 else item.size_m[[1, 0, 2]]
            cuboids.append(Cuboid(f"o{i}", R, item.pose.position, size, 0.9))
        supports = tuple(Support(c.object_id, "floor") for c in cuboids)
        return ObjectGeometry(self.camera, tuple(cuboids), supports, ScaleSource.GIVEN)

    @cached_property
    def inputs(self) -> Inputs:
        k = self.camera.intrinsics
        rgb = np.full((k.height, k.width, 3), 200, np.uint8)
        rgb[self.buffers.instance >= 0] = (128, 90, 50)
        return Inputs(Photo(rgb, "room", (k.width, k.height)))

    def depth(self, measured: bool) -> DepthMap:
        source = DepthSource.MEASURED if measured else DepthSource.RENDERED
        return DepthMap(self.buffers.depth_m, self.buffers.normals_world, source)

    def ranked(self) -> tuple[RankedShapes, ...]:
        """The true shape alone, for every object."""
        return tuple(RankedShapes(f"o{i}", ((self.placed[i].shape_id, 1.0),)) for i in self.seen)


def random_room(seed: int, count: int = 4) -> Room:
    """Furniture in a row across the view, at any quarter turn with a little play, facing anywhere."""
    rng = np.random.default_rng(seed)
    kinds = ("chair", "low chair", "sofa", "bed", "desk", "table", "carton", "round table")
    placed = []
    for slot in range(count):
        shape_id = kinds[rng.integers(len(kinds))]
        x, y = (slot - (count - 1) / 2) * 1.5 + rng.uniform(-0.2, 0.2), rng.uniform(3.2, 5.0)
        yaw = 90.0 * rng.integers(4) + rng.uniform(-20, 20)
        placed.append(standing(shape_id, x, y, yaw, tuple(rng.uniform(0.93, 1.07, 3))))
    return Room(camera_at(rng.uniform(1.3, 1.7)), tuple(placed), tuple(int(t) for t in rng.integers(0, 4, count)))


def yaw_error_deg(estimated: Pose, truth: Pose, symmetry: int) -> float:
    """Difference of headings up to the shape's symmetry."""
    turn = 2 * np.pi / symmetry
    difference = np.mod(estimated.yaw_rad - truth.yaw_rad + turn / 2, turn) - turn / 2
    return float(np.rad2deg(abs(difference)))
