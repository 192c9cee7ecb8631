"""What the picture of a thing looks like, as evidence for its kind."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import DetectedObject, SeenKinds
from diorama_core.retrieval.seen_kinds import as_it_looks, with_seen_kinds


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
