"""What the picture of a thing looks like, as evidence for its kind."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import DetectedObject, SeenKinds
from diorama_core.library.labels import meanings
from diorama_core.library.taxonomy import category
from diorama_core.retrieval.seen_kinds import as_it_looks, as_measured, with_seen_kinds


def thing(name: str) -> DetectedObject:
    return DetectedObject(name, "chair", "chair", (0.0, 0.0, 9.0, 9.0), np.zeros((1, 1), bool), 1, 1.0)


def test_objects_learn_what_they_look_like() -> None:
    seen = (SeenKinds("b", ("chair", "stool"), np.array([0.25, 0.75])),)
    first, second = with_seen_kinds((thing("a"), thing("b")), seen)
    assert first.looks_like == ()
    assert second.looks_like == (("chair", 0.25), ("stool", 0.75))
    assert with_seen_kinds((first,), None) == (first,)


def test_looks_decide_between_kinds_that_are_as_likely() -> None:
    shares = {"chair": 0.5, "stool": 0.5}
    found = as_it_looks(shares, (("chair", 0.1), ("stool", 0.8)), named=False)
    said = as_it_looks(shares, (("chair", 0.1), ("stool", 0.8)), named=True)
    assert found["stool"] > said["stool"] > 0.6
    assert sum(found.values()) == pytest.approx(1.0)
    assert as_it_looks(shares, (), named=False) == shares


def test_no_kind_is_ruled_out_by_looks_alone() -> None:
    assert as_it_looks({"chair": 1.0, "stool": 1.0}, (("chair", 1.0),), named=False)["stool"] > 0.002


def likely(word: str, size_m) -> dict[str, float]:
    found = as_measured(meanings(word, word), np.array(size_m))
    whole = sum(found.values())
    return {kind: value / whole for kind, value in found.items()}


@pytest.mark.parametrize(
    ("word", "kind"),
    [("table", "coffee table"), ("table", "side table"), ("table", "table"), ("cabinet", "sideboard"),
     ("cabinet", "wardrobe"), ("cabinet", "night stand"), ("lamp", "floor lamp"), ("chair", "armchair")],
)  # fmt: skip
def test_a_size_makes_kinds_that_are_so_large_likelier(word, kind) -> None:
    size_m = np.exp(category(kind).priors[0].log_median_xyz)
    assert likely(word, size_m)[kind] > 1.25 * meanings(word, word)[kind]


def test_width_and_depth_may_have_changed_places() -> None:
    assert likely("table", (0.4, 1.2, 0.8)) == pytest.approx(likely("table", (1.2, 0.4, 0.8)))


def test_a_size_that_fits_nothing_leaves_every_kind_possible() -> None:
    for size_m in ((30.0, 30.0, 30.0), (0.0, 0.0, 0.0)):
        found = likely("table", size_m)
        assert all(0 < share < 1 for share in found.values())
