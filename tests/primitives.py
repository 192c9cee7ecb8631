"""A small shape library over trimesh primitives, for tests that need real shapes but not the built-in furniture."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache

import numpy as np
import trimesh
from PIL import Image
from trimesh.visual.material import PBRMaterial
from trimesh.visual.texture import TextureVisuals

from diorama_core.errors import LibraryError
from diorama_core.library.record import Shape, SupportSurface
from diorama_core.scene.types import (
    Architecture,
    Camera,
    Intrinsics,
    Plane,
    Pose,
    Scene,
    SceneObject,
    Support,
)


def material(name: str, colour: tuple[float, float, float], **more: object) -> PBRMaterial:
    return PBRMaterial(name=name, baseColorFactor=[*colour, 1.0], metallicFactor=0.0, roughnessFactor=0.7, **more)


def _painted(mesh: trimesh.Trimesh, look: PBRMaterial, uv: np.ndarray | None = None) -> trimesh.Trimesh:
    mesh.visual = TextureVisuals(uv=uv, material=look)
    return mesh


def _block(size: tuple[float, float, float], centre: tuple[float, float, float]) -> trimesh.Trimesh:
    return trimesh.creation.box(extents=size, transform=trimesh.transformations.translation_matrix(centre))


def _table() -> trimesh.Scene:
    wood, metal = material("wood", (0.45, 0.25, 0.12)), material("metal", (0.1, 0.1, 0.1))
    parts = {"top": _painted(_block((0.8, 1.4, 0.04), (0, 0, 0.34)), wood)}
    for x in (-0.36, 0.36):
        for y in (-0.66, 0.66):
            parts[f"leg {x} {y}"] = _painted(_block((0.05, 0.05, 0.68), (x, y, -0.02)), metal)
    return trimesh.Scene(parts)


def _chair() -> trimesh.Scene:
    fabric = material("fabric", (0.1, 0.25, 0.45))
    return trimesh.Scene(
        {
            "seat": _painted(_block((0.5, 0.5, 0.45), (0, 0, -0.225)), fabric),
            "back": _painted(_block((0.1, 0.5, 0.45), (-0.2, 0, 0.225)), material("oak", (0.5, 0.35, 0.2))),
        }
    )


def _ball() -> trimesh.Scene:
    return trimesh.Scene({"ball": _painted(trimesh.creation.icosphere(3, 0.1), material("red", (0.7, 0.05, 0.05)))})


def _print() -> trimesh.Scene:
    """A thin upright panel whose front carries a picture: left half red, right half green, a blue bar on top."""
    pixels = np.zeros((64, 64, 3), np.uint8)
    pixels[:, :32], pixels[:, 32:], pixels[:16] = (220, 20, 20), (20, 200, 20), (20, 20, 220)
    y, z = np.array([-0.4, 0.4, 0.4, -0.4]), np.array([-0.3, -0.3, 0.3, 0.3])
    front = trimesh.Trimesh(np.stack([np.full(4, 0.01), y, z], 1), [[1, 2, 0], [2, 3, 0]][::-1], process=False)
    if front.face_normals[0, 0] < 0:
        front.invert()
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    look = material("print", (1.0, 1.0, 1.0), baseColorTexture=Image.fromarray(pixels))
    back = _painted(_block((0.015, 0.8, 0.6), (-0.0025, 0, 0)), material("frame", (0.05, 0.05, 0.05)))
    return trimesh.Scene({"back": back, "front": _painted(front, look, uv)})


def _build(shape_id: str) -> trimesh.Scene:
    builders = {"table": _table, "chair": _chair, "ball": _ball, "print": _print}
    if shape_id not in builders:
        raise LibraryError(f"there is no shape {shape_id!r} in the library")
    return builders[shape_id]()


@cache
def _shape(shape_id: str) -> Shape:
    extents = _build(shape_id).extents
    category = {"ball": "toy", "print": "picture"}.get(shape_id, shape_id)
    top = 0.36 if shape_id == "table" else float(extents[2] / 2)
    x, y = extents[0] / 2, extents[1] / 2
    corners = [[-x, -y, top], [x, -y, top], [x, y, top], [-x, y, top]]
    return Shape(
        id=shape_id,
        category=category,
        caption=f"plain {shape_id}",
        size_m=tuple(float(e) for e in extents),
        surfaces=(SupportSurface(np.array(corners), float("inf"), interior=False),),
        content_hash=hashlib.sha256(shape_id.encode()).hexdigest(),
    )


@dataclass(frozen=True)
class PrimitiveLibrary:
    """table, chair, ball and print, built from boxes and spheres."""

    def shapes(self) -> tuple[Shape, ...]:
        return tuple(self.shape(s) for s in ("table", "chair", "ball", "print"))

    def shape(self, shape_id: str) -> Shape:
        return _shape(shape_id)

    def in_category(self, category: str) -> tuple[Shape, ...]:
        return tuple(s for s in self.shapes() if s.category == category)

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        return _build(shape_id).to_geometry()

    def parts(self, shape_id: str) -> trimesh.Scene:
        return _build(shape_id)

    def glb(self, shape_id: str) -> bytes:
        return _build(shape_id).export(file_type="glb")


def place(library: PrimitiveLibrary, object_id: str, shape_id: str, position: tuple[float, float, float], **more):
    """One object of a scene; `yaw` and `scale` as for `Pose.upright`, the rest as for `SceneObject`."""
    shape = library.shape(shape_id)
    pose = Pose.upright(position, more.pop("yaw", 0.0), more.pop("scale", (1.0, 1.0, 1.0)))
    return SceneObject(object_id, more.pop("label", shape_id), shape.category, shape_id, shape.size_m, pose, **more)


def box_room(width: float = 4.0, depth: float = 5.0, height: float = 2.6) -> Architecture:
    """A closed room: x from -width/2 to width/2, y from 0 to depth."""
    x, y, z = width / 2, depth, height
    floor = [[-x, 0, 0], [x, 0, 0], [x, y, 0], [-x, y, 0]]
    return Architecture(
        (
            Plane("floor", "floor", np.array(floor), colour=(0.62, 0.5, 0.38)),
            Plane("ceiling", "ceiling", np.array(floor)[::-1] + np.array([0, 0, z]), colour=(0.95, 0.95, 0.95)),
            Plane("back", "wall", np.array([[-x, y, 0], [x, y, 0], [x, y, z], [-x, y, z]])),
            Plane("left", "wall", np.array([[-x, 0, 0], [-x, y, 0], [-x, y, z], [-x, 0, z]])),
            Plane("right", "wall", np.array([[x, y, 0], [x, 0, 0], [x, 0, z], [x, y, z]])),
            Plane("front", "wall", np.array([[x, 0, 0], [-x, 0, 0], [-x, 0, z], [x, 0, z]])),
        )
    )


def eye_camera(width: int = 320, height: int = 240, fov_deg: float = 65.0) -> Camera:
    """At 1.5 m, half a metre into the room, looking along +Y and a little down."""
    tilt = np.radians(10.0)
    z = np.array([0.0, np.cos(tilt), -np.sin(tilt)])
    x = np.array([1.0, 0.0, 0.0])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.stack([x, np.cross(z, x), z], axis=1), [0.0, 0.3, 1.5]
    return Camera(Intrinsics.from_fov(width, height, np.radians(fov_deg)), T)


def furnished_room(library: PrimitiveLibrary) -> Scene:
    """A table with a ball on it, two chairs (one turned and stretched), and a picture on the back wall."""
    objects = (
        place(library, "t", "table", (0.2, 3.0, 0.36), yaw=np.pi / 2),
        place(library, "c1", "chair", (-1.2, 2.6, 0.45), yaw=0.3),
        place(library, "c2", "chair", (1.4, 3.8, 0.54), yaw=-2.2, scale=(1.0, 1.0, 1.2), colour=(0.8, 0.5, 0.1)),
        place(library, "b", "ball", (0.4, 3.1, 0.82)),
        place(library, "p", "print", (-0.6, 4.98, 1.6), yaw=-np.pi / 2, scale=(1.0, 1.3, 1.3)),
    )
    supports = (
        Support("t", "floor"),
        Support("c1", "floor"),
        Support("c2", "floor"),
        Support("b", "t"),
        Support("p", "back", "mounted on", child_face="back"),
    )
    return Scene(eye_camera(), box_room(), objects, supports)
