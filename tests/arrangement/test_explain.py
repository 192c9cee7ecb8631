"""Reasons are compared in one currency, and the strongest of each decision is told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.arrangement.explain import reason_text, reasons_of_change, strength, strongest
from diorama_core.artefacts import Reason
from diorama_core.scene.types import Support
from tests.app.small_room import furnished_scene


def test_the_strongest_reason_of_each_decision_comes_first() -> None:
    reasons = (
        Reason("chair", "front", "picture", 0.4, "nats", "the picture shows it so"),
        Reason("chair", "front", "at table", 2.1, "nats", "seats face what they serve"),
        Reason("chair", "kind", "word", 5.0, "nats", "named “chair” by you"),
        Reason("chair", "size", "outline", -0.2, "nats", "it looks that large in the photo"),
        Reason("table", "kind", "word", 9.0, "nats", "named “table” by you"),
    )
    assert [r.term for r in strongest(reasons, "chair")] == ["word", "at table"]
    assert reason_text(reasons[1]) == "Front: seats face what they serve (2.1)"
    assert not strongest(reasons, "lamp")


def test_a_move_counts_as_much_as_it_is_unlikely() -> None:
    near, far = (Reason("chair", "place", "layout", cm, "cm", "clear of others") for cm in (5.0, 15.0))
    assert strength(near) == pytest.approx(0.5)
    assert strength(far) == pytest.approx(4.5)
    assert reason_text(far) == "Place: clear of others (15 cm)"


def test_what_a_rule_moved_put_elsewhere_and_grew_is_told_and_nothing_else() -> None:
    before = furnished_scene()
    chair, *others = before.objects
    moved = replace(chair, pose=replace(chair.pose, position=chair.pose.position + np.array([0.12, 0.0, 0.0])))
    after = replace(before, objects=(moved, *others))
    (reason,) = reasons_of_change(before, after, "at walls", "its back is at the wall")
    assert (reason.object_id, reason.decision, reason.unit) == (chair.id, "place", "cm")
    assert reason.amount == pytest.approx(12.0)
    held = tuple(Support(e.child, others[0].id) if e.child == chair.id else e for e in before.supports)
    (reason,) = reasons_of_change(before, replace(after, supports=held), "support", "it lies there")
    assert reason.decision == "support"
    assert not reasons_of_change(before, before, "layout", "nothing")
