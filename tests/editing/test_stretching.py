from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.editing.stretching import HANDLES, Handle, handle_place, pull_m, stretch
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from tests.app.small_room import furnished_scene

SCENE = furnished_scene()
BY_NAME = {h.name: h for h in HANDLES}


@given(st.sampled_from([h for h in HANDLES if h.axis is not None]), st.floats(-0.3, 1.0))
def test_the_opposite_face_stays(handle: Handle, by_m: float) -> None:
    before = SCENE.object("chair_1")
    after = stretch(SCENE, "chair_1", handle, by_m, snap=False).object("chair_1")
    opposite = -np.asarray(handle.along)
    faces = [o.pose.apply(opposite * np.asarray(o.shape_size_m) / 2) for o in (before, after)]
    np.testing.assert_allclose(*faces, atol=1e-9)
    axis = handle.axis
    assert after.size_m[axis] == pytest.approx(before.size_m[axis] + by_m)
    others = [k for k in range(3) if k != axis]
    np.testing.assert_allclose(after.size_m[others], before.size_m[others])


def test_what_stands_on_it_rises_with_the_top_and_stays_otherwise() -> None:
    lamp = SCENE.object("lamp_1").pose.position
    higher = stretch(SCENE, "table_1", BY_NAME["top"], 0.2, snap=False).object("lamp_1").pose.position
    np.testing.assert_allclose(higher - lamp, (0.0, 0.0, 0.2), atol=1e-9)
    wider = stretch(SCENE, "table_1", BY_NAME["left"], 0.4, snap=False).object("lamp_1").pose.position
    np.testing.assert_allclose(wider, lamp, atol=1e-9)


def test_the_corner_keeps_proportions_and_the_base() -> None:
    before = SCENE.object("table_1")
    after = stretch(SCENE, "table_1", BY_NAME["corner"], 0.3, snap=False).object("table_1")
    ratio = after.size_m / before.size_m
    np.testing.assert_allclose(ratio, ratio[0])
    assert ratio[0] > 1.1
    assert after.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(after.pose.position[:2], before.pose.position[:2], atol=1e-9)


def test_snapping_keeps_to_five_centimetres_and_nothing_vanishes() -> None:
    snapped = stretch(SCENE, "chair_1", BY_NAME["front"], 0.083, snap=True).object("chair_1")
    assert snapped.size_m[0] == pytest.approx(0.6)
    flat = stretch(SCENE, "chair_1", BY_NAME["top"], -5.0, snap=False).object("chair_1")
    assert flat.size_m[2] == pytest.approx(0.01)


def test_the_hand_on_a_ray_says_how_far() -> None:
    item = SCENE.object("table_1")
    for handle in HANDLES:
        grabbed = item.pose.position + item.pose.R_world_object @ handle_place(item, handle, 0.04)
        outward = item.pose.R_world_object @ (np.asarray(handle.along) * item.size_m)
        outward /= np.linalg.norm(outward)
        eye = np.array([2.0, -3.0, 2.4])
        pulled = pull_m(item, handle, grabbed, eye, grabbed + 0.17 * outward - eye)
        assert pulled == pytest.approx(0.17, abs=1e-9), handle.name


def test_locked_objects_keep_their_size() -> None:
    scene = edits.set_locked(SCENE, "chair_1", True)
    with pytest.raises(EditRefused, match="locked"):
        stretch(scene, "chair_1", BY_NAME["top"], 0.1, snap=False)
