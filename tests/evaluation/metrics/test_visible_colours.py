"""What colour is mostly seen of an object."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.evaluation.metrics.visible_colours import visible_colours
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Pose, Scene, SceneObject
from tests.synthetic_rooms import look


@pytest.fixture(scope="module")
def library():
    return built_in_library()


def seen(library, shape_id, **changes):
    shape = library.shape(shape_id)
    item = SceneObject(
        id="a", label="a", category=shape.category, shape_id=shape.id, shape_size_m=shape.size_m,
        pose=Pose.upright((0.0, 3.0, shape.size_m[2] / 2), -np.pi / 2),
    )  # fmt: skip
    return visible_colours(Scene(camera=look(0, 12), objects=(replace(item, **changes),)), library)


def test_paint_shows(library):
    red = seen(library, "sofa-grey-three", colour=(0.7, 0.1, 0.1))["a"]
    assert red[0] > 2.5 * red[1]


def test_the_shapes_own_colour_shows_without_paint(library):
    grey = seen(library, "sofa-grey-three")["a"]
    assert np.ptp(grey) < 0.1


def test_what_is_out_of_view_is_left_out(library):
    assert seen(library, "sofa-grey-three", pose=Pose.upright((0.0, -3.0, 0.4))) == {}
