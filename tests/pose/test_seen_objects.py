"""What the picture says of a posed object."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.silhouette import ShapeCaster
from diorama_core.pose.details import InnerEdges
from diorama_core.pose.seen_objects import SeenObject
from diorama_core.pose.settings import SETTINGS
from diorama_core.scene.types import Pose
from tests.pose.rooms import LIBRARY
from tests.pose.test_outline_fit import CAMERA, TRUE, evidence


def table(measured: bool, trust: float = 1.0) -> SeenObject:
    """A table in a picture of one grey."""
    k = CAMERA.intrinsics
    of = evidence(measured, trust)
    edges = InnerEdges.of(np.full((k.height, k.width, 3), 90, np.uint8), of.seen)
    return SeenObject(of, of, edges, TRUE, 5000, trust, "table")


@pytest.mark.parametrize("measured", [False, True])
def test_the_shape_in_its_place_agrees_best(measured: bool) -> None:
    seen, caster = table(measured), ShapeCaster(LIBRARY.mesh("table"))
    aside = Pose(TRUE.R_world_object, TRUE.position + np.array([0.1, 0.0, 0.0]), TRUE.scale)
    assert seen.score(caster, TRUE) > seen.score(caster, aside) + 0.5
    assert seen.edges_in(caster, TRUE) == 0.0


def test_outlines_count_as_much_as_their_masks_are_trusted() -> None:
    assert table(measured=False, trust=0.5).outline_weight == pytest.approx(0.5 * SETTINGS.shapes.outline)
    assert table(measured=True, trust=0.5).outline_weight == SETTINGS.shapes.outline_with_depth


def test_only_what_comes_in_sets_or_is_not_surely_outlined_may_have_agreed_on_a_shape() -> None:
    assert not replace(table(measured=False), category="bookshelf").may_have_agreed
    assert replace(table(measured=False, trust=0.9), category="bookshelf").may_have_agreed
    assert replace(table(measured=False), category="chair").may_have_agreed


def test_an_outline_of_our_own_may_tell_a_profile_but_no_place_to_a_hundredth() -> None:
    ours, given = table(measured=False, trust=0.95), table(measured=False)
    assert ours.is_surely_outlined
    assert given.is_surely_outlined
    assert not ours.has_given_mask
    assert given.has_given_mask
