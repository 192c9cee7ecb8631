from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from diorama_core.export.colliders import body_of
from diorama_core.export.limbs import ExportLimb, limb_of
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.furniture.joints import drawer_slide
from diorama_core.scene.types import Pose, Scene, SceneObject


def test_a_stretched_drawer_comes_out_farther() -> None:
    pose = Pose.upright((0.0, 0.0, 0.5), 0.0, (2.0, 1.0, 3.0))
    item = SceneObject("d", "dresser", "dresser", "dresser-oak-six", (0.5, 1.0, 1.0), pose)
    limb = limb_of(item, drawer_slide(0.1, 0.2, 0.3, 0.4), 0, "mesh")
    np.testing.assert_allclose(limb.origin, [0.2, 0.2, 0.9])
    np.testing.assert_allclose(limb.axis, [1.0, 0.0, 0.0])
    assert limb.upper == pytest.approx(0.8)


def leaves_of(shape: str) -> list[tuple[np.ndarray, ExportLimb]]:
    """Corners of each leaf's convex bodies, closed, and how it turns."""
    library = built_in_library()
    record = library.shape(shape)
    item = SceneObject("a", "a", record.category, shape, record.size_m, Pose.upright((0.0, 0.0, 1.0), 0.0))
    moving = body_of(Scene(objects=(item,)), library, "a").moving
    return [(np.concatenate(m.parts), m.limb) for m in moving if m.limb.kind == "hinge"]


@pytest.mark.parametrize("shape", ["refrigerator-retro-blue", "refrigerator-double", "wardrobe-white-two"])
def test_a_door_that_is_flush_with_a_wall_turns_past_it(shape: str) -> None:
    for points, limb in leaves_of(shape):
        turns = (Rotation.from_rotvec(angle * limb.axis) for angle in np.linspace(limb.lower, limb.upper, 60))
        corners = points - limb.origin
        away = np.sign(corners.mean(axis=0)[1])
        assert (
            max(float((away * turn.apply(corners)[:, 1]).max()) for turn in turns) < (away * corners[:, 1]).max() + 5e-4
        )


def test_a_handle_does_not_hold_the_other_leaf_shut() -> None:
    """Its bar reaches over the edge of its leaf."""
    (left, _), (right, _) = leaves_of("sideboard-rustic")
    assert right[:, 1].max() < left[:, 1].min()
