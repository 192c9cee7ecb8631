"""Open doorways that were pointed at are holes in their wall; doors and windows hang on a whole wall."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.architecture.single_view.stage import PhotoRoom
from diorama_core.architecture.walls.openings import WallOpening
from diorama_core.architecture.walls.passages import is_passage, with_passages, without_openings
from diorama_core.architecture.walls.wall_sequence import WallPiece
from diorama_core.artefacts import DetectedObject, ObjectGeometry
from diorama_core.geometry.casting import cast_plane
from diorama_core.progress import Progress
from diorama_core.provenance import ScaleSource
from diorama_core.scene.types import Support
from tests.synthetic_rooms import box_room, cuboid, look, shoot

SIZE = (320, 240)
CAMERA = look(15, 6, fov_deg=70, size=SIZE)
PIECES = (
    WallPiece(np.array([-2.0, 0.0]), np.array([-2.0, 4.0]), None),
    WallPiece(np.array([-2.0, 4.0]), np.array([3.0, 4.0]), None),
)


def pointed_at(label, corners, camera=CAMERA, mask=None):
    """What a detector would say of the rectangle with these opposite corners."""
    (x1, y1, z1), (x2, y2, z2) = corners
    pixels = camera.project(np.array([[x, y, z] for x, y in ((x1, y1), (x2, y2)) for z in (z1, z2)]))
    box = (*(float(v) for v in pixels.min(axis=0)), *(float(v) for v in pixels.max(axis=0)))
    k = camera.intrinsics
    whole = np.zeros((k.height, k.width), bool)
    whole[int(box[1]) : int(box[3]), int(box[0]) : int(box[2])] = True
    return DetectedObject("it", "door", label, box, whole if mask is None else mask, 1, 1.0)


@pytest.mark.parametrize(
    ("label", "expected"),
    [
        ("doorway", True),
        ("Open doorways", True),
        ("brick archway", True),
        ("door opening", True),
        ("door", False),
        ("french doors", False),
        ("window", False),
        ("", False),
    ],
)
def test_names_of_what_one_walks_through(label, expected):
    assert is_passage(pointed_at(label, ((0.0, 4.0, 0.0), (0.9, 4.0, 2.0)))) is expected


@pytest.mark.parametrize(
    ("wall", "corners", "expected"),
    [
        (1, ((-0.4, 4.0, 0.0), (0.5, 4.0, 2.0)), (1.6, 2.5, 0.0, 2.0)),
        (1, ((1.2, 4.0, 1.0), (2.4, 4.0, 1.9)), (3.2, 4.4, 1.0, 1.9)),
        (0, ((-2.0, 2.9, 0.0), (-2.0, 3.7, 2.1)), (2.9, 3.7, 0.0, 2.1)),
    ],
)
def test_a_box_becomes_the_rectangle_it_surrounds(wall, corners, expected):
    openings, ids = with_passages(((), ()), (pointed_at("doorway", corners),), PIECES, CAMERA, 2.6)
    assert ids == ("it",)
    (found,) = openings[wall]
    np.testing.assert_allclose((found.left, found.right, found.bottom, found.top), expected, atol=0.02)


def test_what_was_measured_stays_as_measured():
    measured = WallOpening(1.7, 2.4, 0.0, 1.9)
    doorway = pointed_at("doorway", ((-0.4, 4.0, 0.0), (0.5, 4.0, 2.0)))
    assert with_passages(((), (measured,)), (doorway,), PIECES, CAMERA, 2.6) == (((), (measured,)), ("it",))


def test_what_was_measured_to_be_shut_stays_a_door():
    doorway = pointed_at("doorway", ((-0.4, 4.0, 0.0), (0.5, 4.0, 2.0)))
    assert with_passages(((), ()), (doorway,), PIECES, CAMERA, 2.6, lambda *_: True) == (((), ()), ())


def _room_with(label):
    """A plain room from the photo alone and from measured depth, with one rectangle of its far wall pointed at."""
    camera = look(0, 6, fov_deg=70, size=SIZE)
    leaf = cuboid("it", (0.6, 3.985, 0.0), (0.03, 0.9, 2.0), yaw_deg=-90)
    shot = shoot(camera, box_room(-2.0, 2.0, 4.0, 2.6), (leaf,), ("door",))
    objects = tuple(replace(o, label=label) for o in shot.objects)
    geometry = ObjectGeometry(camera, shot.cuboids, (Support("it", "wall"),), ScaleSource.GIVEN)
    return shot, objects, geometry


@pytest.mark.parametrize("stage", [PhotoRoom(), PlanarRoom()], ids=["photo", "depth"])
@pytest.mark.parametrize("label", ["door", "window"])
def test_a_door_and_a_window_hang_on_a_whole_wall(stage, label):
    shot, objects, geometry = _room_with(label)
    estimate = stage.reconstruct(shot.inputs, objects, geometry, Progress())
    assert estimate.openings == ()
    assert all(len(w.polygon) == 4 for w in estimate.architecture.by_role("wall"))
    (support,) = estimate.supports
    assert (support.relation, estimate.architecture.by_role("wall")[0].role) == ("mounted on", "wall")


def test_a_doorway_in_a_photo_is_a_hole_and_no_object():
    shot, objects, geometry = _room_with("doorway")
    estimate = PhotoRoom().reconstruct(shot.inputs, objects, geometry, Progress())
    assert estimate.openings == ("it",)
    assert estimate.source.doorways == 1
    wall = next(w for w in estimate.architecture.by_role("wall") if w.normal[1] < -0.99)
    eye = shot.camera.position
    rays = np.array([[0.6, 4.0, 1.0], [0.6, 4.0, 2.3], [-1.0, 4.0, 1.0]]) - eye
    np.testing.assert_array_equal(np.isfinite(cast_plane(eye, rays, wall)), [False, True, True])
    items, left = without_openings(objects, geometry, estimate)
    assert (items, left.cuboids) == ((), ())


def test_a_doorway_that_was_measured_to_be_shut_is_a_door():
    shot, objects, geometry = _room_with("doorway")
    assert PlanarRoom().reconstruct(shot.inputs, objects, geometry, Progress()).openings == ()
