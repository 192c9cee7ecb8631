"""Shapes with a left and a right."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.library.catalogue import base_id, built_in_library
from diorama_core.library.furniture.measures import made_id
from diorama_core.library.furniture.reshaping import MIRRORED
from diorama_core.library.hands import MIN_UNEVEN, other_hand, unevenness
from tests.pose.test_made_to_measure import ranked

LIBRARY = built_in_library()


@pytest.mark.parametrize("shape_id", ["desk-office-grey", "sectional-sofa-chaise-left-grey", "bookshelf-stepped-birch"])
def test_shapes_with_a_left_and_a_right_are_uneven(shape_id: str) -> None:
    mirrored = other_hand(LIBRARY, shape_id)
    assert mirrored == made_id(shape_id, np.array(LIBRARY.shape(shape_id).size_m), {MIRRORED: True})
    assert other_hand(LIBRARY, mirrored) == shape_id
    own, image = unevenness(LIBRARY.mesh(shape_id)), unevenness(LIBRARY.mesh(mirrored))
    assert own > MIN_UNEVEN
    assert image == pytest.approx(own, rel=1e-6)


@pytest.mark.parametrize("shape_id", ["chair-cross-black", "dresser-white-four", "vase-moon-stone"])
def test_even_shapes_have_no_mirror_image(shape_id: str) -> None:
    assert other_hand(LIBRARY, shape_id) is None


def test_what_was_changed_stays_changed_in_the_mirror_image() -> None:
    made = "desk-office-grey+made-800x1600x740"
    assert other_hand(LIBRARY, made) == f"{made};mirrored=yes"
    assert other_hand(LIBRARY, f"{made};mirrored=yes") == made


def test_stretching_does_not_make_a_shape_uneven() -> None:
    assert unevenness(trimesh.creation.box((1.0, 3.0, 0.2))) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("measured", [False, True])
def test_a_desk_with_its_drawers_at_the_other_side_is_built_so(measured: bool) -> None:
    size = np.array(LIBRARY.shape("desk-pedestal-walnut").size_m)
    true = made_id("desk-pedestal-walnut", size, {MIRRORED: True})
    best = ranked(true, ("desk-writing-oak", "desk-pedestal-walnut"), measured)[0]
    assert base_id(best.shape_id) == "desk-pedestal-walnut"
    assert "mirrored=yes" in best.shape_id
