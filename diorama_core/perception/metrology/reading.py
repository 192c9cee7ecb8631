"""Reading a placement: which way the object faces, how sure its cuboid is, and what holds its place and size."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.explain import SCALE
from diorama_core.artefacts import Decision, DetectedObject, Reason
from diorama_core.library.taxonomy import UNKNOWN, Category
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.placement import CEILING, FLOOR, WALL, Placement
from diorama_core.perception.metrology.problem import UNKNOWNS, View, concatenate_problems, values
from diorama_core.perception.metrology.settings import SETTINGS, CuboidFitSettings, HeightScanSettings


def heading_and_size(
    placement: Placement, category: Category, settings: HeightScanSettings = SETTINGS.heights
) -> tuple[float, Float[np.ndarray, "3"]]:
    """Heading of the front and extents (depth, width, height).

    The front faces the camera as far as the axes allow; where width and depth look alike in the category, it may be
    any of the four sides.
    """
    box = placement.cuboid
    yaw, size = float(box.yaw_rad[0]), box.size_m[0]
    if placement.supporter == WALL:
        return yaw, size
    prior = category.priors[0].log_median_xyz
    free = category is UNKNOWN or abs(prior[0] - prior[1]) < settings.square
    turns = (0.0, np.pi / 2, np.pi, -np.pi / 2) if free else (0.0, np.pi)
    to_camera = -box.centre[0, :2]
    facing = [np.cos(yaw + turn) * to_camera[0] + np.sin(yaw + turn) * to_camera[1] for turn in turns]
    best = int(np.argmax(facing))
    if turns[best] in (np.pi / 2, -np.pi / 2):
        size = size[[1, 0, 2]]
    turned = yaw + turns[best]
    return float(np.arctan2(np.sin(turned), np.cos(turned))), size


def foot_seen(placement: Placement, observations: BoxObservations) -> bool:
    """Whether the lower end of an object is seen, as far as it tells how far away the object is: on the floor."""
    index, doubtful = placement.index, observations.settings.heights.may_be_hidden
    hidden = observations.truncated[index][3] or observations.hidden_odds(index)[3] > doubtful
    return placement.supporter != FLOOR or not hidden


def confidence_of(placement: Placement, observations: BoxObservations, height_log_sigma: float) -> float:
    """Between 0 and 1: low for implausible sizes, bad fits, hidden or cut boxes, and an unsure camera height."""
    index, settings = placement.index, observations.settings.heights
    parent = placement.supporter if placement.supporter >= 0 else None
    unseen = int((observations.is_hidden(index, parent) | observations.truncated[index]).sum())
    fit = np.exp(-placement.cost / settings.cost_scale)
    return float(np.clip(fit * settings.hidden_factor**unseen * np.exp(-height_log_sigma), 0.02, 1.0))


HUNG: Mapping[int, str] = {WALL: "hangs on walls", CEILING: "hangs from ceilings"}
FORWARD, SIZE = slice(1, 2), slice(2, 5)
"""Columns of the unknowns: the logarithms of the distance and of the extents."""
TERMS: Mapping[str, tuple[slice, str, str]] = {
    "outline": (slice(0, 3), "it looks as large in the photo as it would there", "it looks that large in the photo"),
    "foot": (slice(3, 4), "the photo shows its foot there", "the photo shows its foot there"),
    "cut off": (slice(4, 6), "the photo cuts off no more of it", "the photo cuts off no more of it"),
    "usual size": (slice(6, 9), "its kind is usually as large as that", "its kind is usually that large"),
    "base": (slice(9, 10), "its base is as high as what holds it", "its base is as high as what holds it"),
    "top": (slice(10, 11), "its top is as high as usual", "its top is as high as usual"),
    "on it": (slice(11, 13), "there it is on what holds it", "it fits on what holds it"),
    "wall": (slice(13, 14), "there its back is at the wall", "its back is at the wall"),
    "depth": (slice(15, 16), "a depth network sees it there", "a depth network sees it there"),
}
"""By term its residuals (`problem.values`), and why it holds the place and the size."""


def reasons_of(
    placements: Sequence[Placement], view: View, objects: Sequence[DetectedObject], settings: CuboidFitSettings
) -> tuple[Reason, ...]:
    """By how many nats each term opposes that an object is a tenth farther or nearer, larger or smaller.

    Args:
        placements: of the objects.
        view: intrinsics, and rotation from camera to world.
        objects: by the indices of the placements.
        settings: of the fit.
    """
    if not placements:
        return ()
    problems = concatenate_problems([p.problem for p in placements])
    found = np.stack([_unknowns(p, view) for p in placements])

    def nats(unknowns: Float[np.ndarray, "n 6"]) -> Float[np.ndarray, "n r"]:
        return 0.5 * values(unknowns, problems, view, settings=settings).residuals ** 2

    here = nats(found)
    reasons: list[Reason] = []
    changes: tuple[tuple[Decision, slice], ...] = (("place", FORWARD), ("size", SIZE))
    for column, (decision, changed) in enumerate(changes):
        step = np.zeros(UNKNOWNS)
        step[changed] = SCALE.change
        costs = 0.5 * (nats(found + step) + nats(found - step)) - here
        for placement, of_terms in zip(placements, costs, strict=True):
            object_id = objects[placement.index].id
            for term, (of_term, *sentences) in TERMS.items():
                cost = float(of_terms[of_term].sum())
                if abs(cost) >= SCALE.least_nats:
                    reasons.append(Reason(object_id, decision, term, cost, "nats", sentences[column]))
    return (*reasons, *(_support_reason(p, objects) for p in placements))


def _support_reason(placement: Placement, objects: Sequence[DetectedObject]) -> Reason:
    """Evidence that an object's foot is seen where it stands, or that its kind hangs where it does."""
    object_id, supporter = objects[placement.index].id, placement.supporter
    if supporter in HUNG:
        return Reason(object_id, "support", "kind", SCALE.hung_nats, "nats", f"its kind {HUNG[supporter]}")
    on = "the floor" if supporter == FLOOR else f"the {objects[supporter].label}"
    odds = float(np.clip(placement.problem.hidden_odds[0, 3], SCALE.rare, 1.0 / SCALE.rare))
    seen = "is seen" if odds < 1.0 else "is hidden, and taken to be"
    return Reason(object_id, "support", "foot", -float(np.log(odds)), "nats", f"its foot {seen} on {on}")


def _unknowns(placement: Placement, view: View) -> Float[np.ndarray, "6"]:
    """The solver's unknowns of a cuboid that was placed."""
    box, problem = placement.cuboid, placement.problem
    ahead, right = view.heading, np.array([view.heading[1], -view.heading[0]])
    plan, size_m = box.centre[0, :2], box.size_m[0]
    forward = max(float(plan @ ahead), 1e-3)
    sigma = float(problem.base_sigma_m[0])
    base = 0.0 if sigma == 0 else (float(box.base_m[0]) - float(problem.base_m[0])) / sigma
    return np.array([float(plan @ right) / forward, np.log(forward), *np.log(np.maximum(size_m, 1e-3)), base])
