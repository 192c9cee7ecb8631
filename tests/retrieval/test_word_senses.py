"""Loose words by where their boxes are: things of known size set before a camera, and their boxes read back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import CameraEstimate, CameraHypothesis, DetectedObject
from diorama_core.library.labels import meanings, understand_label
from diorama_core.library.taxonomy import category, resolve
from diorama_core.provenance import AttitudeSource, CameraSource, FocalSource, HeadingSource
from diorama_core.retrieval.word_senses import sense_probabilities, with_word_senses
from diorama_core.scene.types import Intrinsics, box_corners

K = Intrinsics(640, 480, 520, 520, 320, 240)
LEVEL = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
"""World from camera: looks along +y."""


def seen(word: str, kind: str, bottom_m: float, place=(0.0, 4.0), height_m: float = 1.45, number: int = 1):
    """The box that a thing of a kind's usual size has, its word as its label."""
    prior = category(kind).priors[0]
    size = np.array([prior.width_m, prior.depth_m, prior.height_m])
    corners = box_corners(size) + np.array([*place, bottom_m + prior.height_m / 2 - height_m])
    camera = corners @ LEVEL
    pixels = camera[:, :2] / camera[:, 2:] * K.fx + (K.cx, K.cy)
    box = (*pixels.min(axis=0), *pixels.max(axis=0))
    name = f"{word}_{number}"
    mask = np.zeros((1, 1), bool)
    return DetectedObject(name, resolve(word).category.name, word, tuple(map(float, box)), mask, number, 1.0)


def understood(*objects) -> tuple[DetectedObject, ...]:
    estimate = CameraEstimate(
        (CameraHypothesis(K, LEVEL, 1.0),),
        1.0,
        CameraSource(FocalSource.GIVEN, AttitudeSource.GIVEN, HeadingSource.GIVEN),
    )
    return with_word_senses(objects, estimate)


def kind_of(*objects) -> list[str]:
    return [o.category for o in understood(*objects)]


@pytest.mark.parametrize(
    ("word", "kind", "bottom_m"),
    [("lamp", "floor lamp", 0.0), ("lamp", "ceiling lamp", 2.2), ("cabinet", "wall cabinet", 1.45),
     ("table", "table", 0.0), ("chair", "chair", 0.0)],
)  # fmt: skip
def test_where_an_object_is_and_how_large_tells_which_it_is(word, kind, bottom_m) -> None:
    assert kind_of(seen(word, kind, bottom_m), seen("sofa", "sofa", 0.0, (-1.5, 4.5), number=2))[0] == kind


@pytest.mark.parametrize(
    ("word", "kind"), [("table", "coffee table"), ("cabinet", "wardrobe"), ("cabinet", "display cabinet")]
)
def test_sizes_make_kinds_likelier_than_their_words_do(word, kind) -> None:
    sofa = seen("sofa", "sofa", 0.0, (-1.5, 4.5), number=2)
    senses = sense_probabilities([seen(word, kind, 0.0), sofa], K, LEVEL)[0]
    assert senses[kind] > 1.5 * meanings(word, word)[kind]


@pytest.mark.parametrize("kind", ["tv stand", "night stand", "coat rack"])
def test_a_word_that_is_no_kinds_name_means_the_likeliest(kind) -> None:
    alone = replace(seen("stand", kind, 0.0), category=understand_label("stand").category.name)
    (found,) = understood(alone)
    assert found.category == max(found.meanings, key=lambda sense: sense[1])[0]
    assert found.category == kind


def test_a_lamp_on_a_table_stays_a_lamp() -> None:
    table = seen("dresser", "dresser", 0.0, number=2)
    assert kind_of(seen("lamp", "lamp", 1.0), table) == ["lamp", "dresser"]


@pytest.mark.parametrize("height_m", [1.0, 1.45, 1.9])
def test_probabilities_add_up_whatever_the_cameras_height(height_m) -> None:
    objects = [seen("chair", "chair", 0.0, height_m=height_m), seen("table", "table", 0.0, (1, 3), height_m, 2)]
    for senses in sense_probabilities(objects, K, LEVEL, height_m):
        assert sum(senses.values()) == pytest.approx(1.0)
        assert min(senses.values()) > 0


def test_words_that_mean_one_kind_stay() -> None:
    assert kind_of(seen("refrigerator", "lamp", 2.0)) == ["refrigerator"]


def test_geometry_is_told_what_else_a_word_may_mean() -> None:
    cabinet, fridge = understood(
        seen("cabinet", "sideboard", 0.0), seen("refrigerator", "refrigerator", 0.0, (1, 3), number=2)
    )
    kinds, shares = zip(*cabinet.meanings, strict=True)
    assert {"cabinet", "sideboard"} <= set(kinds)
    assert list(shares) == sorted(shares, reverse=True)
    assert fridge.meanings == ()
