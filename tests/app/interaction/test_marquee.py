from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diorama_app.interaction.marquee import objects_in
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene

SCENE = furnished_scene()
CAMERA = SCENE.camera
VIEW = (CAMERA.T_world_camera[:3, :3], CAMERA.position, CAMERA.intrinsics.vertical_fov_rad, 640 / 480)
share = st.floats(0, 1)


@given(share, share, share, share)
def test_a_frame_takes_in_what_has_its_middle_inside(x1, y1, x2, y2) -> None:
    low, high = (min(x1, x2), min(y1, y2)), (max(x1, x2), max(y1, y2))
    found = objects_in(SCENE, low, high, *VIEW)
    pixels = {o.id: CAMERA.project(o.pose.position) / [640, 480] for o in SCENE.objects}
    inside = {i for i, p in pixels.items() if (p > np.array(low) + 1e-9).all() and (p < np.array(high) - 1e-9).all()}
    outside = {i for i, p in pixels.items() if (p < np.array(low) - 1e-9).any() or (p > np.array(high) + 1e-9).any()}
    assert inside <= set(found)
    assert not outside & set(found)


def test_hidden_objects_and_those_behind_are_left_out() -> None:
    whole = ((-100.0, -100.0), (100.0, 100.0))
    assert set(objects_in(SCENE, *whole, *VIEW)) == {o.id for o in SCENE.objects}
    hidden = Scene(SCENE.camera, SCENE.architecture, tuple(replace(o, hidden=True) for o in SCENE.objects))
    assert objects_in(hidden, *whole, *VIEW) == ()
    backward = VIEW[0] @ np.diag([-1.0, 1.0, -1.0])
    assert objects_in(SCENE, *whole, backward, *VIEW[1:]) == ()
