"""What a thing may be decides how it faces; without a name that is what its shapes are."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import (
    Cuboid,
    DepthMap,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    Photo,
)
from diorama_core.library.catalogue import built_in_library
from diorama_core.pose.posing_tasks import PosingTask, kinds_of_shapes, posing_tasks
from diorama_core.provenance import DepthSource, ScaleSource
from diorama_core.scene.types import Camera, Intrinsics, Support

WIDTH, HEIGHT = 160, 120
CAMERA = Camera(
    Intrinsics(WIDTH, HEIGHT, 140.0, 140.0, 80.0, 60.0),
    np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 1.4], [0, 0, 0, 1]]),
)
RECORDS = {s.id: s for s in built_in_library().shapes()}


def thing(name: str, label: str, category: str) -> DetectedObject:
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[60:100, 60:100] = True
    return DetectedObject(name, label, category, (60.0, 60.0, 100.0, 100.0), mask, 1, 0.8)


def tasks(item: DetectedObject, kinds: tuple[str, ...], held_by: str = "floor") -> PosingTask:
    """Of one object that stands beside a table at its right."""
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
    return posing_tasks(Inputs(photo), (item, table), geometry, depth, {item.id: kinds}, (16, 24))[0]


def front_toward(task: PosingTask, direction: tuple[float, float]) -> float:
    """Cost of facing a direction seen from above."""
    x, y = direction
    return float(task.fine.facing.cost(np.array([[[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, 1.0]]]))[0])


def test_what_is_posed_as_a_chair_faces_the_table_and_as_a_plant_nowhere() -> None:
    task = tasks(thing("a", "object", "object"), ("plant", "chair"))
    assert front_toward(task, (1.0, 0.0)) == front_toward(task, (-1.0, 0.0))
    chair = task.as_kind("chair")
    assert front_toward(chair, (1.0, 0.0)) < front_toward(chair, (-1.0, 0.0))
    assert chair.coarse.facing is chair.fine.facing


def test_a_kind_that_was_not_asked_for_changes_nothing() -> None:
    task = tasks(thing("a", "chair", "chair"), ("chair",))
    assert task.as_kind("office chair") is task


@pytest.mark.parametrize(("kind", "hangs"), [("picture", True), ("wardrobe", False)])
def test_a_thing_without_a_name_on_a_wall_hangs_there_as_what_it_most_likely_is(kind: str, hangs: bool) -> None:
    task = tasks(thing("a", "object", "object"), (kind,), "wall")
    assert (abs(task.anchor.axis_world[2]) < 0.5) == hangs


def test_names_say_what_things_are_and_shapes_what_nameless_ones_may_be() -> None:
    objects = (thing("a", "chair", "chair"), thing("b", "object", "object"), thing("c", "lamp", "lamp"))
    ranked = {
        "a": (("chair-padded-blue", 0.9), ("table-gate-leg", 0.8)),
        "b": (("table-gate-leg", 0.9), ("chair-padded-blue", 0.8), ("chair-padded-tan", 0.7)),
    }
    assert kinds_of_shapes(objects, ranked, RECORDS) == {"a": ("chair",), "b": ("table", "chair")}
