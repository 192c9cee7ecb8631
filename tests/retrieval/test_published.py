"""Shapes by words, by the picture, and by both, in embeddings whose answers are known."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.models.clip import OpenClip
from diorama_core.models.openshape import POINTS, OpenShape
from diorama_core.progress import Progress
from diorama_core.retrieval.joint import PointEmbedding
from diorama_core.retrieval.published import MatchedByLooks, TextThenPicture
from tests.pose.rooms import LIBRARY, Room, camera_at, random_room, standing

SEATS = ("chair", "low chair", "sofa")


@dataclass(frozen=True)
class Known:
    """A space in which seats and the rest lie apart along one axis, and light and dark along another."""

    weights: str = "known"

    def text(self, text: str) -> np.ndarray:
        assert text == "a photo of chair"
        return np.array([1.0, 0.0], np.float32)

    def picture(self, rgb: np.ndarray) -> np.ndarray:
        return np.array([0.0, 1.0], np.float32)

    def shape(self, library: ShapeLibrary, shape: Shape) -> np.ndarray:
        angle = 0.2 + 0.1 * SEATS.index(shape.id) if shape.id in SEATS else 1.2
        return np.array([np.cos(angle), np.sin(angle)], np.float32)


@pytest.fixture
def room() -> Room:
    return Room(camera_at(), (standing("chair", 0.0, 3.0, 20.0),), (0,))


def ranked(stage: TextThenPicture, room: Room) -> list[str]:
    (found,) = stage.retrieve(room.inputs, room.objects, room.geometry, Progress())
    assert len(found.ranked) <= TextThenPicture.shapes
    return [shape for shape, _ in found.ranked]


def test_words_leave_shapes_that_the_picture_orders(room: Room, tmp_path: Path) -> None:
    both = TextThenPicture(LIBRARY, Known(), folder=tmp_path, left_by_words=len(SEATS))
    assert ranked(both, room) == ["sofa", "low chair", "chair"]
    assert ranked(replace(both, by="words"), room)[:3] == ["chair", "low chair", "sofa"]
    assert set(ranked(replace(both, by="picture"), room)).isdisjoint(SEATS)


def test_what_is_not_seen_is_found_by_its_words(room: Room, tmp_path: Path) -> None:
    hidden = tuple(replace(o, mask=o.mask & False) for o in room.objects)
    stage = TextThenPicture(LIBRARY, Known(), "picture", tmp_path)
    (found,) = stage.retrieve(room.inputs, hidden, room.geometry, Progress())
    assert found.ranked[0][0] == "chair"


def test_points_carry_the_colours_of_the_shape(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[tuple[np.ndarray, np.ndarray]] = []

    def shape_vector(self: OpenShape, points: np.ndarray, colours: np.ndarray) -> np.ndarray:
        seen.append((points, colours))
        return np.ones(3, np.float32)

    monkeypatch.setattr(OpenShape, "shape", shape_vector)
    shape = LIBRARY.shape("sofa")
    absent = tmp_path / "absent.onnx"
    PointEmbedding(OpenClip(absent, absent, absent), OpenShape(absent)).shape(LIBRARY, shape)
    ((points, colours),) = seen
    assert len(points) == len(colours) == POINTS
    np.testing.assert_allclose(np.ptp(points, axis=0), shape.size_m, rtol=0.02)
    assert ((colours >= 0) & (colours <= 1)).all()


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

    def similarities(self, item, shapes):
        return np.array([float(s.id == self.shape_id) for s in shapes])


def test_looks_are_compared_as_the_stage_is_told() -> None:
    room = random_room(2)
    category = room.objects[0].category
    last = LIBRARY.in_category(category)[-1].id
    found = matched(room, MatchedByLooks(LIBRARY, _Prefers(last)))
    assert found[0].ranked[0] == (last, 1.0)
