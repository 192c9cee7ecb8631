"""Kind, shape and colours of an object that another photo shows better."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diorama_core.multiview.settings import SETTINGS
from diorama_core.scene.types import Candidate, SceneObject


def better_seen(item: SceneObject, present: SceneObject, share: float) -> SceneObject:
    """The object with its shape by all photos, and the colours that go with it.

    Args:
        item: as the photos so far have it.
        present: as the new photo alone has it, in the same place.
        share: how much the new photo counts, 0 to 1; those so far count for the rest.
    """
    candidates = joint_candidates(item.candidates, present.candidates, share)
    if not candidates:
        return item
    best = candidates[0]
    alike = replace(item, candidates=candidates, confidence=max(item.confidence, present.confidence))
    if best.shape_id == present.shape_id:
        return replace(
            alike,
            category=present.category,
            shape_id=best.shape_id,
            shape_size_m=best.shape_size_m,
            pose=present.pose,
            colour=present.colour,
            photo_materials=present.photo_materials,
        )
    if best.shape_id == item.shape_id:
        return alike
    # Materials are of the slots of one shape; of another one only the main colour is known.
    return replace(
        alike,
        shape_id=best.shape_id,
        shape_size_m=best.shape_size_m,
        pose=best.pose,
        colour=present.colour if present.colour is not None else item.colour,
        photo_materials=(),
    )


def joint_candidates(known: Sequence[Candidate], new: Sequence[Candidate], share: float) -> tuple[Candidate, ...]:
    """The candidates of both by their scores together, best first; poses are the new photo's where it has one.

    Scores are compared with the best of their own photo.

    Args:
        known: of the photos so far.
        new: of the new photo.
        share: what the new photo counts, 0 to 1.
    """
    so_far, now = _relative(known), _relative(new)
    posed = {c.shape_id: c for c in (*known, *new)}

    def score(shape_id: str) -> float:
        a = so_far.get(shape_id, SETTINGS.unseen_shape * min(so_far.values(), default=0.0))
        b = now.get(shape_id, SETTINGS.unseen_shape * min(now.values(), default=0.0))
        return (1.0 - share) * a + share * b

    ranked = sorted(posed, key=lambda shape_id: (-score(shape_id), shape_id))
    most = max(len(known), len(new))
    return tuple(replace(posed[shape_id], score=score(shape_id)) for shape_id in ranked[:most])


def _relative(candidates: Sequence[Candidate]) -> dict[str, float]:
    best = max((c.score for c in candidates), default=0.0)
    return {c.shape_id: c.score / best if best > 0 else 0.0 for c in candidates}
