"""What holds places and sizes: the box in the photo, the kind's usual size, what is below."""

from __future__ import annotations

import pytest

from diorama_core.artefacts import Reason
from diorama_core.pipeline import codec
from tests.perception.metrology.test_metrology import ROOM, measure, rotation, seen


@pytest.fixture(scope="module")
def reasons() -> tuple[Reason, ...]:
    R = rotation(12.0)
    geometry = measure(seen(ROOM, R, 1.5), R)
    assert geometry.reasons is not None
    assert codec.load(codec.dump(geometry)).reasons == geometry.reasons
    return geometry.reasons


def of(reasons: tuple[Reason, ...], object_id: str, decision: str) -> dict[str, Reason]:
    return {r.term: r for r in reasons if r.object_id == object_id and r.decision == decision}


def test_the_photo_places_a_sofa_and_its_kind_gives_its_size(reasons: tuple[Reason, ...]) -> None:
    place = of(reasons, "sofa_0", "place")
    assert place["outline"].amount > 1.0
    assert place["foot"].amount > 1.0
    assert "usual size" not in place, "where it is does not change how large it is"
    size = of(reasons, "sofa_0", "size")
    assert size["outline"].amount > 0.0
    assert size["usual size"].amount > 0.0


def test_a_support_is_told_by_what_is_seen_of_the_foot_and_by_the_kind(reasons: tuple[Reason, ...]) -> None:
    assert of(reasons, "sofa_0", "support")["foot"].sentence.endswith("on the floor")
    assert of(reasons, "lamp_4", "support")["foot"].sentence.endswith("on the night stand")
    assert of(reasons, "picture_6", "support")["kind"].sentence == "its kind hangs on walls"
