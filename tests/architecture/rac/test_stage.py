from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.rac.stage import RenderAndCompareRoom
from diorama_core.errors import InputError
from diorama_core.evaluation.metrics.architecture import architecture_scores
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod
from diorama_core.scene.types import Plane
from tests.synthetic_rooms import box_room, cuboid, floor, look, shoot, wall

FURNITURE = (cuboid("cabinet", (-1.0, 2.5, 0), (0.6, 1.0, 0.8)), cuboid("stand", (0.8, 2.2, 0), (0.5, 0.5, 0.9)))


def found(shot):
    return RenderAndCompareRoom().reconstruct(shot.inputs, shot.objects, shot.geometry, Progress())


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_a_box_room_is_explained_behind_its_furniture(noise):
    shot = shoot(look(15, 5, fov_deg=75), box_room(-1.8, 2.2, 4.0, 2.6), FURNITURE, noise=noise)
    estimate = found(shot)
    scores = architecture_scores(estimate.architecture.planes, shot.planes, shot.camera)
    assert scores.iou > 0.9
    assert scores.pixel_error < 0.05
    assert estimate.source.method == RoomMethod.RENDER_AND_COMPARE
    assert estimate.source.walls_found == len(estimate.architecture.by_role("wall")) >= 2
    assert estimate == found(shot)


def test_a_wall_that_ends_before_another_hides_it():
    corner = (
        floor((-2, -3), (2, -3), (2, 3), (0.9, 3), (0.9, 5), (-2, 5)),
        wall("far", (-2, 5), (0.9, 5), 2.5),
        wall("side", (0.9, 5), (0.9, 3), 2.5),
        wall("near", (0.9, 3), (2, 3), 2.5),
        wall("left", (-2, -3), (-2, 5), 2.5),
        Plane("ceiling", "ceiling", np.array([[-2, -3, 2.5], [-2, 5, 2.5], [2, 5, 2.5], [2, -3, 2.5]], float)),
    )
    shot = shoot(look(-5, 8, fov_deg=75), corner)
    scores = architecture_scores(found(shot).architecture.planes, shot.planes, shot.camera)
    assert scores.pixel_error < 0.1


def test_without_a_floor_there_is_no_layout():
    shot = shoot(look(0, -25), box_room(-2.0, 2.0, 3.5, 2.6))
    with pytest.raises(InputError, match="--room closed"):
        found(shot)


def test_nothing_measured_gives_no_layout():
    shot = shoot(look(), box_room(-2.0, 2.0, 3.5, 2.6))
    empty = replace(shot, inputs=replace(shot.inputs, depth_m=np.zeros_like(shot.inputs.depth_m)))
    with pytest.raises(InputError):
        found(empty)
    with pytest.raises(ValueError, match="measured depth"):
        found(replace(shot, inputs=replace(shot.inputs, depth_m=None)))
