from __future__ import annotations

import numpy as np

from diorama_core.scene.frames import FACE_NORMALS_OBJECT, FRONT_OBJECT, UP_OBJECT, UP_WORLD
from diorama_core.scene.types import Pose, box_corners


def test_faces_look_out_of_the_box_and_opposite_faces_away_from_each_other() -> None:
    normals = {name: np.array(n) for name, n in FACE_NORMALS_OBJECT.items()}
    for one, other in (("bottom", "top"), ("front", "back"), ("left", "right")):
        np.testing.assert_array_equal(normals[one], -normals[other])
    for normal in normals.values():
        face = box_corners((1.0, 2.0, 3.0)) @ normal
        assert (face == face.max()).sum() == 4
    np.testing.assert_array_equal(normals["front"], FRONT_OBJECT)
    np.testing.assert_array_equal(normals["top"], UP_OBJECT)


def test_frames_are_right_handed_and_upright_poses_keep_up() -> None:
    np.testing.assert_array_equal(np.cross(UP_OBJECT, FRONT_OBJECT), FACE_NORMALS_OBJECT["left"])
    pose = Pose.upright((0, 0, 0), 0.7)
    np.testing.assert_allclose(pose.R_world_object @ UP_OBJECT, UP_WORLD, atol=1e-12)
    np.testing.assert_allclose(pose.R_world_object @ FRONT_OBJECT, [np.cos(0.7), np.sin(0.7), 0.0])
