"""What another photo shows better: shapes by the scores of both, colours with the shape they belong to."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.multiview.better_seen import better_seen, joint_candidates
from diorama_core.scene.types import Candidate, PhotoMaterial, Pose, SceneObject, yaw_rotation


def pose(x: float) -> Pose:
    return Pose(yaw_rotation(0.0), np.array([x, 0.0, 0.5]), np.ones(3))


def candidate(shape: str, score: float, x: float = 0.0) -> Candidate:
    return Candidate(shape, (0.5, 0.5, 1.0), score, pose(x))


def item(*candidates: Candidate, colour: tuple[float, float, float], category: str = "chair") -> SceneObject:
    best = candidates[0]
    material = PhotoMaterial(slot="fabric", colour=colour, texture=None)
    return SceneObject(
        "a", "chair", category, best.shape_id, best.shape_size_m, best.pose, candidates, colour=colour,
        photo_materials=(material,), box_px=(1.0, 2.0, 3.0, 4.0),
    )  # fmt: skip


RED, BLUE = (0.8, 0.1, 0.1), (0.1, 0.1, 0.8)
KNOWN = item(candidate("one", 0.8), candidate("two", 0.7), colour=RED)


def test_the_new_photo_s_shape_comes_with_its_colours_and_kind() -> None:
    there = item(candidate("two", 0.5, 1.0), candidate("one", 0.2, 1.0), colour=BLUE, category="office chair")
    found = better_seen(KNOWN, there, 0.8)
    assert (found.shape_id, found.category, found.colour) == ("two", "office chair", BLUE)
    assert found.photo_materials == there.photo_materials
    assert found.pose == there.pose
    assert (found.id, found.box_px) == (KNOWN.id, KNOWN.box_px)
    assert found.candidates[0].shape_id == "two"


def test_a_little_better_photo_does_not_outvote_a_clear_one() -> None:
    known = item(candidate("one", 0.9), candidate("two", 0.3), colour=RED)
    there = item(candidate("two", 0.5), candidate("one", 0.48), colour=BLUE)
    found = better_seen(known, there, 0.55)
    assert (found.shape_id, found.colour, found.pose) == ("one", RED, known.pose)


def test_a_shape_that_neither_has_first_may_win() -> None:
    known = item(candidate("one", 0.9), candidate("both", 0.85), candidate("new", 0.1), colour=RED)
    there = item(candidate("new", 0.9), candidate("both", 0.85, 1.0), candidate("one", 0.1), colour=BLUE)
    found = better_seen(known, there, 0.6)
    assert found.shape_id == "both"
    assert found.photo_materials == ()
    assert found.colour == BLUE


def test_scores_of_different_photos_are_compared_by_their_best() -> None:
    known, new = (candidate("one", 8.0), candidate("two", 4.0)), (candidate("two", 0.1), candidate("three", 0.05))
    ranked = joint_candidates(known, new, 0.5)
    assert [c.shape_id for c in ranked] == ["two", "one"]
    assert ranked[0].score == pytest.approx(0.75)
    assert joint_candidates((), (), 0.5) == ()
    assert better_seen(replace(KNOWN, candidates=()), replace(KNOWN, candidates=()), 0.5).shape_id == "one"
