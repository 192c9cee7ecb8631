"""The shapes of one object, each in its best pose, and the candidates that they make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.arrangement.facing.solve import Facings
from diorama_core.artefacts import PosedCandidates
from diorama_core.library.record import Shape
from diorama_core.pose.posing_tasks import PosingTask
from diorama_core.scene.types import Candidate, Pose


@dataclass(frozen=True, eq=False)
class PosedShape:
    """One shape's best pose."""

    shape: Shape
    pose: Pose
    error: float
    """Disagreement with the picture, 0 to 1."""
    rank: float
    """By which the shapes of one object are ordered: a logarithm, higher is better."""
    doubt: float = 0.0
    """How nearly as well it fits when turned otherwise: 0 to 1."""


def ordered_shapes(shapes: Sequence[PosedShape], ranks: Mapping[str, float]) -> tuple[PosedShape, ...]:
    """The shapes of one object by rank, the best first."""
    return tuple(sorted(shapes, key=lambda posed: (-ranks[posed.shape.id], posed.shape.id)))


def candidates_of(
    task: PosingTask, ordered: Sequence[PosedShape], ranks: Mapping[str, float], facings: Facings
) -> PosedCandidates:
    """The posed shapes of one object; scores are relative to the best one's agreement with the picture.

    Args:
        task: of the object.
        ordered: its posed shapes, best first.
        ranks: log score of each shape id.
        facings: what was decided about all objects' fronts, with reasons.
    """
    best = ordered[0]
    top = ranks[best.shape.id]
    candidates = tuple(
        Candidate(p.shape.id, p.shape.size_m, float(np.exp(ranks[p.shape.id] - top) * (1.0 - best.error)), p.pose)
        for p in ordered
    )
    confidence = task.fine.confidence(best.error, task.cuboid.confidence) * (1.0 - 0.5 * best.doubt)
    reasons = tuple(share for share in facings.shares if share.object_id == task.item.id)
    headings = facings.probabilities_of(task.item.id)
    return PosedCandidates(task.item.id, candidates, confidence, reasons, headings)
