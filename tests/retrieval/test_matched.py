from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from diorama_core.progress import Progress
from diorama_core.retrieval.matched import MatchedByLooks
from tests.pose.rooms import LIBRARY, Room, camera_at, random_room, standing


def matched(room: Room, stage: MatchedByLooks):
    return stage.retrieve(room.inputs, room.objects, room.geometry, Progress())


def test_only_shapes_of_the_kind_are_compared_and_scores_fall() -> None:
    room = random_room(1)
    for found, item in zip(matched(room, MatchedByLooks(LIBRARY)), room.objects, strict=True):
        assert 0 < len(found.ranked) <= MatchedByLooks.shapes
        assert {LIBRARY.shape(i).category for i, _ in found.ranked} == {item.category}
        scores = [s for _, s in found.ranked]
        assert scores == sorted(scores, reverse=True)


def test_a_kind_without_shapes_takes_its_nearest() -> None:
    room = Room(camera_at(), (standing("desk", 0.0, 3.0, -90.0),), (0,))
    objects = tuple(replace(o, category="piano", label="piano") for o in room.objects)
    found = MatchedByLooks(LIBRARY).retrieve(room.inputs, objects, room.geometry, Progress())
    assert found[0].ranked[0][0] == "desk"


@dataclass(frozen=True)
class _Prefers:
    """Stands for an embedding: what it likes comes first."""

    shape_id: str

    def of(self, item, shapes):
        return np.array([float(s.id == self.shape_id) for s in shapes])


def test_looks_are_compared_as_the_stage_is_told() -> None:
    room = random_room(2)
    category = room.objects[0].category
    last = LIBRARY.in_category(category)[-1].id
    found = matched(room, MatchedByLooks(LIBRARY, _Prefers(last)))
    assert found[0].ranked[0] == (last, 1.0)
