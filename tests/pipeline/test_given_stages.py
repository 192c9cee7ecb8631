"""What is known of all photos, as stages of one."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import Cuboid, Inputs, ObjectGeometry, Photo
from diorama_core.pipeline.given_stages import AsObserved, GivenCamera, GivenRoom, exact_camera_estimate
from diorama_core.progress import Progress
from diorama_core.provenance import ScaleSource
from diorama_core.scene.types import Scene, Support
from tests.multiview.rooms import camera
from tests.multiview.test_joint_room import NORTH

GREY = Inputs(Photo(np.full((48, 64, 3), 128, np.uint8), "grey.png", (64, 48)))


def test_a_known_camera_is_the_only_reading() -> None:
    one = camera(0.0, -2.0, height_m=1.4)
    found = GivenCamera(one).estimate(GREY, Progress())
    assert len(found.hypotheses) == 1
    assert found.height_m == exact_camera_estimate(one).height_m == pytest.approx(1.4)
    np.testing.assert_array_equal(found.best.R_world_camera, one.T_world_camera[:3, :3])


def test_things_hang_and_stand_in_the_known_room() -> None:
    picture = Cuboid("picture", np.eye(3), np.array([0.5, 1.98, 1.5]), np.array([0.04, 0.8, 0.6]), 1.0)
    table = Cuboid("table", np.eye(3), np.array([0.0, 0.0, 0.4]), np.array([0.8, 1.2, 0.8]), 1.0)
    edges = (Support("picture", "wall", "mounted on"), Support("table", "floor"))
    geometry = ObjectGeometry(NORTH.camera, (picture, table), edges, ScaleSource.GIVEN, 1.0)
    found = GivenRoom(NORTH.architecture, ("gap",)).reconstruct(GREY, (), geometry, Progress())
    assert found.architecture is NORTH.architecture
    assert {s.child: s.parent for s in found.supports} == {"picture": "wall_1", "table": "floor"}
    assert found.openings == ("gap",)
    assert (found.source.walls_found, found.source.walls_assumed) == (2, 0)


def test_no_layout_leaves_the_scene() -> None:
    scene = Scene()
    assert AsObserved().optimise(scene, Progress())[0] is scene
