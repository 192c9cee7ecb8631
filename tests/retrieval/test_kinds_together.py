"""Kinds of all things of a photo, decided together."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.retrieval import kinds_together as module
from diorama_core.retrieval.kinds_together import carriers, kinds_together

UNDECIDED = {"pillow": 0.5, "box": 0.5}


def test_the_smallest_larger_box_around_a_foot_is_the_carrier() -> None:
    room, table, cup, beside = (0, 0, 100, 100), (20, 40, 60, 80), (30, 30, 36, 45), (70, 60, 80, 101)
    assert carriers([room, table, cup, beside]) == [None, 0, 1, None]


def test_an_object_on_the_floor_before_another_has_no_carrier() -> None:
    assert carriers([(0, 0, 50, 50), (10, 30, 20, 52)]) == [None, None]
    assert carriers([]) == []


def test_what_lies_on_a_sofa_is_a_pillow_and_makes_it_one() -> None:
    on_sofa = kinds_together([{"sofa": 1.0}, UNDECIDED], [None, 0])
    on_table = kinds_together([{"table": 1.0}, UNDECIDED], [None, 0])
    assert on_sofa[1]["pillow"] > 0.7 > 0.5 > on_table[1]["pillow"]
    unsure = {"sofa": 0.5, "table": 0.5}
    assert kinds_together([unsure, {"pillow": 1.0}], [None, 0])[0]["sofa"] > 0.6
    assert kinds_together([unsure, {"bowl": 1.0}], [None, 0])[0]["sofa"] < 0.4


def test_objects_of_one_room_go_together() -> None:
    unsure = {"desk": 0.5, "vanity table": 0.5}
    office = kinds_together([unsure, {"office chair": 1.0}, {"printer": 1.0}], [None, None, None])
    bedroom = kinds_together([unsure, {"bed": 1.0}, {"night stand": 1.0}], [None, None, None])
    assert office[0]["desk"] > 0.5 > bedroom[0]["desk"]


def test_an_object_alone_keeps_what_is_known_of_it() -> None:
    (found,) = kinds_together([{"chair": 0.7, "office chair": 0.3}], [None])
    assert found["chair"] == pytest.approx(0.7, abs=0.15)
    assert sum(found.values()) == pytest.approx(1.0)
    assert kinds_together([], []) == []


def test_what_its_size_says_of_lying_there_counts() -> None:
    as_large, too_large = (module.Lying(("pillow",), ("bed",), np.array([[ratio]])) for ratio in (1.0, 0.1))
    on_bed = [
        kinds_together([{"bed": 1.0}, UNDECIDED], [None, 0], [None, of_box])[1] for of_box in (as_large, too_large)
    ]
    assert on_bed[0] == kinds_together([{"bed": 1.0}, UNDECIDED], [None, 0])[1]
    assert on_bed[0]["pillow"] > 0.7 > 0.65 > on_bed[1]["pillow"]


def test_sums_over_the_forest_are_those_over_all_combinations() -> None:
    alone = [{"bed": 0.4, "sofa": 0.6}, {"pillow": 0.3, "blanket": 0.7}, {"toy": 0.2, "tray": 0.8}, {"pillow": 1.0}]
    carrier_of = [None, 0, 1, 0]
    names = [c.name for c in CATEGORIES]
    lying = module.Lying(("pillow", "blanket"), ("bed",), np.array([[3.0], [0.2]]))
    edges = [module._edge(None), module._edge(lying), *[module._edge(None)] * 2]
    usual = module._rooms()[0]
    own = np.zeros((4, len(names)))
    for row, of_one in zip(own, alone, strict=True):
        for kind, share in of_one.items():
            row[names.index(kind)] = share * usual[names.index(kind)]
    expected, total = np.zeros_like(own), 0.0
    for combination in product(*(np.flatnonzero(row) for row in own)):
        weight = np.prod([own[i, k] for i, k in enumerate(combination)])
        for child, parent in ((1, 0), (2, 1), (3, 0)):
            weight *= edges[child][combination[child], combination[parent]]
        total += weight
        for i, k in enumerate(combination):
            expected[i, k] += weight
    beliefs, log = module._room_marginals(own, carrier_of, edges)
    np.testing.assert_allclose(beliefs, expected / total, atol=1e-12)
    assert log == pytest.approx(np.log(total))
