"""A large scene with any number of visible objects: build cost as a function of the number of objects."""

from __future__ import annotations

import numpy as np

from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.scene.types import Camera, Intrinsics, Pose, Scene, SceneObject, Support, yaw_rotation
from diorama_core.synthesis.cameras import level_pose
from diorama_core.synthesis.layout_rooms import room_box

KINDS = ("armchair", "chair", "stool", "plant", "night stand", "chest")
SHAPES_PER_KIND = 4
CELL_M = 1.3
MIN_SIZE_M = 0.45
PICTURE = (960, 720)


def large_scene(library: ShapeLibrary, count: int, seed: int) -> tuple[Scene, Camera]:
    """Objects in rows on the floor of a room as large as necessary, and a camera high on a wall that sees them all."""
    rng = np.random.default_rng((seed, count))
    across = int(np.ceil(np.sqrt(count)))
    side = CELL_M * across + 1.5
    shapes = _shapes(library)
    objects = []
    for k in range(count):
        shape = shapes[int(rng.integers(len(shapes)))]
        cell = np.array([k % across + 0.5, k // across + 0.5]) * CELL_M - CELL_M * across / 2
        position = np.array([*(cell + rng.uniform(-0.1, 0.1, 2)), shape.size_m[2] / 2])
        pose = Pose(yaw_rotation(float(rng.uniform(0, 2 * np.pi))), position, np.ones(3))
        name = f"{shape.category}_{k}"
        objects.append(SceneObject(name, shape.category, shape.category, shape.id, shape.size_m, pose))
    supports = tuple(Support(o.id, "floor", "placed on") for o in objects)
    scene = Scene(objects=tuple(objects), architecture=room_box(side, side, max(2.6, 0.7 * side)), supports=supports)
    eye = np.array([0.0, 0.15 - side / 2, max(1.6, 0.6 * side)])
    pitch = float(np.arctan2(eye[2] - 0.3, side / 2))
    return scene, Camera(Intrinsics.from_fov(*PICTURE, 1.25), level_pose(eye, np.pi / 2, pitch))


def _shapes(library: ShapeLibrary) -> list[Shape]:
    chosen: list[Shape] = []
    for kind in KINDS:
        large = [s for s in library.in_category(kind) if max(s.size_m) >= MIN_SIZE_M]
        chosen += large[:: max(1, len(large) // SHAPES_PER_KIND)][:SHAPES_PER_KIND]
    return chosen
