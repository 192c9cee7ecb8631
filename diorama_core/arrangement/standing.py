"""Which walls an object on the floor stands against: a logistic regression on its gap, its front and its kind."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from diorama_core.arrangement.noise import ObservationNoise
from diorama_core.library.taxonomy import AGAINST_WALLS
from diorama_core.scene.types import Plane, Scene, SceneObject

LEAST_ODDS = float(np.log(0.7 / 0.3))
"""An object is set against a wall where that is so likely: a wrong wall takes it away from where it was seen."""
ASLANT_COSINE = 0.95
"""A face that is turned farther from a wall does not stand against it: only an edge would touch."""
MAX_TOLERANCES = 6.0
"""What was seen farther from a wall than so many tolerances, on either side, does not stand against it."""


@dataclass(frozen=True)
class WallRelation:
    """How an object stands to a wall."""

    gap: float
    """From the wall, in tolerances of the observation; negative behind it."""
    parallel: float
    """Largest cosine between the wall's normal and an axis of the object."""
    fronted: float
    """Cosine between the object's front and the wall's normal."""
    backed_kind: bool
    """Whether things of its kind have their backs at walls."""


STANDING_TERMS: Mapping[str, Callable[[WallRelation], float]] = {
    "always": lambda r: 1.0,
    "within tolerance": lambda r: min(abs(r.gap), 1.0),
    "beyond tolerance": lambda r: max(abs(r.gap) - 1.0, 0.0),
    "behind": lambda r: float(r.gap < -1.0),
    "aslant": lambda r: min((1.0 - r.parallel) / (1.0 - ASLANT_COSINE), 1.0),
    "fronted": lambda r: r.fronted,
    "backed kind": lambda r: float(r.backed_kind),
    "backed kind fronted": lambda r: float(r.backed_kind) * r.fronted,
}
"""By name a term of the log odds of standing against a wall."""


def wall_relation(scene: Scene, item: SceneObject, wall: Plane, noise: ObservationNoise) -> WallRelation | None:
    """How an object stands to a wall; None where it is beside it, far away or aslant.

    Args:
        scene: whose camera tells how sure positions are.
        item: the object, posed in the world.
        wall: a vertical plane of the room.
        noise: of positions along and across the line of sight.
    """
    along = np.cross([0.0, 0.0, 1.0], wall.normal)
    ends, place = wall.polygon @ along, float(item.pose.position @ along)
    if not ends.min() <= place <= ends.max():
        return None
    gap_m = float((item.corners_world @ wall.normal).min()) - wall.offset
    gap = gap_m / noise.tolerance_m(scene.camera, item.pose.position, wall.normal)
    parallel = float(np.abs(wall.normal @ item.pose.R_world_object).max())
    if abs(gap) > MAX_TOLERANCES or parallel < ASLANT_COSINE:
        return None
    return WallRelation(
        gap,
        parallel,
        float(wall.normal @ item.pose.R_world_object[:, 0]),
        item.category in AGAINST_WALLS,
    )


def standing_walls(
    scene: Scene, item: SceneObject, noise: ObservationNoise, weights: Mapping[str, Mapping[str, float]]
) -> tuple[str, ...]:
    """Walls that an object surely enough stands against, the likeliest first, at most one in each direction.

    Args:
        scene: with the walls.
        item: what stands on its floor.
        noise: of its observed pose.
        weights: by "measured" and "reasoned" those of `STANDING_TERMS`.
    """
    fitted = weights["measured" if noise.measured else "reasoned"]
    odds: list[tuple[float, str]] = []
    for wall in scene.architecture.by_role("wall"):
        relation = wall_relation(scene, item, wall, noise)
        if relation is not None:
            odds.append((sum(fitted[name] * term(relation) for name, term in STANDING_TERMS.items()), wall.id))
    walls: list[str] = []
    for value, name in sorted(odds, key=lambda pair: (-pair[0], pair[1])):
        normal = scene.plane(name).normal
        if value > LEAST_ODDS and all(
            abs(float(normal @ scene.plane(other).normal)) < ASLANT_COSINE for other in walls
        ):
            walls.append(name)
    return tuple(walls)
