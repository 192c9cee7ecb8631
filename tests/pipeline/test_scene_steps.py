from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.artefacts import DepthPrediction, Inputs, LabelledBox, Photo
from diorama_core.pipeline.scene_steps import with_network_inputs
from diorama_core.scene.types import Intrinsics

K = Intrinsics.from_fov(8, 6, 1.0)
GIVEN = Inputs(Photo(np.zeros((6, 8, 3), np.uint8), "x", (8, 6)))
BOXES = (LabelledBox((0.0, 0.0, 4.0, 4.0), "chair", "chair"),)
DEPTH = DepthPrediction(np.ones((6, 8), np.float32), np.zeros((6, 8, 3), np.float32), K)


def test_nothing_added_is_the_very_same() -> None:
    assert with_network_inputs(GIVEN, None, None) is GIVEN


def test_boxes_and_depth_are_added_and_the_depth_says_whose_it_is() -> None:
    found = with_network_inputs(GIVEN, BOXES, DEPTH)
    assert found.boxes == BOXES
    assert found.depth_source == "network"
    assert found.intrinsics == K
    assert found.photo is GIVEN.photo
    assert with_network_inputs(GIVEN, (), None).boxes == ()


def test_a_guessed_word_is_left_to_later_stages() -> None:
    guessed = replace(BOXES[0], guessed=True)
    (box,) = with_network_inputs(GIVEN, (guessed,), None).boxes
    assert (box.box, box.category, box.label) == (guessed.box, "object", "object")


def test_given_intrinsics_stay() -> None:
    own = replace(K, fx=99.0)
    assert with_network_inputs(replace(GIVEN, intrinsics=own), None, DEPTH).intrinsics == own
