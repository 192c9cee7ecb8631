"""What is known of the objects of a room before it is decided which way each of them faces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from diorama_core.scene.values import ArrayValue

HEADINGS = 24
"""Headings that are told apart, evenly spread from the object's own box on: steps of 15 degrees, those of poses."""
STEP_RAD = 2 * np.pi / HEADINGS
UNSEEN = -30.0
"""Log-likelihood of a heading that no pose was tried at."""


@dataclass(frozen=True, eq=False)
class WallSamples(ArrayValue):
    """Points of upright surfaces that belong to no object, with their headings, seen from above."""

    points_xy: Float[np.ndarray, "n 2"]
    normals_xy: Float[np.ndarray, "n 2"]


@dataclass(frozen=True, eq=False)
class FacingObject(ArrayValue):
    """One object whose heading is asked."""

    object_id: str
    kind: str
    centre: Float[np.ndarray, "3"]
    size_m: Float[np.ndarray, "3"]
    """Depth, width and height of its upright box."""
    yaw_rad: float
    """Heading of the box's depth, about up; its first heading."""
    picture: Float[np.ndarray, "24"]
    """What the picture says of every heading: log-likelihoods, 0 for the best; all 0 where nothing was posed."""
    carrier: int | None = None
    """Index of the object that it lies on."""
    out_of_wall: Float[np.ndarray, "2"] | None = None
    """Unit direction into the room, of an object that hangs on a wall."""
    front_known: bool = False
    """Whether the box's depth is known to point to the front."""

    @cached_property
    def directions(self) -> Float[np.ndarray, "24 2"]:
        """Unit directions of its headings, seen from above."""
        angles = self.yaw_rad + STEP_RAD * np.arange(HEADINGS)
        return np.stack([np.cos(angles), np.sin(angles)], axis=1)

    @cached_property
    def axes(self) -> Float[np.ndarray, "4 2"]:
        """Unit directions of the faces of its box: front, left, back, right."""
        return self.directions[:: HEADINGS // 4]

    def reach_m(self, direction: Float[np.ndarray, "2"]) -> float:
        """How far its box reaches from the centre in a direction."""
        return float(0.5 * np.abs(self.axes[:2] @ direction) @ self.size_m[:2])


@dataclass(frozen=True, eq=False)
class FacingRoom(ArrayValue):
    """All objects of a photo, where they stand, and what is around them."""

    objects: tuple[FacingObject, ...]
    camera_xy: Float[np.ndarray, "2"]
    walls: WallSamples

    def camera_direction(self, i: int) -> Float[np.ndarray, "2"]:
        """Unit direction from an object to the camera, seen from above."""
        return unit(self.camera_xy - self.objects[i].centre[:2])

    def gap_m(self, i: int, j: int) -> float:
        """Horizontal distance between two boxes' bounding rectangles along the world's axes."""
        (low_i, high_i), (low_j, high_j) = (_bounds(self.objects[k]) for k in (i, j))
        return float(np.linalg.norm(np.clip(np.maximum(low_i, low_j) - np.minimum(high_i, high_j), 0.0, None)))

    def nearest(self, i: int, kinds: frozenset[str], reach_m: float) -> int | None:
        """The nearest other object of some kinds within reach of an object.

        Args:
            i: index of the object.
            kinds: categories that count.
            reach_m: largest gap between the two, in the plan (m).
        """
        candidates = [
            (self.gap_m(i, j), float(np.linalg.norm(o.centre - self.objects[i].centre)), j)
            for j, o in enumerate(self.objects)
            if j != i and o.kind in kinds
        ]
        best = min(candidates, default=None)
        return best[2] if best is not None and best[0] < reach_m else None

    def loads(self, i: int, kinds: frozenset[str]) -> list[int]:
        """Objects of some kinds that lie on an object."""
        return [j for j, o in enumerate(self.objects) if o.carrier == i and o.kind in kinds]


def yaws_of(R_world_object: Float[np.ndarray, "*n 3 3"]) -> Float[np.ndarray, "*n"]:
    """Directions of fronts seen from above, from +X on."""
    return np.asarray(np.arctan2(R_world_object[..., 1, 0], R_world_object[..., 0, 0]))


def unit(v: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    """The direction of a vector seen from above; toward the camera (-y) for one without length."""
    length = float(np.linalg.norm(v))
    return v / length if length > 1e-9 else np.array([0.0, -1.0])


def _bounds(item: FacingObject) -> tuple[Float[np.ndarray, "2"], Float[np.ndarray, "2"]]:
    half = 0.5 * np.abs(item.axes[:2].T) @ item.size_m[:2]
    return item.centre[:2] - half, item.centre[:2] + half


@dataclass(frozen=True, eq=False)
class HeadingCosts(ArrayValue):
    """What speaks against headings of one object besides its own picture; 0 for the best."""

    yaw_rad: float
    """The first heading."""
    costs: Float[np.ndarray, "24"]

    def cost(self, R_world_object: Float[np.ndarray, "p 3 3"]) -> Float[np.ndarray, "p"]:
        """Costs of rotations by where their fronts point, between headings in proportion."""
        at = np.mod((yaws_of(R_world_object) - self.yaw_rad) / STEP_RAD, HEADINGS)
        return np.interp(at, np.arange(HEADINGS + 1), np.append(self.costs, self.costs[0]))


NO_COSTS = HeadingCosts(0.0, np.zeros(HEADINGS))
"""Costs of what may face anywhere."""


def picture_of(
    R_world_object: Float[np.ndarray, "3 3"],
    poses: Sequence[Float[np.ndarray, "_ 3 3"]],
    scores: Sequence[Float[np.ndarray, "_"]],
    folds: Sequence[int],
) -> Float[np.ndarray, "24"]:
    """Log-likelihood of every heading of one object: the best of all poses of all shapes that were tried near it.

    Args:
        R_world_object: Of its box.
        poses: By shape the rotations of its poses.
        scores: By shape their log-likelihoods, comparable between shapes.
        folds: By shape how many headings look the same.
    """
    log_likelihood = np.full(HEADINGS, -np.inf)
    for R, score, fold in zip(poses, scores, folds, strict=True):
        turns = np.arange(min(fold, HEADINGS)) * 2 * np.pi / min(fold, HEADINGS)
        off = (yaws_of(R) - yaws_of(R_world_object))[:, None] + turns
        index = np.rint(off / STEP_RAD).astype(int) % HEADINGS
        np.maximum.at(log_likelihood, index, np.broadcast_to(score[:, None], index.shape))
    if not np.isfinite(log_likelihood).any():
        return np.zeros(HEADINGS)
    return np.maximum(log_likelihood - log_likelihood.max(), UNSEEN)
