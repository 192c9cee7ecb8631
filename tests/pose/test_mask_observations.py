from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.observed import observe_among
from diorama_core.geometry.see_through import SeeThrough
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.mask_observations import Evidence
from tests.pose.rooms import LIBRARY, Room, camera_at, standing


@pytest.fixture(scope="module")
def evidence() -> Evidence:
    """A chair's outline from a photo alone."""
    room = Room(camera_at(), (standing("chair", 0.2, 2.6, 30.0),), (0,))
    centres = np.array([c.centre for c in room.geometry.cuboids])
    return Evidence(room.camera, observe_among(room.camera, room.objects, centres, [None], 0, 32), None)


def enlarged_cost(evidence: Evidence, shape_size_m: tuple[float, float, float], scale: tuple[float, ...]) -> float:
    """Cost of an enlarged doubtful mask."""
    evidence = replace(evidence, seen=replace(evidence.seen, mask_trust=0.6))
    limits = SizeLimits.of(shape_size_m, "blanket", np.array([0.6, 0.9, 0.15]))
    return evidence.enlargement_cost(np.array(scale), limits)


def test_a_folded_blanket_twice_as_large_is_less_likely_than_a_throw_of_its_size(evidence: Evidence) -> None:
    folded = enlarged_cost(evidence, (0.34, 0.42, 0.3), (1.8, 2.2, 1.6))
    throw = enlarged_cost(evidence, (0.7, 1.1, 0.3), (0.9, 0.85, 1.1))
    assert throw < 0.1
    assert folded > throw + 0.5


def test_smaller_counts_as_larger_does_and_thickness_of_thin_things_says_nothing(evidence: Evidence) -> None:
    assert enlarged_cost(evidence, (0.5, 0.5, 0.5), (2.0, 2.0, 2.0)) == pytest.approx(
        enlarged_cost(evidence, (0.5, 0.5, 0.5), (0.5, 0.5, 0.5))
    )
    assert enlarged_cost(evidence, (1.0, 1.0, 0.01), (1.0, 1.0, 5.0)) == 0.0


def test_with_depth_a_shape_of_another_size_is_less_likely_but_never_ruled_out(evidence: Evidence) -> None:
    limits = SizeLimits.of((0.5, 0.5, 0.9), "chair", np.array([0.5, 0.5, 0.9]), measured=True)
    same, larger, twice = (evidence.log_likelihood(0.2, np.full(3, factor), limits) for factor in (1.0, 1.3, 2.0))
    assert same > larger > twice
    better_fit = evidence.log_likelihood(0.04, np.full(3, 2.0), limits)
    assert better_fit > same


def test_a_sure_outline_tells_shapes_apart_whatever_their_size(evidence: Evidence) -> None:
    limits = SizeLimits.of((0.34, 0.42, 0.3), "blanket", np.array([0.6, 0.9, 0.15]))
    sure = replace(evidence, seen=replace(evidence.seen, mask_trust=1.0))
    doubtful = replace(evidence, seen=replace(evidence.seen, mask_trust=0.5))
    assert sure.enlargement_cost(np.full(3, 2.0), limits) == 0.0 < doubtful.enlargement_cost(np.full(3, 2.0), limits)

    def lead(of: Evidence) -> float:
        return of.sure_outline_cost(0.4) - of.sure_outline_cost(0.1)

    assert lead(sure) > 10 * lead(doubtful) > 0.0


def test_shapes_are_told_apart_by_their_fit_before_their_size(evidence: Evidence) -> None:
    limits = SizeLimits.of((0.5, 0.5, 0.9), "chair", np.array([0.5, 0.5, 0.9]), measured=True)

    def likelihood(error: float, scale: tuple[float, float, float]) -> float:
        return evidence.log_likelihood(error, np.array(scale), limits)

    assert likelihood(0.2, (1.0, 1.0, 1.0)) > likelihood(0.2, (1.4, 1.4, 1.4)) > likelihood(0.2, (2.0, 2.0, 2.0))
    assert likelihood(0.2, (1.0, 1.0, 1.0)) > likelihood(0.2, (1.0, 1.4, 1.0))
    assert likelihood(0.1, (1.4, 1.4, 1.4)) > likelihood(0.2, (1.0, 1.0, 1.0))


def test_where_one_looks_past_an_object_tells_open_shapes_from_closed_ones(evidence: Evidence) -> None:
    cells, seen = evidence.seen.window.cells, evidence.seen
    open_ = np.zeros((cells, cells), dtype=bool)
    open_[8:24, [8, 9, 22, 23]] = open_[[8, 9], 8:24] = True
    closed = np.zeros_like(open_)
    closed[8:24, 8:24] = True
    filled = replace(evidence, seen=replace(seen, covered=closed.ravel().astype(float), mask_trust=0.9))
    weight = np.ones(cells * cells)
    told = replace(filled, see_through=SeeThrough(seen.window, open_.ravel().astype(float), weight, 0.8))
    shapes = np.stack([open_.ravel(), closed.ravel()])
    assert filled._outline(shapes).argmax() == 1
    assert told._outline(shapes).argmax() == 0
    silent = replace(told, see_through=replace(told.see_through, share=0.0))
    np.testing.assert_allclose(silent._outline(shapes), filled._outline(shapes))


def test_a_shape_that_is_open_where_one_sees_past_the_object_is_likelier(evidence: Evidence) -> None:
    room = Room(camera_at(), (standing("chair", 0.2, 2.6, 30.0),), (0,))
    caster = ShapeCaster(LIBRARY.mesh("chair"))
    pose = room.placed[0].pose
    poses = PoseBatch.single(pose)
    shown = evidence.seen.silhouettes(caster, poses)[0].astype(float)
    told = SeeThrough(evidence.seen.window, shown, np.ones(len(shown)), 0.8)
    smaller = PoseBatch(poses.R, poses.position, 0.5 * poses.scale)
    right, wrong = (replace(evidence, see_through=told).see_through_score(caster, p) for p in (poses, smaller))
    assert right == pytest.approx(0.0, abs=1e-6)
    assert wrong < right - 0.3
    assert evidence.see_through_score(caster, smaller) == 0.0
