"""A floor under the quality of builds: three rendered rooms with depth, two photos with boxes; one shape of every kind.

The benchmarks measure quality (`docs/benchmark.md`); this notices soon that a change broke it. To be quick,
pictures are small, shapes are not made to measure, and poses are not refined.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from diorama_core.artefacts import Inputs
from diorama_core.evaluation.adapters.photo_annotations import read_annotations
from diorama_core.evaluation.benchmarks.cases import Case, studio_of
from diorama_core.evaluation.benchmarks.photo_build import PhotoTask, read_annotated_inputs
from diorama_core.evaluation.metrics.scene import SceneScores, scene_scores
from diorama_core.library.catalogue import built_in_library
from diorama_core.pipeline.run import Built, build_scene
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.synthesis.splits import Subset, split_library
from tests.conftest import PhotoEntry

SIZE = (320, 240)
ROOMS = (Case(10, "bedroom"), Case(3, "kitchen", 1), Case(16, "bathroom", 1))
PHOTOS = ("midi_real00", "redwood_00000")
MIN_OWN, MIN_KINDS_OF_ROOMS, MIN_KINDS_OF_PHOTOS = 0.61, 0.77, 0.54
"""Measured were 0.78 (of 18 objects within 20 cm, 20 degrees and 20 % of the truth), 0.89 (of 18) and 0.73 (of 11),
less three, two and two objects: a harmless change may move some."""

pytestmark = [pytest.mark.slow, pytest.mark.unchecked]  # other tests check the shapes of arrays in builds


@cache
def one_of_a_kind() -> Subset:
    """The first shape of every kind that rooms of the series are not furnished with."""
    others = split_library(built_in_library(), "train", "validation")
    first = {shape.category: shape.id for shape in reversed(others.shapes())}
    return replace(others, ids=frozenset(first.values()))


def built(inputs: Inputs) -> Built:
    """A build by the embedded stages but for the two that take most of the time."""
    stages = embedded_stages(inputs, one_of_a_kind())
    return build_scene(inputs, one_of_a_kind(), stages=replace(stages, pose=stages.pose.stage, refinement=None))


@pytest.fixture(scope="module")
def rooms() -> list[SceneScores]:
    library, found = built_in_library(), []
    for case in ROOMS:
        studio, cameras = studio_of(case, split_library(library, "test"), SIZE)
        view = studio.view(cameras[case.view], SIZE, with_empty_room=False)
        found.append(scene_scores(view, built(view.inputs).scene, library))
    return found


def test_objects_of_rendered_rooms_are_where_they_should_be(rooms: list[SceneScores]) -> None:
    assert np.mean([room.own.acc for room in rooms]) >= MIN_OWN


def test_kinds_of_rendered_rooms_are_right(rooms: list[SceneScores]) -> None:
    assert np.mean([room.kind for room in rooms]) >= MIN_KINDS_OF_ROOMS


def test_kinds_of_photos_are_right(photos: list[PhotoEntry]) -> None:
    paths = {entry.id: entry.path for entry in photos}
    annotations = read_annotations(Path(__file__).with_name("photo_annotations.json"))
    right = []
    for name in PHOTOS:
        case = read_annotated_inputs(PhotoTask(name, paths[name], annotations[name]))
        items = {item.mask_id: item for item in built(case.inputs).scene.objects}
        for number, stated in enumerate(case.annotation.objects, 1):
            if stated.nameable:
                right.append(number in items and items[number].category == stated.kind)
    assert np.mean(right) >= MIN_KINDS_OF_PHOTOS
