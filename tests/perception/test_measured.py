"""Cuboids and supports from measured depth, on rooms whose geometry is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.perception.measured import MeasuredGeometry
from diorama_core.perception.measured.cloud import SETTINGS, largest_piece, main_layer
from diorama_core.progress import Progress
from diorama_core.provenance import ScaleSource
from tests.synthetic_rooms import box_room, cuboid, look, shoot

CATEGORIES = ("sofa", "coffee table", "box", "bookshelf", "chair")
ITEMS = (
    cuboid("sofa", (-0.9, 3.4, 0), (0.9, 2.0, 0.8), -90),
    cuboid("table", (0.2, 2.2, 0), (0.7, 1.2, 0.45)),
    cuboid("box", (0.2, 2.2, 0.45), (0.2, 0.3, 0.2), 25),
    cuboid("shelf", (1.7, 3.8, 0), (0.35, 0.9, 1.7), 180),
    cuboid("chair", (-1.3, 2.0, 0), (0.5, 0.5, 0.9), 30),
)


def measure(shot):
    return MeasuredGeometry().measure(shot.inputs, shot.estimate, shot.objects, Progress())


@pytest.mark.parametrize(("noise", "tolerance"), [(0.0, 0.08), (0.01, 0.12)])
def test_cuboids_are_where_the_objects_are(noise, tolerance):
    shot = shoot(look(5, 18, 1.6), box_room(-2.2, 2.2, 4.4, 2.6), ITEMS, CATEGORIES, noise=noise)
    found = {c.object_id: c for c in measure(shot).cuboids}
    for true in ITEMS:
        cuboid_found = found[true.object_id]
        error = np.abs(cuboid_found.corners_world.mean(axis=0) - true.centre)
        assert error.max() < tolerance, true.object_id
        assert sorted(cuboid_found.size_m) == pytest.approx(sorted(true.size_m), abs=2 * tolerance), true.object_id


def test_supports_follow_contact():
    shot = shoot(look(5, 18, 1.6), box_room(-2.2, 2.2, 4.4, 2.6), ITEMS, CATEGORIES)
    parents = {s.child: s.parent for s in measure(shot).supports}
    assert parents == {"sofa": "floor", "table": "floor", "box": "table", "shelf": "floor", "chair": "floor"}


def test_a_hidden_back_is_completed_by_the_usual_depth():
    wardrobe = cuboid("wardrobe", (0.0, 3.0, 0), (0.6, 1.2, 2.0), -90)
    shot = shoot(look(0, 5, 1.4), box_room(-2.2, 2.2, 5.0, 2.6), (wardrobe,), ("wardrobe",))
    (found,) = measure(shot).cuboids
    assert np.sort(found.size_m)[0] == pytest.approx(0.6, abs=0.1)
    assert found.centre[1] == pytest.approx(3.0, abs=0.1)


def test_a_completed_back_stops_at_what_is_seen_behind():
    wardrobe = cuboid("wardrobe", (0.0, 3.8, 0), (0.4, 1.2, 2.0), -90)
    shot = shoot(look(0, 5, 1.4), box_room(-2.2, 2.2, 4.0, 2.6), (wardrobe,), ("wardrobe",))
    (found,) = measure(shot).cuboids
    assert found.corners_world[:, 1].max() < 4.08


def test_a_picture_hangs_on_the_wall():
    picture = cuboid("picture", (0.0, 3.97, 1.2), (0.04, 0.8, 0.6), -90)
    shot = shoot(look(0, 5, 1.4), box_room(-2.2, 2.2, 4.0, 2.6), (picture,), ("picture",))
    assert measure(shot).supports[0].parent == "wall"


def test_a_mask_over_a_hole_in_the_depth_gives_a_doubtful_cuboid():
    shot = shoot(look(0, 15), box_room(-2.0, 2.0, 4.0, 2.6), (ITEMS[1],), ("coffee table",))
    holed = np.where(shot.objects[0].mask, 0, shot.inputs.depth_m).astype(np.float32)
    shot = replace(shot, inputs=replace(shot.inputs, depth_m=holed))
    (found,) = measure(shot).cuboids
    assert found.confidence <= 0.2
    assert (found.size_m > 0).all()
    assert found.centre[2] == pytest.approx(0.5 * found.size_m[2], abs=1e-6)


def test_no_objects_gives_the_camera_alone():
    shot = shoot(look(0, 15, 1.7), box_room(-2.0, 2.0, 4.0, 2.6))
    geometry = measure(shot)
    assert geometry.cuboids == ()
    assert geometry.camera.position[2] == pytest.approx(1.7)


def test_height_comes_from_the_floor_or_is_assumed():
    shot = shoot(look(0, 15, 1.7), box_room(-2.0, 2.0, 4.0, 2.6))
    unknown = replace(shot.estimate, height_m=None)
    seen = MeasuredGeometry().measure(shot.inputs, unknown, (), Progress())
    assert seen.camera.position[2] == pytest.approx(1.7, abs=0.03)
    empty = replace(shot.inputs, depth_m=np.zeros_like(shot.inputs.depth_m))
    guessed = MeasuredGeometry().measure(empty, unknown, (), Progress())
    assert guessed.camera.position[2] == pytest.approx(SETTINGS.assumed_height_m)
    assert (seen.source, guessed.source) == (ScaleSource.DEPTH, ScaleSource.DEPTH_WITHOUT_FLOOR)


def test_the_heaviest_layer_wins():
    depth = np.array([1.0] * 10 + [1.05] * 20 + [3.0] * 12)
    layer = main_layer(depth, np.ones(len(depth)))
    assert layer.sum() == 30
    assert depth[layer].max() < 2


def test_strays_are_dropped(rng):
    body = rng.uniform(0, 0.3, (500, 3))
    strays = rng.uniform(2, 2.05, (20, 3))
    assert len(largest_piece(np.concatenate([body, strays]))) == 500
