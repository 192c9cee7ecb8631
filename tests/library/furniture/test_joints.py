"""Everything that moves opens all the way without running into the rest of its shape."""

from __future__ import annotations

import manifold3d
import numpy as np
import pytest
import trimesh

from diorama_core.library import furniture
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.furniture.articulation import Articulation, articulation
from diorama_core.library.furniture.joints import Joint
from diorama_core.library.furniture.solids import Solid, places

FAMILIES = (
    "dresser", "sideboard", "cabinet", "wardrobe", "night stand", "tv stand", "door", "laptop", "office chair",
    "desk", "vanity table", "filing cabinet", "locker", "chest", "box", "wall cabinet", "kitchen counter",
    "kitchen island", "refrigerator", "dishwasher", "wall oven", "stove", "microwave", "washing machine", "dryer",
)  # fmt: skip
STEPS = (0.05, 0.3, 0.6, 1.0)
TOUCH_M3 = 3e-6
"""What may be shared beyond what is shared at rest: 3 cubic centimetres."""


def moving_designs(category: str) -> list[str]:
    """Asked within tests: to take every shape apart takes seconds, which each process would spend before its first."""
    return [d.id for d in furniture.designs() if d.category == category and articulation(d.id) is not None]


def posed(joint: Joint, share: float) -> np.ndarray:
    """The motion of a joint that is open by a share of its range."""
    if joint.kind == "slide":
        return trimesh.transformations.translation_matrix(np.asarray(joint.axis) * joint.upper * share)
    angle = 2 * np.pi * share if joint.kind == "swivel" else joint.upper * share
    return trimesh.transformations.rotation_matrix(angle, joint.axis, joint.origin)


def closed(solids: tuple[Solid, ...]) -> list[manifold3d.Manifold]:
    found = []
    for solid in solids:
        first, number = places(solid.vertices)
        faces = number[solid.faces].astype(np.uint32)
        made = manifold3d.Manifold(manifold3d.Mesh(solid.vertices[first].astype(np.float32), faces))
        if made.status() == manifold3d.Error.NoError and not made.is_empty():
            found.append(made)
    assert len(found) >= 0.8 * len(solids), "too few of the solids are closed to tell"
    return found


@pytest.mark.parametrize("category", FAMILIES)
def test_every_family_has_shapes_that_open_without_collision(category: str) -> None:
    moving = {shape_id: articulation(shape_id) for shape_id in moving_designs(category)}
    assert moving
    forms = {
        (pieces.joints, b"".join(s.vertices.tobytes() for _, s in pieces.solids)): (shape_id, pieces)
        for shape_id, pieces in moving.items()
        if pieces is not None
    }
    for shape_id, pieces in forms.values():  # designs that differ in colour only are one form
        opens_without_collision(shape_id, pieces)


def shared_m3(others: list[manifold3d.Manifold], moving: manifold3d.Manifold) -> float:
    """What a part shares with others, one by one; those whose boxes are apart share nothing."""
    low, high = np.split(np.array(moving.bounding_box()), 2)
    boxes = np.array([other.bounding_box() for other in others]).reshape(-1, 2, 3)
    near = ((boxes[:, 0] <= high) & (low <= boxes[:, 1])).all(axis=1)
    return sum(max(float((others[k] ^ moving).volume()), 0.0) for k in np.flatnonzero(near))


def opens_without_collision(shape_id: str, pieces: Articulation) -> None:
    groups = {k: closed(pieces.of_joint(k)) for k in (None, *range(len(pieces.joints)))}
    for number, joint in enumerate(pieces.joints):
        others = [made for k, group in groups.items() if k != number for made in group]
        moving = manifold3d.Manifold.batch_boolean(groups[number], manifold3d.OpType.Add)
        for share in STEPS:
            shared = shared_m3(others, moving.transform(posed(joint, share)[:3]))
            if shared > TOUCH_M3:  # most share nothing: then what they share at rest is not asked
                touching = shared_m3(others, moving)
                said = f"{shape_id}: {joint.name} at {share:.0%}: {1e6 * (shared - touching):.0f} cm3"
                assert shared <= touching + TOUCH_M3, said


@pytest.mark.parametrize("category", ["door", "office chair"])
def test_every_door_opens_and_every_office_chair_turns(category: str) -> None:
    assert len(moving_designs(category)) == len(built_in_library().in_category(category))


def test_the_parts_together_are_the_shape() -> None:
    """Closed, the moving parts lie within the box of the whole and reach all its sides."""
    library = built_in_library()
    for shape_id in ("dresser-oak-six", "office-chair-mesh-black"):
        pieces = articulation(shape_id)
        assert pieces is not None
        points = np.concatenate([s.vertices for _, s in pieces.solids])
        half = np.asarray(library.shape(shape_id).size_m) / 2
        np.testing.assert_allclose(points.min(axis=0), -half, atol=1e-6)
        np.testing.assert_allclose(points.max(axis=0), half, atol=1e-6)


def test_a_drawer_comes_out_with_its_box() -> None:
    pieces = articulation("dresser-oak-six")
    assert pieces is not None
    drawers = [j for j in pieces.joints if j.kind == "slide"]
    assert [j.name for j in drawers] == [f"drawer {k}" for k in range(1, 7)]
    assert all(0.2 < j.upper < 0.45 and j.axis == (1.0, 0.0, 0.0) for j in drawers)
    box = np.concatenate([s.vertices for s in pieces.of_joint(0)])
    assert np.ptp(box[:, 0]) > 0.3


def test_shapes_without_moving_parts_have_no_articulation() -> None:
    assert articulation("rug-persian-red") is None
    assert articulation("not a shape") is None
