"""Ranked shapes for things in rendered rooms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import LabelledBox
from diorama_core.geometry.see_through import SeeThrough
from diorama_core.progress import Progress
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval, _best, _senses
from diorama_core.retrieval.settings import RankingSettings
from diorama_core.scene.types import Support
from tests.pose.rooms import LIBRARY, Room, camera_at, random_room, standing

STAGE = HierarchicalRetrieval(LIBRARY)


def ranked(room: Room, stage: HierarchicalRetrieval = STAGE):
    return stage.retrieve(room.inputs, room.objects, room.geometry, Progress())


def test_the_true_shape_is_found_among_its_kind_and_scores_fall() -> None:
    for seed in range(3):
        room = random_room(seed)
        found = ranked(room)
        for of_one, index in zip(found, room.seen, strict=True):
            assert of_one.ranked[0][0] == room.placed[index].shape_id
            scores = [score for _, score in of_one.ranked]
            assert scores == sorted(scores, reverse=True)
            assert all(0.0 < s <= 1.0 for s in scores)
    assert ranked(room) == found, "the same input gives the same ranking"


def test_no_more_than_asked_for_are_retained() -> None:
    stage = HierarchicalRetrieval(LIBRARY, keep=2)
    assert all(len(found.ranked) <= 2 for found in ranked(random_room(2), stage))


def test_a_few_of_a_kind_are_joined_by_near_kinds_that_score_lower() -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 3.0, 20.0),), (0,))
    found = ranked(room)[0]
    assert found.ranked[0][0] == "chair"
    assert found.note == ""


def test_a_kind_without_shapes_takes_the_nearest_and_says_so() -> None:
    room = Room(camera_at(), (standing("desk", 0.0, 3.0, -90.0),), (0,))
    objects = tuple(replace(o, category="piano", label="piano") for o in room.objects)
    found = STAGE.retrieve(room.inputs, objects, room.geometry, Progress())[0]
    assert found.ranked[0][0] == "desk"
    assert "piano" in found.note


def test_an_unnamed_object_is_taken_for_something_of_its_size_plain_boxes_among_the_first() -> None:
    room = Room(camera_at(), (standing("carton", 0.0, 3.0, 10.0), standing("sofa", 2.0, 4.0, -90.0)), (0, 0))
    objects = tuple(replace(o, category="object", label="thing") for o in room.objects)
    found = STAGE.retrieve(room.inputs, objects, room.geometry, Progress())
    assert "carton" in [shape for shape, _ in found[0].ranked[:2]]
    assert len(found[1].ranked) > 1


@pytest.mark.parametrize(("label", "parent", "lies"), [("thing", "floor", False), ("thing", "sofa_1", True)])
def test_what_nobody_named_and_stands_on_the_floor_is_less_likely_of_a_kind_that_lies_on_others(
    label: str, parent: str, *, lies: bool
) -> None:
    room = Room(camera_at(), (standing("carton", 0.0, 3.0, 10.0),), (0,))
    seen = (("pillow", 0.5), ("ottoman", 0.5))
    item = replace(room.objects[0], category="object", label=label, looks_like=seen)
    held = replace(room.geometry, supports=(Support(item.id, parent),))
    floor = replace(room.geometry, supports=())
    senses, plain = (_senses((item,), room.geometry.cuboids, g)[0] for g in (held, floor))
    ratio = (senses["pillow"] / senses["ottoman"]) / (plain["pillow"] / plain["ottoman"])
    assert ratio == pytest.approx(1.0 if lies else 0.5)


def test_alike_objects_share_their_best_shape() -> None:
    chairs = tuple(standing("chair", x, 3.0 + abs(x) / 3, yaw) for x, yaw in ((-1.2, 10), (0.0, 190), (1.2, 100)))
    tops = {found.ranked[0][0] for found in ranked(Room(camera_at(), chairs, (0, 1, 2)))}
    assert tops == {"chair"}


def test_empty_and_one_pixel_masks_are_survived() -> None:
    room = random_room(4)
    for count in (0, 1):
        mask = np.zeros(room.buffers.instance.shape, bool)
        mask.ravel()[:count] = True
        objects = tuple(replace(o, mask=mask) for o in room.objects)
        found = STAGE.retrieve(room.inputs, objects, room.geometry, Progress())
        assert all(np.isfinite([s for _, s in f.ranked]).all() and f.ranked for f in found)


def test_its_name_is_short_and_changes_with_the_library() -> None:
    class Fewer(type(LIBRARY)):
        def shapes(self):
            return super().shapes()[1:]

    assert len(repr(STAGE)) < 1500  # with every number of its settings
    assert repr(STAGE) == repr(HierarchicalRetrieval(LIBRARY)) != repr(HierarchicalRetrieval(Fewer()))


def test_shapes_of_named_kinds_are_loaded_ahead() -> None:
    boxes = [LabelledBox((0.0, 0.0, 9.0, 9.0), "chair", word) for word in ("chair", "thing", "chair")]
    chairs = LIBRARY.in_category("chair")
    assert len(list(STAGE.ahead(boxes))) == len(chairs)
    assert all("caster" in vars(STAGE._appearance(shape)) for shape in chairs)
    assert not list(STAGE.ahead([LabelledBox((0.0, 0.0, 9.0, 9.0), "object", "thing")]))


def test_objects_of_a_kind_choose_among_mostly_the_same_shapes() -> None:
    own = [{f"s{k}": 1.0 - abs(k - best) / 20 for k in range(20)} for best in (2, 17)]
    mean = {key: (own[0][key] + own[1][key]) / 2 for key in own[0]}
    first, second = (
        _best(scores, mean, 8, dict.fromkeys(scores, "chair"), RankingSettings(kinds=1), named=True) for scores in own
    )
    assert len(first) == len(second) == 8
    shared = {s for s, _ in first} & {s for s, _ in second}
    assert len(shared) >= 6
    assert [v for _, v in first] == sorted((v for _, v in first), reverse=True)
    assert first[0] != second[0]


@pytest.mark.parametrize(("name", "looked"), [("picture", 0), ("chair", 1)])
def test_nobody_looks_through_pictures(monkeypatch, name, looked) -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 3.0, 20.0),), (0,))
    objects = tuple(replace(o, category=name, label=name) for o in room.objects)
    calls = []
    monkeypatch.setattr(SeeThrough, "of", lambda rgb, seen: calls.append(seen))
    STAGE.retrieve(room.inputs, objects, room.geometry, Progress())
    assert len(calls) == looked
