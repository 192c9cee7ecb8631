"""Hypothesis strategies for scenes and edits of them."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from diorama_core.scene.types import (
    Architecture,
    Camera,
    Candidate,
    Intrinsics,
    PhotoMaterial,
    Plane,
    Pose,
    RoomLight,
    Scene,
    SceneObject,
    Support,
    SurfaceFinish,
)

numbers = st.floats(-5, 5, allow_nan=False)
scales = st.floats(0.2, 3.0)
sizes = st.tuples(*[st.floats(0.05, 2.0)] * 3)
colours = st.tuples(*[st.floats(0, 1)] * 3)
texts = st.text(st.characters(exclude_categories=("Cs", "Cc")), max_size=12)
"""What `diorama_core.io.text.clean_text` leaves as it is: all text in scenes went through it."""
words = texts.filter(lambda s: s.strip() != "")


@st.composite
def rotations(draw: st.DrawFn) -> np.ndarray:
    q = np.array(draw(st.tuples(*[st.floats(-1, 1)] * 4)))
    q = q / np.linalg.norm(q) if np.linalg.norm(q) > 1e-3 else np.array([1.0, 0, 0, 0])
    w, x, y, z = q
    R = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    u, _, vt = np.linalg.svd(R)
    return u @ vt


@st.composite
def poses(draw: st.DrawFn) -> Pose:
    position, scale = draw(st.tuples(numbers, numbers, numbers)), draw(st.tuples(scales, scales, scales))
    return Pose(draw(rotations()), np.array(position), np.array(scale))


@st.composite
def candidates(draw: st.DrawFn) -> Candidate:
    return Candidate(draw(words), draw(sizes), draw(st.floats(0, 1)), draw(poses()))


@st.composite
def objects(draw: st.DrawFn, object_id: str) -> SceneObject:
    return SceneObject(
        id=object_id,
        label=draw(words),
        category=draw(st.sampled_from(["chair", "table", "lamp"])),
        shape_id=draw(words),
        shape_size_m=draw(sizes),
        pose=draw(poses()),
        candidates=tuple(draw(st.lists(candidates(), max_size=2))),
        mask_id=draw(st.none() | st.integers(1, 99)),
        box_px=draw(st.none() | st.just((1.0, 2.5, 30.25, 44.0))),
        confidence=draw(st.floats(0, 1)),
        hidden=draw(st.booleans()),
        colour=draw(st.none() | colours),
        finish=draw(st.sampled_from([None, "matt", "satin", "gloss", "metal"])),
        photo_materials=tuple(draw(st.lists(photo_materials(), max_size=2))),
        material_source=draw(st.sampled_from(["photo", "library"])),
    )


def photo_materials() -> st.SearchStrategy[PhotoMaterial]:
    return st.builds(
        PhotoMaterial,
        slot=st.sampled_from(["fabric", "wood 2", "picture"]),
        colour=colours,
        texture=st.none() | st.just("chair-1-fabric-0a1b2c3d"),
        layout=st.sampled_from(["front", "top", "tiled"]),
        tile_m=st.floats(0.01, 5.0),
        roughness=st.floats(0, 1),
        metallic=st.floats(0, 1),
        main=st.booleans(),
    )


FLOOR = Plane(
    "floor",
    "floor",
    np.array([[-2.0, 0, 0], [2, 0, 0], [2, 4, 0], [-2, 4, 0]]),
    finish=SurfaceFinish("boards", (0.7, 0.5, 0.3), 1.5, 0.3),
    photo_colour=(0.4, 0.4, 0.4),
    photo_texture="floor",
)
WALL = Plane("wall_1", "wall", np.array([[-2.0, 4, 0], [2, 4, 0], [2, 4, 2.5], [-2, 4, 2.5]]))
CAMERA = Camera(
    Intrinsics(640, 480, 520.5, 521.25, 320.0, 240.0),
    np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 1.4], [0, 0, 0, 1]]),
)


@st.composite
def scenes(draw: st.DrawFn, max_objects: int = 5) -> Scene:
    """A valid scene: every object stands on the floor, on an earlier object, or is loose."""
    items = tuple(draw(objects(f"item_{i}")) for i in range(draw(st.integers(0, max_objects))))
    supports = []
    for i, item in enumerate(items):
        parents = ["floor", *(earlier.id for earlier in items[:i])]
        parent = draw(st.none() | st.sampled_from(parents))
        if parent is not None:
            walls = draw(st.sampled_from([(), ("wall_1",)]))
            supports.append(Support(item.id, parent, "placed on", draw(st.none() | st.integers(0, 3)), "bottom", walls))
    return Scene(
        camera=draw(st.sampled_from([None, CAMERA])),
        architecture=Architecture((FLOOR, WALL)),
        objects=items,
        supports=tuple(supports),
        metrics=draw(st.sampled_from([(), (("penetration_m", 0.125),)])),
        light=draw(st.sampled_from([None, RoomLight((0.0, 0.6, 0.8), 0.4, (1.0, 0.9, 0.8))])),
    )
