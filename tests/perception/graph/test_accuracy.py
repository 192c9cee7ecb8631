"""The geometric graph on rendered rooms whose supports are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.evaluation.dataset import ROOM_KINDS, TruthView, furnished_room, hold_cameras, in_photo_world
from diorama_core.evaluation.dataset.truth import _asked, _Casting
from diorama_core.evaluation.relations import RelationCount, relations_of
from diorama_core.library.catalogue import built_in_library

SIZE = (480, 360)
SEEDS = range(6)


def _view(seed: int) -> TruthView:
    """The truth of one picture without its colours, which the graph does not look at."""
    library = built_in_library()
    room = furnished_room(1000 + seed, ROOM_KINDS[seed % len(ROOM_KINDS)], library)
    camera = hold_cameras(room, library, seed, count=1, size=SIZE)[0]

    scene = in_photo_world(replace(room, camera=camera))
    assert scene.camera is not None
    seen = _Casting(scene, library).buffers(scene.camera)
    asked, boxes = _asked(scene, seen.object_ids, seen.visible_fraction, SIZE)
    objects = tuple(replace(o, mask_id=k + 1 if k in boxes else None) for k, o in enumerate(scene.objects))
    labelled = tuple((k + 1, LabelledBox(boxes[k], objects[k].category, objects[k].label)) for k in sorted(boxes))
    photo = Photo(np.zeros((SIZE[1], SIZE[0], 3), np.uint8), "rendered.png", SIZE)
    instances = np.where(asked, seen.object_ids + 1, 0).astype(np.int32)
    inputs = Inputs(photo, tuple(b for _, b in labelled), instances, labelled, seen.depth_m, camera.intrinsics)
    blank = np.zeros((SIZE[1], SIZE[0], 3), np.float32)
    none = np.zeros((SIZE[1], SIZE[0]), np.int32)
    return TruthView(
        inputs, replace(scene, objects=objects), blank, none, none, seen.depth_m, seen.object_ids,
        blank.astype(np.uint8), (), seen.visible_fraction,
    )  # fmt: skip


@pytest.fixture(scope="module")
def views() -> list[TruthView]:
    return [_view(seed) for seed in SEEDS]


def test_supporters_are_right_with_depth(views: list[TruthView]) -> None:
    count = sum((relations_of(v, with_depth=True) for v in views), RelationCount())
    assert count.total > 50
    assert count.accuracy >= 0.9, count.mistakes


def test_supporters_are_right_from_a_photo_alone(views: list[TruthView]) -> None:
    count = sum((relations_of(v, with_depth=False) for v in views[:3]), RelationCount())
    assert count.total > 20
    assert count.accuracy >= 0.88, count.mistakes
