from __future__ import annotations

import numpy as np

from diorama_core.pose.correspondence.crops import PATCHES
from diorama_core.pose.correspondence.matching import cyclic_matches, similarities, template_scores

COUNT = PATCHES**2


def unit(seed: int) -> np.ndarray:
    vectors = np.random.default_rng(seed).normal(size=(COUNT, 24))
    return (vectors / np.linalg.norm(vectors, axis=1, keepdims=True)).astype(np.float32)


def test_a_view_matches_itself_patch_by_patch() -> None:
    inside = np.zeros(COUNT, dtype=bool)
    inside[40:90] = True
    query = unit(0)
    views = np.stack([unit(1), query])
    alike = similarities(query, views, inside, np.stack([inside, inside]))
    assert alike.shape == (2, 50, COUNT)
    matches = cyclic_matches(alike, np.flatnonzero(inside))
    assert matches.count[1] == 50
    assert (matches.query[1, :50] == matches.template[1, :50]).all()
    assert matches.mean_similarity[1] > 0.999
    assert template_scores(alike).argmax() == 1


def test_outside_the_shape_nothing_matches() -> None:
    inside = np.zeros(COUNT, dtype=bool)
    inside[:30] = True
    alike = similarities(unit(0), unit(0)[None], inside, ~inside[None])
    matches = cyclic_matches(alike, np.flatnonzero(inside))
    assert not set(matches.template[0, : matches.count[0]]) & set(range(30))


def test_matches_that_do_not_come_home_are_dropped() -> None:
    inside = np.zeros(COUNT, dtype=bool)
    inside[[0, 1, 255]] = True
    query = unit(0)
    # Patches 0 and 255 look alike: the way back from their common neighbour ends at one of them only.
    query[255] = query[0]
    view = unit(5)
    view[7] = query[0]
    alike = similarities(query, view[None], inside, np.ones((1, COUNT), dtype=bool))
    matches = cyclic_matches(alike, np.flatnonzero(inside))
    believed = matches.query[0, : matches.count[0]]
    assert believed[0] == 0
    assert 255 not in believed


def test_no_patch_no_match() -> None:
    nothing = np.zeros(COUNT, dtype=bool)
    alike = similarities(unit(0), unit(1)[None], nothing, np.ones((1, COUNT), dtype=bool))
    matches = cyclic_matches(alike, np.flatnonzero(nothing))
    assert matches.count[0] == 0
    assert matches.mean_similarity[0] == 0.0
    assert template_scores(alike)[0] == 0.0
