from __future__ import annotations

import numpy as np
import pytest

from diorama_core.export.limbs import limb_of
from diorama_core.library.furniture.joints import drawer_slide
from diorama_core.scene.types import Pose, SceneObject


def test_a_stretched_drawer_comes_out_farther() -> None:
    pose = Pose.upright((0.0, 0.0, 0.5), 0.0, (2.0, 1.0, 3.0))
    item = SceneObject("d", "dresser", "dresser", "dresser-oak-six", (0.5, 1.0, 1.0), pose)
    limb = limb_of(item, drawer_slide(0.1, 0.2, 0.3, 0.4), 0, "mesh")
    np.testing.assert_allclose(limb.origin, [0.2, 0.2, 0.9])
    np.testing.assert_allclose(limb.axis, [1.0, 0.0, 0.0])
    assert limb.upper == pytest.approx(0.8)
