"""A scene of 500 objects and two million triangles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import trimesh

from diorama_core.errors import LibraryError
from diorama_core.library.record import Shape
from diorama_core.scene.types import Pose, Scene, SceneObject, Support
from tests.primitives import box_room, eye_camera, material

OBJECTS, SHAPES = 500, 50


@dataclass(frozen=True)
class BumpyLibrary:
    """Fifty bumpy balls of about 4,000 triangles each, in two materials."""

    @cache  # noqa: B019 (one library lives as long as the test run)
    def parts(self, shape_id: str) -> trimesh.Scene:
        if not shape_id.startswith("ball"):
            raise LibraryError(f"there is no shape {shape_id!r} in the library")
        seed = int(shape_id.removeprefix("ball"))
        ball = trimesh.creation.uv_sphere(0.25, (32, 34))
        ball.vertices *= 1 + 0.02 * np.sin((5 + seed % 7) * ball.vertices * 8).sum(axis=1, keepdims=True)
        ball.vertices -= ball.bounds.mean(axis=0)
        high = ball.triangles_center[:, 2] > 0
        pieces = {}
        for name, faces in (("upper", high), ("lower", ~high)):
            piece = ball.submesh([faces], append=True)
            look = material(f"{name} {seed}", (0.1 + 0.015 * seed, 0.4, 0.3))
            piece.visual = trimesh.visual.TextureVisuals(uv=piece.vertices[:, :2], material=look)
            pieces[name] = piece
        return trimesh.Scene(pieces)

    def shapes(self) -> tuple[Shape, ...]:
        return tuple(self.shape(f"ball{n}") for n in range(SHAPES))

    def shape(self, shape_id: str) -> Shape:
        x, y, z = (float(e) for e in self.parts(shape_id).extents)
        return Shape(shape_id, "toy", f"bumpy {shape_id}", (x, y, z), content_hash=shape_id)

    def in_category(self, category: str) -> tuple[Shape, ...]:
        return tuple(s for s in self.shapes() if s.category == category)

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        return self.parts(shape_id).to_geometry()

    def glb(self, shape_id: str) -> bytes:
        return self.parts(shape_id).export(file_type="glb")


def large_scene(library: BumpyLibrary, count: int = OBJECTS) -> Scene:
    """The balls in rows on the floor of a hall."""
    side = int(np.ceil(np.sqrt(count)))
    objects = []
    for number in range(count):
        shape = library.shape(f"ball{number % SHAPES}")
        place = (0.7 * (number % side) - 0.35 * side, 0.7 * (number // side) + 0.4, shape.size_m[2] / 2)
        objects.append(SceneObject(f"o{number}", "ball", "toy", shape.id, shape.size_m, Pose.upright(place, number)))
    room = box_room(0.7 * side + 1, 0.7 * side + 1, 3.0)
    return Scene(eye_camera(), room, tuple(objects), tuple(Support(o.id, "floor") for o in objects))
