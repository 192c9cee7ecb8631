"""A small room made by hand: a library of plain shapes, a photo, and a scene of them. For tests of the editor."""

from __future__ import annotations

import shutil
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import trimesh
from trimesh.visual.material import PBRMaterial

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import LibraryError
from diorama_core.library.record import Shape, SupportSurface
from diorama_core.project.storage import Project
from diorama_core.scene.types import (
    Architecture,
    Camera,
    Candidate,
    Intrinsics,
    Plane,
    Pose,
    Scene,
    SceneObject,
    Support,
)

SIZES = {
    "chair_a": ("chair", (0.5, 0.46, 0.86), (156, 106, 66)),
    "chair_b": ("chair", (0.55, 0.52, 0.8), (60, 110, 130)),
    "chair_c": ("chair", (0.48, 0.5, 0.95), (170, 60, 50)),
    "table_a": ("table", (0.8, 1.4, 0.74), (190, 160, 120)),
    "table_b": ("table", (0.9, 1.6, 0.72), (90, 70, 60)),
    "lamp_a": ("lamp", (0.24, 0.24, 0.45), (236, 220, 170)),
    "picture_a": ("picture", (0.03, 0.8, 0.6), (70, 90, 160)),
}


class PlainLibrary:
    """Seven shapes made of boxes; implements `ShapeLibrary`."""

    def shapes(self) -> tuple[Shape, ...]:
        return tuple(self.shape(i) for i in SIZES)

    def shape(self, shape_id: str) -> Shape:
        if shape_id not in SIZES:
            raise LibraryError(f"no shape is called '{shape_id}'")
        name, size, _ = SIZES[shape_id]
        x, y, z = np.asarray(size) / 2
        top = SupportSurface(np.array([[-x, -y, z], [x, -y, z], [x, y, z], [-x, y, z]]), np.inf, interior=False)
        return Shape(
            id=shape_id,
            category=name,
            caption=f"{name} {shape_id[-1]}",
            size_m=size,
            surfaces=(top,) if name == "table" else (),
            content_hash=shape_id,
        )

    def in_category(self, category: str) -> tuple[Shape, ...]:
        return tuple(s for s in self.shapes() if s.category == category)

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        return self.parts(shape_id).to_geometry()

    def parts(self, shape_id: str) -> trimesh.Scene:
        PlainLibrary.shape(self, shape_id)  # says when there is none
        return _parts(shape_id)

    def glb(self, shape_id: str) -> bytes:
        return _glb(shape_id)


@cache
def _parts(shape_id: str) -> trimesh.Scene:
    """Made once, as libraries do."""
    name, size, colour = SIZES[shape_id]
    boxes = _chair(size) if name == "chair" else _table(size) if name == "table" else [(size, (0, 0, 0))]
    scene = trimesh.Scene()
    for extents, place in boxes:
        box = trimesh.creation.box(extents, trimesh.transformations.translation_matrix(place))
        box.unmerge_vertices()
        box.visual = trimesh.visual.TextureVisuals(
            material=PBRMaterial(baseColorFactor=[*colour, 255], metallicFactor=0.0, roughnessFactor=0.8)
        )
        scene.add_geometry(box)
    return scene


@cache
def _glb(shape_id: str) -> bytes:
    return bytes(PlainLibrary().parts(shape_id).export(file_type="glb"))


def _chair(size: tuple[float, float, float]) -> list:
    x, y, z = size
    legs = [
        ((0.04, 0.04, 0.5 * z), (sx * (x / 2 - 0.02), sy * (y / 2 - 0.02), -0.25 * z))
        for sx in (-1, 1)
        for sy in (-1, 1)
    ]
    return [*legs, ((x, y, 0.05), (0, 0, 0.02)), ((0.04, y, 0.5 * z), (-x / 2 + 0.02, 0, 0.25 * z))]


def _table(size: tuple[float, float, float]) -> list:
    x, y, z = size
    legs = [
        ((0.06, 0.06, z - 0.04), (sx * (x / 2 - 0.05), sy * (y / 2 - 0.05), -0.02)) for sx in (-1, 1) for sy in (-1, 1)
    ]
    return [*legs, ((x, y, 0.04), (0, 0, z / 2 - 0.02))]


def room_planes(width: float = 4.4, depth: float = 4.0, height: float = 2.5) -> tuple[Plane, ...]:
    """Floor, four walls and ceiling around the origin of x, from y = -0.6."""
    x, y0, y1 = width / 2, -0.6, depth - 0.6
    floor = np.array([[-x, y0, 0], [x, y0, 0], [x, y1, 0], [-x, y1, 0]])
    up = np.array([0.0, 0.0, height])
    walls = [np.array([b, a, a + up, b + up])[::-1] for a, b in zip(floor, np.roll(floor, -1, axis=0), strict=True)]
    planes = [Plane("floor", "floor", floor, colour=(0.72, 0.6, 0.47))]
    planes += [Plane(f"wall_{i + 1}", "wall", _inward(w), colour=(0.9, 0.89, 0.86)) for i, w in enumerate(walls)]
    planes.append(Plane("ceiling", "ceiling", (floor + up)[::-1], colour=(0.96, 0.96, 0.95)))
    return tuple(planes)


def _inward(polygon: np.ndarray) -> np.ndarray:
    plane = Plane("w", "wall", polygon)
    inside = np.array([0.0, 1.4, 1.25])
    return polygon if plane.normal @ (inside - plane.centre) > 0 else polygon[::-1]


def photo_camera(width: int = 640, height: int = 480) -> Camera:
    """At eye height near the front wall, looking along +Y and a little down."""
    pitch = np.radians(12.0)
    R = np.array([[1.0, 0, 0], [0, -np.sin(pitch), np.cos(pitch)], [0, -np.cos(pitch), -np.sin(pitch)]])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, (0.0, -0.4, 1.5)
    return Camera(Intrinsics.from_fov(width, height, np.radians(66.0)), T)


def furnished_scene() -> Scene:
    """A table with a lamp, two chairs and a picture on the wall."""
    table = _object("table_1", "dining table", "table_a", (0.1, 2.2, 0.37), yaw=-np.pi / 2)
    lamp = _object("lamp_1", "lamp", "lamp_a", (0.4, 2.3, 0.965))
    chair = _object("chair_1", "chair", "chair_a", (-0.9, 1.5, 0.43), yaw=0.4)
    other = _object("chair_2", "chair <b>by the window</b>", "chair_b", (1.2, 1.4, 0.4), yaw=2.6)
    picture = _object("picture_1", "picture", "picture_a", (0.0, 3.38, 1.5), yaw=-np.pi / 2)
    edges = (
        Support("table_1", "floor"),
        Support("lamp_1", "table_1"),
        Support("chair_1", "floor"),
        Support("chair_2", "floor"),
        Support("picture_1", "wall_3", "mounted on"),
    )
    return Scene(photo_camera(), Architecture(room_planes()), (table, lamp, chair, other, picture), edges)


def _object(object_id: str, label: str, shape_id: str, position: tuple, yaw: float = 0.0) -> SceneObject:
    library = PlainLibrary()
    shape = library.shape(shape_id)
    pose = Pose.upright(position, yaw)
    rivals = [shape, *(s for s in library.in_category(shape.category) if s.id != shape_id)]
    candidates = tuple(Candidate(s.id, s.size_m, 0.9 - 0.1 * i, pose) for i, s in enumerate(rivals))
    return SceneObject(object_id, label, shape.category, shape_id, shape.size_m, pose, candidates)


def plain_photo(width: int = 640, height: int = 480) -> Photo:
    """A gradient with a darker floor: enough of a picture for a test."""
    rows = np.linspace(235, 200, height)[:, None, None]
    rgb = np.broadcast_to(rows, (height, width, 3)).copy()
    rgb[int(0.55 * height) :] = (150, 120, 95)
    rgb[200:420, 240:440] = (120, 80, 50)
    return Photo(rgb.astype(np.uint8), "room.png", (width, height))


def make_project(folder: Path, scene: Scene | None = None) -> Project:
    """A project on disk with the furnished scene and its photo."""
    project = Project.create(folder, name=folder.name)
    saved = Project(Path(_saved_photo().name))
    shutil.copytree(saved.folder, project.folder, ignore=lambda *_: ["project.json"], dirs_exist_ok=True)
    project.update_info(**{key: value for key, value in saved.info().items() if key in ("photo", "warnings")})
    project.save_scene(scene or furnished_scene())
    return project


@cache
def _saved_photo() -> TemporaryDirectory:
    """A project with the photo alone: to pack it takes longer than most tests."""
    folder = TemporaryDirectory(prefix="diorama-tests-")
    box = LabelledBox((240.0, 200.0, 440.0, 420.0), "table", "dining table")
    Project.create(Path(folder.name)).save_inputs(Inputs(plain_photo(), (box,)))
    return folder
