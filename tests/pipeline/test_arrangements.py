"""Other arrangements: sets stay sets, shapes are plausible, what is locked stays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.pipeline.arrangements import arrangement, arrangement_count, plausible_shapes
from diorama_core.scene.types import Architecture, Candidate, Pose, Scene, SceneObject, Support

SIZE = (0.5, 0.5, 0.9)


def candidate(shape_id: str, score: float, x: float, scale: float = 1.0) -> Candidate:
    return Candidate(shape_id, SIZE, score, Pose.upright((x, 0.0, 0.45 * scale), 0.3, (scale,) * 3))


def item(name: str, category: str, x: float, ranked: dict[str, float], scale: float = 1.0) -> SceneObject:
    candidates = tuple(candidate(s, v, x, scale) for s, v in ranked.items())
    best = candidates[0]
    return SceneObject(
        id=name, label=name, category=category, shape_id=best.shape_id, shape_size_m=best.shape_size_m, pose=best.pose,
        candidates=candidates, confidence=0.8,
    )  # fmt: skip


def room(*items: SceneObject) -> Scene:
    return Scene(camera=None, architecture=Architecture(()), objects=items)


CHAIRS = (
    item("c1", "chair", 0.0, {"a": 0.9, "b": 0.8, "x": 0.1}),
    item("c2", "chair", 1.0, {"a": 0.9, "c": 0.7, "b": 0.6}, 1.04),
    item("c3", "chair", 2.0, {"a": 0.9, "b": 0.5}, 0.98),
)
LAMP = item("l", "lamp", 3.0, {"p": 0.9, "q": 0.8})


def test_a_set_changes_its_shape_as_one() -> None:
    scene = room(*CHAIRS, LAMP)
    second = arrangement(scene, 1)
    assert [o.shape_id for o in second.objects] == ["b", "b", "b", "q"]
    third = arrangement(scene, 2)
    # Only one chair was tried in `c`, by which alone the set would be too little like it: it keeps its last.
    assert [o.shape_id for o in third.objects] == ["b", "b", "b", "q"]
    assert arrangement(scene, 0) == scene


def test_what_scores_too_little_is_no_alternative() -> None:
    assert plausible_shapes(CHAIRS) == ("a", "b")
    assert plausible_shapes([item("s", "sofa", 0, {"a": 0.9, "b": 0.2})]) == ("a",)
    assert arrangement_count(room(*CHAIRS)) == 2
    assert arrangement_count(room()) == 1


def test_shapes_of_one_form_are_one_alternative_where_the_photo_gives_the_colour() -> None:
    red = replace(
        item("s", "sofa", 0.0, {"grey": 0.9, "tan": 0.8, "rolled": 0.7, "rolled blue": 0.6}), colour=(1, 0, 0)
    )
    of_one_form = ({"grey", "tan"}, {"rolled", "rolled blue"})

    def alike(a: str, b: str) -> float:
        return 0.95 if any({a, b} <= form for form in of_one_form) else 0.7

    assert plausible_shapes([red], alike) == ("grey", "rolled")
    assert plausible_shapes([red]) == ("grey", "tan", "rolled", "rolled blue")
    assert plausible_shapes([replace(red, colour=None)], alike) == plausible_shapes([red])
    assert arrangement_count(room(red), alike) == 2
    assert arrangement(room(red), 1, alike).object("s").shape_id == "rolled"


def test_shapes_take_the_pose_that_was_fitted_to_them() -> None:
    alone = item("s", "sofa", 0.0, {"a": 0.9, "b": 0.8})
    better = replace(alone.candidates[1], pose=Pose.upright((0.2, 0.1, 0.4), 1.2, (1.1, 0.9, 0.95)))
    scene = room(replace(alone, candidates=(alone.candidates[0], better)))
    assert arrangement(scene, 1).objects[0].pose == better.pose


def test_a_shape_lent_by_another_of_the_set_stands_where_the_object_stood() -> None:
    lender = item("c1", "chair", 0.0, {"a": 0.9, "b": 0.9})
    other = item("c2", "chair", 1.0, {"a": 0.9})
    changed = arrangement(room(lender, other), 1).object("c2")
    assert changed.shape_id == "b"
    assert np.allclose(changed.pose.position[:2], [1.0, 0.0])


def test_what_is_locked_stays_and_what_stands_on_an_object_follows() -> None:
    locked = replace(CHAIRS[0], locked=True)
    assert arrangement(room(locked, LAMP), 1).objects[0] == locked
    table = item("t", "table", 0.0, {"a": 0.9, "b": 0.8})
    taller = replace(table.candidates[1], pose=Pose.upright((0, 0, 0.55), 0.0, (1, 1, 0.55 / 0.45)))
    cup = item("k", "cup", 0.0, {"m": 0.9})
    scene = replace(
        room(replace(table, candidates=(table.candidates[0], taller)), cup),
        supports=(Support("k", "t", "placed on"),),
    )
    assert arrangement(scene, 1).object("k").pose.position[2] - cup.pose.position[2] == pytest.approx(0.2)


def test_objects_of_a_set_are_equally_large_on_their_bases() -> None:
    changed = arrangement(room(*CHAIRS), 1)
    scales = np.array([o.pose.scale for o in changed.objects])
    assert np.ptp(scales, axis=0).max() < 1e-12
    assert 0.98 <= scales.min() <= 1.04
    assert np.allclose([o.pose.position[2] - o.size_m[2] / 2 for o in changed.objects], 0.0, atol=1e-9)


def test_a_size_that_does_not_agree_is_left() -> None:
    high = item("c4", "chair", 4.0, {"a": 0.9, "b": 0.8}, 1.5)
    changed = arrangement(room(*CHAIRS, high), 1)
    assert changed.object("c4").pose.scale[0] == 1.5
    assert changed.object("c1").pose.scale[0] == changed.object("c2").pose.scale[0] < 1.1
