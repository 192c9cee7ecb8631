from __future__ import annotations

import numpy as np
import pytest

from diorama_core.multiview.sphere_room import SphereRoom
from diorama_core.multiview.sphere_scene import sphere_planes
from tests.multiview.spheres import BOX


def test_planes_look_into_the_room_and_share_corners() -> None:
    room = sphere_planes(SphereRoom(BOX, 0.8, np.array([0.7, 0.1, 0.7, 0.7])), 1.5)
    middle = np.array([0.1, 0.1, 1.4])
    assert all(float(p.normal @ middle) > p.offset for p in room.planes)
    assert [w.seen for w in room.by_role("wall")] == [True, False, True, True]
    assert room.by_role("ceiling")[0].polygon[:, 2] == pytest.approx(1.5 * 1.8)
