"""Why an object is where it is and what it is: the terms that decided, compared with one another."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.artefacts import Decision, Reason
from diorama_core.scene.types import Scene, SceneObject


@dataclass(frozen=True)
class ReasonScale:
    """How reasons are measured; nothing of the scene depends on it."""

    sigma_cm: float = 5.0
    """Standard deviation of positions reasoned from a photo alone: what a move is compared with."""
    max_nats: float = 10.0
    """No reason counts more: beyond it one is as certain as another."""
    least_nats: float = 0.05
    """Terms of a place that count less are not told."""
    least_move_cm: float = 1.0
    """Nobody sees a shorter move."""
    change: float = 0.1
    """Places and sizes are explained by what it would cost to be a tenth farther or larger."""
    rare: float = 1e-3
    """Least probability or odds told apart from none, as where kinds are decided (`retrieval.seen_kinds`)."""
    hung_nats: float = 2.3
    """How much likelier a kind is held as it usually is: retrieval takes one in ten to be held otherwise."""


SCALE = ReasonScale()

HEADINGS: Mapping[Decision, str] = {
    "place": "Place",
    "support": "Support",
    "front": "Front",
    "kind": "Kind",
    "size": "Size",
}
"""What decisions are called where people read them."""


def strength(reason: Reason) -> float:
    """How much a reason counts beside others, in nats: a move as much as it is unlikely by chance."""
    nats = 0.5 * (reason.amount / SCALE.sigma_cm) ** 2 if reason.unit == "cm" else abs(reason.amount)
    return min(nats, SCALE.max_nats)


def strongest(reasons: Sequence[Reason], object_id: str, count: int = 2) -> tuple[Reason, ...]:
    """The strongest reasons of one object, strongest first, each for another decision."""
    of_object = sorted(
        (r for r in reasons if r.object_id == object_id), key=lambda r: (-strength(r), r.decision, r.term)
    )
    first: dict[Decision, Reason] = {}
    for reason in of_object:
        first.setdefault(reason.decision, reason)
    return tuple(first.values())[:count]


def reason_text(reason: Reason) -> str:
    """A reason in words, with its amount: `Kind: named “chair” by you (6.2)`."""
    amount = f"{reason.amount:.0f} cm" if reason.unit == "cm" else f"{reason.amount:.1f}"
    return f"{HEADINGS[reason.decision]}: {reason.sentence} ({amount})"


def reasons_of_change(before: Scene, after: Scene, term: str, sentence: str) -> tuple[Reason, ...]:
    """What a rule or a stage changed about the objects of a scene, by how far it moved them.

    Args:
        before: the scene without it.
        after: the scene with it.
        term: what changed it.
        sentence: why, in plain words.
    """
    old = {item.id: item for item in before.objects}
    reasons = []
    for item in after.objects:
        if item.id in old:
            reasons += _changes(old[item.id], item, _parent(before, item.id), _parent(after, item.id))
    return tuple(Reason(object_id, decision, term, cm, "cm", sentence) for object_id, decision, cm in reasons)


def _changes(
    before: SceneObject, after: SceneObject, parent: str | None, new_parent: str | None
) -> list[tuple[str, Decision, float]]:
    """What differs of one object: the id, the decision, and how far it moved."""
    moved_cm = _cm(before, after, lambda item: item.pose.position)
    changes: list[tuple[str, Decision, float]] = []
    if parent != new_parent:
        changes.append((after.id, "support", moved_cm))
    elif moved_cm >= SCALE.least_move_cm:
        changes.append((after.id, "place", moved_cm))
    turned_cm = _cm(before, after, lambda item: 0.5 * item.size_m[0] * item.pose.R_world_object[:, 0])
    if before.shape_id == after.shape_id and turned_cm >= SCALE.least_move_cm:
        changes.append((after.id, "front", turned_cm))
    grown_cm = _cm(before, after, lambda item: item.size_m)
    if grown_cm >= SCALE.least_move_cm:
        changes.append((after.id, "size", grown_cm))
    return changes


def _cm(before: SceneObject, after: SceneObject, of: Callable[[SceneObject], np.ndarray]) -> float:
    return 100.0 * float(np.linalg.norm(np.asarray(of(after)) - np.asarray(of(before))))


def _parent(scene: Scene, object_id: str) -> str | None:
    edge = scene.support_of(object_id)
    return None if edge is None else edge.parent
