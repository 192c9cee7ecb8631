"""Perturbed photos: what is true of them follows, the same each time, and a wrong name is said."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.photo_annotations import AnnotatedPhoto
from diorama_core.evaluation.benchmarks.photo_perturbations import (
    PERTURBATIONS,
    AnnotatedInputs,
    perturb,
    perturbations_named,
)
from diorama_core.scene.types import Intrinsics

WIDTH, HEIGHT = 200, 100
BOXES = ((20.0, 40.0, 60.0, 90.0), (30.0, 20.0, 50.0, 40.0), (120.0, 30.0, 180.0, 80.0), (0.0, 0.0, 8.0, 8.0))
COLOUR = (120, 90, 60)


@pytest.fixture
def case() -> AnnotatedInputs:
    """Four boxes filled with one colour on white, the second standing on the first."""
    rgb = np.full((HEIGHT, WIDTH, 3), 255, np.uint8)
    for x1, y1, x2, y2 in np.array(BOXES, int):
        rgb[y1:y2, x1:x2] = COLOUR
    facts = [{"on": "floor", "front": 70, "colour": COLOUR}, {"on": 0}, {"on": "floor"}, {"on": "wall"}]
    things = [{"bbox": box, "class": "cup", "kind": "cup", **fact} for box, fact in zip(BOXES, facts, strict=True)]
    annotation = AnnotatedPhoto.model_validate({"size": (WIDTH, HEIGHT), "things": things})
    boxes = tuple(LabelledBox(box, "cup", "cup") for box in BOXES)
    camera = Intrinsics(WIDTH, HEIGHT, 150, 150, 90, 50)
    return AnnotatedInputs(
        Inputs(Photo(rgb, "p.png", (WIDTH, HEIGHT)), boxes, intrinsics=camera), annotation, (0, 1, 2, 3)
    )


@pytest.mark.parametrize("name", PERTURBATIONS)
def test_the_same_each_time_and_whole(case, name):
    one, two = perturb(case, name), perturb(case, name)
    assert one.inputs == two.inputs
    assert one.annotation == two.annotation
    assert len(one.inputs.boxes) == len(one.annotation.objects) == len(one.indices)
    photo = one.inputs.photo
    assert one.annotation.size == photo.original_size == (photo.width, photo.height)
    assert (one.inputs.intrinsics.width, one.inputs.intrinsics.height) == (photo.width, photo.height)


def test_mirrored_twice_is_as_it_was(case):
    once = perturb(case, "mirrored")
    assert once.annotation.objects[0].front == 290
    assert once.annotation.objects[0].bbox == (140, 40, 180, 90)
    assert once.inputs.intrinsics.cx == 110
    twice = perturb(once, "mirrored")
    assert twice.inputs == case.inputs
    assert twice.annotation == case.annotation


def test_jittered_boxes_are_judged_by_the_true_ones(case):
    moved = perturb(case, "jittered")
    assert moved.annotation == case.annotation
    off = np.array([b.box for b in moved.inputs.boxes]) - np.array(BOXES)
    assert 0 < np.abs(off).max() < 15


def test_dropped_boxes_are_neither_given_nor_asked_for(case):
    for seed in range(20):
        left = perturb(case, "dropped", seed)
        assert len(left.indices) == 3
        assert [o.bbox for o in left.annotation.objects] == [BOXES[k] for k in left.indices]
        if 1 in left.indices:
            carried = left.annotation.objects[left.indices.index(1)]
            assert carried.on == (left.indices.index(0) if 0 in left.indices else None)


def test_colours_follow_the_light(case):
    lit = perturb(case, "exposed")
    shown = lit.inputs.photo.rgb[60, 40]
    assert np.abs(shown.astype(float) - COLOUR).max() > 5
    assert lit.annotation.objects[0].colour == pytest.approx(shown, abs=1)


@pytest.mark.parametrize("name", ["rolled", "cropped"])
def test_boxes_follow_the_picture(case, name):
    moved = perturb(case, name)
    for place, index in enumerate(moved.indices[:3]):
        x1, y1, x2, y2 = moved.annotation.objects[place].bbox
        inside = moved.inputs.photo.rgb[int(y1 + 5) : int(y2 - 5), int(x1 + 5) : int(x2 - 5)]
        assert (inside < 200).mean() > 0.9, index
        assert moved.inputs.boxes[place].box == pytest.approx((x1, y1, x2, y2))


def test_a_crop_moves_the_camera_s_centre_and_leaves_out_what_it_cuts_off(case):
    cut = perturb(case, "cropped")
    assert cut.inputs.photo.width < WIDTH
    assert 3 not in cut.indices
    shift = BOXES[2][0] - cut.annotation.objects[cut.indices.index(2)].bbox[0]
    assert cut.inputs.intrinsics.cx == pytest.approx(90 - shift)


def test_names_are_checked():
    assert perturbations_named(()) == tuple(PERTURBATIONS)
    assert perturbations_named(("rolled",)) == ("rolled",)
    with pytest.raises(InputError, match="--perturbed tilted: give one or more of mirrored"):
        perturbations_named(("tilted",))
