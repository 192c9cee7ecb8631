"""Alternative arrangements: every object with another of its ranked shapes (the paper's Arrangement 1, 2, 3).

In one arrangement objects of a set stay a set: what has one shape in the best reading has one shape in every other.
Arrangements are to look different: of shapes of one form, which the photo's colours would make the same, one is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from diorama_core.scene import edits
from diorama_core.scene.types import Candidate, Pose, Scene, SceneObject

MIN_PLAUSIBLE = 0.3
"""A shape is offered in another arrangement when it scores at least this share of its set's best."""
SAME_FORM = 0.89
"""Shapes with a higher agreement of form (`EmbeddedSimilarity.form_agreement`) differ in colour only."""

Alike = Callable[[str, str], float]
"""How alike two shapes are in form, 0 to 1, by their ids."""


def arrangement(observed: Scene, rank: int, alike: Alike | None = None) -> Scene:
    """The observed scene with every set in the `rank`-th of its plausible shapes, posed as fitted to the picture.

    A set with fewer plausible shapes takes its last; what is locked stays. Where nothing tells shapes of one form
    (`alike`), all shapes are taken for different.
    """
    scene = observed
    for members in _sets(observed):
        shapes = plausible_shapes(members, alike)
        shape_id = shapes[min(rank, len(shapes) - 1)]
        for item in members:
            if item.shape_id != shape_id:
                scene = _swap(scene, item, shape_id, members)
    return _equally_large(scene) if rank else scene


def arrangement_count(observed: Scene, alike: Alike | None = None) -> int:
    """How many arrangements differ: the most shapes that any set may plausibly have."""
    return max((len(plausible_shapes(members, alike)) for members in _sets(observed)), default=1)


def plausible_shapes(
    members: Sequence[SceneObject], alike: Alike | None = None, *, chosen_id: str | None = None
) -> tuple[str, ...]:
    """The shape that a set has, then those that its members together find likely, best first, each of another form.

    Objects that are not painted in a colour of the photo keep their shapes' own, which differ. Where nothing tells
    shapes of one form (`alike`), all shapes are taken for different.

    Args:
        members: The objects of the set.
        alike: Tells shapes of one form; None takes all shapes for different.
        chosen_id: What comes first; the first member's shape by default.
    """
    chosen_id = members[0].shape_id if chosen_id is None else chosen_id
    totals: dict[str, float] = {}
    for item in members:
        best = max((c.score for c in item.candidates), default=0.0)
        for candidate in {c.shape_id: c for c in item.candidates}.values():
            share = candidate.score / best if best > 0 else 0.0
            totals[candidate.shape_id] = totals.get(candidate.shape_id, 0.0) + share / len(members)
    others = sorted((s for s in totals if s != chosen_id), key=lambda s: (-totals[s], s))
    likely = [s for s in others if totals[s] >= MIN_PLAUSIBLE]
    if alike is None or any(item.colour is None for item in members):
        return (chosen_id, *likely)
    shape_ids = [chosen_id]
    for shape_id in likely:
        if all(alike(shape_id, k) < SAME_FORM for k in shape_ids):
            shape_ids.append(shape_id)
    return tuple(shape_ids)


def _sets(scene: Scene) -> list[list[SceneObject]]:
    """Unlocked objects grouped by category and shape."""
    sets: dict[tuple[str, str], list[SceneObject]] = {}
    for item in scene.objects:
        if not item.locked and item.candidates:
            sets.setdefault((item.category, item.shape_id), []).append(item)
    return list(sets.values())


def _swap(scene: Scene, item: SceneObject, shape_id: str, members: Sequence[SceneObject]) -> Scene:
    """The object with another shape: in that candidate's fitted pose, or at its own place without one."""
    candidate = _candidate(item, shape_id)
    if candidate is not None:
        return edits.swap(scene, item.id, candidate)
    lent = next(c for c in (_candidate(m, shape_id) for m in members) if c is not None)
    return edits.swap(scene, item.id, lent, keep_pose=True)


def _candidate(item: SceneObject, shape_id: str) -> Candidate | None:
    return next((c for c in item.candidates if c.shape_id == shape_id and np.isfinite(c.pose.matrix).all()), None)


def _equally_large(scene: Scene) -> Scene:
    """One scale for the objects of a set where their sizes agree; each keeps its base, what is mounted its middle."""
    from diorama_core.pose.sets import equalise_scales  # Open3D and OpenCV; the editor opens without them

    free = [o for o in scene.objects if not o.locked]
    if not free:
        return scene
    scales = equalise_scales(
        [o.category for o in free],
        [o.shape_id for o in free],
        np.array([o.pose.scale for o in free]),
        [o.confidence for o in free],
    )
    sized = {o.id: _scale(scene, o, scale) for o, scale in zip(free, scales, strict=True)}
    return replace(scene, objects=tuple(sized.get(o.id, o) for o in scene.objects))


def _scale(scene: Scene, item: SceneObject, scale: np.ndarray) -> SceneObject:
    edge = scene.support_of(item.id)
    position = item.pose.position
    if edge is None or edge.relation == "placed on":
        rise = 0.5 * item.shape_size_m[2] * (scale[2] - item.pose.scale[2])
        position = position + rise * item.pose.R_world_object[:, 2]
    return replace(item, pose=Pose(item.pose.R_world_object, position, scale))
