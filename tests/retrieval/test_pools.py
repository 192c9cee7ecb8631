"""Which shapes are looked at for an object."""

from __future__ import annotations

import numpy as np

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, category
from diorama_core.retrieval.pools import (
    RELATED,
    RetrievalQuery,
    near_kinds,
    pool_for,
    sense_factor,
)

LIBRARY = built_in_library()


def pool(name: str, size, holds: bool = False):
    return pool_for(LIBRARY, RetrievalQuery(name, np.array(size), holds, {name: 1.0}))


def test_every_category_knows_its_near_kinds() -> None:
    names = {c.name for c in CATEGORIES} - {UNKNOWN.name}
    assert set(RELATED) <= {name for name in names if not category(name).kin}
    assert all(near_kinds(name) for name in names)
    assert all(near in names and near != name for name in names for near in near_kinds(name))


def test_kinds_that_a_word_may_mean_are_looked_at_the_likelier_the_more_they_count() -> None:
    senses = {"chair": 0.6, "office chair": 0.3, "recliner": 0.001}
    found = pool_for(LIBRARY, RetrievalQuery("chair", np.array((0.5, 0.5, 0.9)), False, senses))
    factors = {m.shape.category: m.kind_factor for m in found.members}
    assert factors == {"chair": 1.0, "office chair": sense_factor(0.5)}
    assert sense_factor(0.1) < sense_factor(0.5) < 1.0


def test_many_kinds_are_looked_at_where_no_word_says_what_an_object_is() -> None:
    kinds = ("chair", "stool", "table", "bench", "sofa", "bed", "desk", "plant", "box", "basket")
    senses = {kind: 0.9 if kind == "chair" else 0.01 for kind in kinds}
    size = np.array((0.5, 0.5, 0.9))
    unnamed = pool_for(LIBRARY, RetrievalQuery("chair", size, False, senses, named=False))
    named = pool_for(LIBRARY, RetrievalQuery("chair", size, False, senses))
    assert {m.shape.category for m in unnamed.members} == set(kinds)
    assert {m.shape.category for m in named.members} == {"chair"}


def test_every_category_finds_something_in_the_built_in_library() -> None:
    for one in CATEGORIES:
        prior = one.priors[0]
        found = pool(one.name, (prior.depth_m, prior.width_m, prior.height_m))
        assert 1 <= len(found.members) <= 60, one.name
        assert all(0.0 < m.kind_factor <= 1.0 for m in found.members), one.name


def test_a_chair_is_looked_for_among_chairs_only() -> None:
    found = pool("chair", (0.5, 0.5, 0.9))
    assert {m.shape.category for m in found.members} == {"chair"}
