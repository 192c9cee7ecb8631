"""Shapes that stand on floors and tops stand by themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from diorama_core.export.gathering import gather
from diorama_core.export.stability import stability
from diorama_core.layout.exact import drift, stable_share
from diorama_core.library import taxonomy
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.furniture.solids import ball, box
from diorama_core.library.furniture.standing import lowered, seated
from diorama_core.library.record import Shape
from diorama_core.scene.types import Architecture, Pose, Scene, SceneObject, Support
from tests.primitives import box_room

WEIGHTED = {"floor-lamp-arc", "floor-lamp-arc-brass"}
"""Their feet are far heavier than a body of one density throughout."""
HUNG = {"sink-wall", "toilet-wall-hung", "towel-rail", "towel-rail-black", "towel-rail-brass"}
"""They hang on the wall, although their kinds mostly stand."""
LEANING = {
    f"pillow-{name}"
    for name in (
        *("checked", "kilim", "knit", "leather", "linen", "lumbar-grey", "navy-piped"),
        *("rust", "striped", "tartan", "tweed", "velvet"),
    )
}
"""Pillows are made as they lean against the back of a sofa."""
APART_M = 5.0
AT_ONCE = 60


def standing_shapes() -> list[Shape]:
    mounts = {s.category: taxonomy.resolve(s.category).category.mount for s in built_in_library().shapes()}
    return [s for s in built_in_library().shapes() if mounts[s.category] in {"floor", "surface"}]


def side_by_side(shapes: Sequence[Shape]) -> Scene:
    """One object of each shape on an open floor, far from one another."""
    floor = next(p for p in box_room().planes if p.role == "floor")
    across = int(np.ceil(np.sqrt(len(shapes))))
    objects = []
    for k, shape in enumerate(shapes):
        at = (APART_M * (k % across), APART_M * (k // across), floor.centre[2] + shape.size_m[2] / 2)
        pose = Pose.upright(at, 0.0)
        objects.append(SceneObject(shape.id, shape.category, shape.category, shape.id, shape.size_m, pose))
    return Scene(None, Architecture((floor,)), tuple(objects), tuple(Support(o.id, floor.id) for o in objects))


@pytest.mark.slow
def test_shapes_stand_by_themselves() -> None:
    """A tenth of them, and all that do not: their bodies take a minute to make. Kinds stand beside one another."""
    pytest.importorskip("mujoco", reason="an optional extra")
    shapes, moved = standing_shapes(), {}
    shapes = [s for k, s in enumerate(shapes) if k % 10 == 0 or s.id in WEIGHTED | HUNG | LEANING]
    for first in range(0, len(shapes), AT_ONCE):
        moved |= drift(side_by_side(shapes[first : first + AT_ONCE]), built_in_library(), seconds=1.0)
    assert len(moved) > 100
    assert {i for i, drifted in moved.items() if stable_share({i: drifted}) < 1.0} == WEIGHTED | HUNG | LEANING


def test_weighted_feet_and_soft_things_hold_in_exported_scenes() -> None:
    pytest.importorskip("mujoco", reason="an optional extra")
    shapes = [built_in_library().shape(i) for i in sorted(WEIGHTED | LEANING)]
    assert not stability(gather(side_by_side(shapes), built_in_library()), seconds=1.0).unstable


def test_feet_end_at_the_floor() -> None:
    tilted = box((0.1, 0.1, 0.5)).turned("y", 20.0).moved(z=0.3)
    after = lowered(tilted).vertices
    assert after[:, 2].min() == pytest.approx(0.0)
    assert np.ptp(after - tilted.vertices, axis=0) == pytest.approx(0.0)


def test_what_is_seated_is_flat_below_and_as_it_was_above() -> None:
    before = ball(0.2).moved(z=-0.02)
    after = seated(before)
    below = before.vertices[:, 2] < 0
    assert 0 < below.sum() < len(below)
    assert (after.vertices[below, 2] == 0.0).all()
    assert (after.normals[below] == (0.0, 0.0, -1.0)).all()
    assert np.array_equal(after.vertices[~below], before.vertices[~below])
