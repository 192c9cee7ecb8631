"""What a thing may be decides how it faces; without a name that is what its shapes are. The order of one object's posed
shapes, and what decided which way it faces.
"""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.arrangement.facing.evidence import HEADINGS, NO_COSTS, HeadingCosts, WallSamples
from diorama_core.artefacts import (
    Cuboid,
    DepthMap,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    Photo,
)
from diorama_core.library.catalogue import built_in_library
from diorama_core.pose import RenderAndCompare
from diorama_core.pose.posing_tasks import PosedShape, PosingTask, likeliest_kinds, posing_tasks, sort_shapes
from diorama_core.progress import Progress
from diorama_core.provenance import DepthSource, ScaleSource
from diorama_core.scene.types import Camera, Intrinsics, Pose, Support
from tests.pose.rooms import LIBRARY, Room, camera_at, standing

WIDTH, HEIGHT = 160, 120
CAMERA = Camera(
    Intrinsics(WIDTH, HEIGHT, 140.0, 140.0, 80.0, 60.0),
    np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 1.4], [0, 0, 0, 1]]),
)
NO_WALLS = WallSamples(np.zeros((0, 2)), np.zeros((0, 2)))
RECORDS = {s.id: s for s in built_in_library().shapes()}


def thing(name: str, label: str, category: str) -> DetectedObject:
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[60:100, 60:100] = True
    return DetectedObject(name, label, category, (60.0, 60.0, 100.0, 100.0), mask, 1, 0.8)


def tasks(item: DetectedObject, kind: str, held_by: str = "floor") -> PosingTask:
    """Tasks of one object that stands beside a table at its right."""
    table = thing("table", "table", "table")
    cuboids = (
        Cuboid(item.id, np.eye(3), np.array([0.0, 3.0, 0.45]), np.array([0.5, 0.5, 0.9]), 0.7),
        Cuboid("table", np.eye(3), np.array([1.0, 3.0, 0.37]), np.array([1.0, 1.6, 0.74]), 0.7),
    )
    edges = (Support(item.id, held_by), Support("table", "floor"))
    geometry = ObjectGeometry(CAMERA, cuboids, edges, ScaleSource.OBJECT_SIZES)
    depth = DepthMap(
        np.full((HEIGHT, WIDTH), 3.0, np.float32), np.zeros((HEIGHT, WIDTH, 3), np.float32), DepthSource.RENDERED
    )
    photo = Photo(np.full((HEIGHT, WIDTH, 3), 128, np.uint8), "synthetic", (WIDTH, HEIGHT))
    return posing_tasks(Inputs(photo), (item, table), geometry, depth, {item.id: kind}, (16, 24), NO_WALLS)[0]


def test_what_the_room_says_of_headings_counts_for_both_comparisons() -> None:
    task = tasks(thing("a", "chair", "chair"), "chair")
    facing = HeadingCosts(0.0, np.arange(HEADINGS, dtype=float))
    faced = task.with_facing(facing)
    assert task.fine.facing is NO_COSTS
    assert faced.coarse.facing is faced.fine.facing is facing


@pytest.mark.parametrize(("kind", "hangs"), [("picture", True), ("wardrobe", False)])
def test_a_thing_without_a_name_on_a_wall_hangs_there_as_what_it_most_likely_is(kind: str, hangs: bool) -> None:
    task = tasks(thing("a", "object", "object"), kind, "wall")
    assert task.hangs == hangs


def test_names_say_what_things_are_and_shapes_what_nameless_ones_may_be() -> None:
    objects = (thing("a", "chair", "chair"), thing("b", "object", "object"), thing("c", "lamp", "lamp"))
    ranked = {
        "a": (("chair-padded-blue", 0.9), ("table-gate-leg", 0.8)),
        "b": (("table-gate-leg", 0.9), ("chair-padded-blue", 0.8), ("chair-padded-tan", 0.7)),
    }
    assert likeliest_kinds(objects, ranked, RECORDS) == {"a": "chair", "b": "table"}


def test_shapes_are_ordered_by_rank_and_then_by_name() -> None:
    pose = Pose(np.eye(3), np.zeros(3), np.ones(3))
    shapes = [PosedShape(LIBRARY.shape(name), pose, 0.1, 0.0) for name in ("table", "chair", "bed")]
    found = sort_shapes(shapes, {"table": 0.0, "chair": 0.0, "bed": 1.0})
    assert [one.shape.id for one in found] == ["bed", "chair", "table"]


def test_candidates_say_why_they_face_as_they_do() -> None:
    room = Room(camera_at(), (standing("chair", 0.2, 2.6, 30.0),), (0,))
    posed = RenderAndCompare(LIBRARY).pose(
        room.inputs, room.objects, room.geometry, room.depth(measured=False), room.ranked(), Progress()
    )
    reasons = posed[0].reasons
    assert {(r.object_id, r.decision) for r in reasons} == {(posed[0].object_id, "front")}
    assert "picture" in {r.term for r in reasons}
