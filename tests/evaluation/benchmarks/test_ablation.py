"""Certificates: changes of figures are of the same photos and rooms, and say how sure they are."""

from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_core.evaluation.benchmarks.ablation import Figures, build, certificate, changes
from diorama_core.evaluation.benchmarks.photo_build import PhotoScores
from diorama_core.evaluation.benchmarks.photos import PhotoPlan
from diorama_core.evaluation.benchmarks.system_tables import CaseResult
from diorama_core.evaluation.metrics.annotated import ObjectResult
from diorama_core.evaluation.metrics.scene import SceneScores
from diorama_core.library.catalogue import built_in_library


def photo(name: str, errors_deg: list[float]) -> PhotoScores:
    objects = (
        ObjectResult(name, k, "chair", "chair", False, front_error_deg=error) for k, error in enumerate(errors_deg)
    )
    return PhotoScores(name, tuple(objects))


BEFORE = Figures((photo("a", [0, 10, 100, 5]), photo("b", [3, 90]), photo("c", [1, 2])))
AFTER = Figures((photo("b", [90, 90]), photo("a", [0, 170, 100, 5])))


def test_photos_that_were_built_both_ways_are_compared():
    change = changes(BEFORE, AFTER)["front"]
    assert change.by == pytest.approx(-2 / 6)
    low, high = change.interval
    assert -0.5 <= low <= change.by <= high < 0
    assert "loose" not in changes(BEFORE, AFTER)
    assert "rooms, own Acc" not in changes(BEFORE, AFTER)


def test_rooms_are_compared_where_there_are_any():
    rooms = tuple(CaseResult(f"room {k}", SceneScores.failure(4), 1.0, 1.0) for k in range(3))
    found = changes(replace(BEFORE, rooms=rooms), replace(AFTER, rooms=rooms))
    assert found["rooms, own Acc"].by == 0.0


def test_a_certificate_says_what_was_measured_on_what():
    written = certificate(0.5, BEFORE, {"left out": AFTER}, "python scripts/ablate.py x")
    assert (written["number"], written["command"]) == (0.5, "python scripts/ablate.py x")
    assert written["cases"] == {"photos": 3, "objects": 8, "rooms": 0}
    assert written["changes"]["left out"]["front"]["by"] == pytest.approx(-0.3333)


def test_nothing_is_built_of_no_photos():
    assert build({"layout.weights.outline": 2.0}, PhotoPlan(()), built_in_library()) == Figures(())
