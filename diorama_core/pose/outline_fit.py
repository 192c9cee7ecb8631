"""The last few percent of a pose: sides, place and turn moved in small steps until outline and depth agree best.

Shapes are compared as wholes before they are made to measure; what fits them best may not be what fits the shape that
was chosen in the end. Each side of the box is tried a little farther out or in with the opposite one in place, the base
stays where it is, and every step is the best of all, as long as one agrees better.

How large it is was found with more than its outline (what its kind measures, where it stands, what it carries). So its
size changes only as far as the agreement pays for it, and hardly where it is cut or hidden: an outline that ends at the
photo's border does not show where the thing ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.observed import Observed
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.settings import SETTINGS, ShapeFitSettings
from diorama_core.scene.types import Pose, yaw_rotation


@dataclass(frozen=True, eq=False)
class FitRange:
    """How far a fit may go."""

    scale: Float[np.ndarray, "3"] | None = None
    """The size from before any fit, from which it goes; None where the fit begins with it."""
    steps: tuple[float, ...] = (0.06, 0.03, 0.015)
    """Shares of an extent, and radians, from coarse to fine."""
    rounds: int = 5
    """Moves at each of them, as long as they help: sides, place and turn may all be a little off."""
    gain: float = 0.01
    """Least gain of the cost, a logarithm: less is no better."""
    noise_floor: float = SETTINGS.evidence.noise_floor


WIDE = FitRange()
COARSE = FitRange(steps=WIDE.steps[:2])
FINE = FitRange(steps=(0.015, 0.0075), rounds=3, gain=0.003, noise_floor=0.01)
"""A fit in two parts, the second with outlines of a finer resolution."""


_Move = tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, "3"], Float[np.ndarray, "3"]]
"""Rotation, place and scale of a pose near another one."""


def fit_pose(
    evidence: Evidence,
    caster: ShapeCaster,
    pose: Pose,
    shape_size_m: Float[np.ndarray, "3"],
    *,
    resize: bool,
    near: FitRange = WIDE,
    settings: ShapeFitSettings = SETTINGS.shapes,
) -> Pose:
    """The pose near one with which the shape agrees best.

    Args:
        evidence: Outline, and depth where it was measured.
        caster: The shape.
        pose: Where it is so far.
        shape_size_m: Its extents at scale 1.
        resize: Whether its size may change; one of a set keeps it. What is round from above stays round.
        near: How far it may go.
    """
    if evidence.surface is None and evidence.seen.mask_trust < settings.min_trust:
        return pose
    start = pose.scale if near.scale is None else near.scale
    cost: float | None = None
    for step in near.steps:
        for _ in range(near.rounds):
            moves = _neighbours(pose, np.asarray(shape_size_m), step, _resizings(resize, caster.round_from_above))
            if cost is None:  # compared along with its first neighbours: one comparison takes long by itself
                moves.append((pose.R_world_object, pose.position, pose.scale))
            costs = _costs(evidence, caster, moves, start, near.noise_floor, settings)
            cost = float(costs[-1]) if cost is None else cost
            best = int(np.argmin(costs))
            if costs[best] >= cost - near.gain:
                break
            cost, pose = float(costs[best]), Pose(*moves[best])
    return pose


def _costs(
    evidence: Evidence,
    caster: ShapeCaster,
    moves: Sequence[_Move],
    start: Float[np.ndarray, "3"],
    noise_floor: float,
    settings: ShapeFitSettings,
) -> Float[np.ndarray, "p"]:
    """Disagreement with the picture and distance from the size at the start, as logarithms."""
    poses = PoseBatch(*(np.array(part) for part in zip(*moves, strict=True)))
    agreement = np.log(evidence.errors(caster, poses) + noise_floor)
    return agreement + resizing_cost(evidence.seen, poses.scale / start, settings)


def resizing_cost(
    seen: Observed, factors: Float[np.ndarray, "p 3"], settings: ShapeFitSettings
) -> Float[np.ndarray, "p"]:
    """What speaks against extents that are so many times what they were, as a logarithm; nearly all where it is cut."""
    sigma = settings.resized_sigma * max(
        1.0 - settings.of_border * seen.border_share - seen.hidden_share, settings.min_seen
    )
    return np.asarray(0.5 * (np.log(factors) ** 2).sum(axis=1) / sigma**2)


def _resizings(resize: bool, round: bool) -> tuple[tuple[tuple[int, ...], int], ...]:
    """Axes that grow together, and the side of the first that stays: 0 for none, the middle stays."""
    if not resize:
        return ()
    if round:
        return (((0, 1), 0), ((2,), -1))
    return (((0,), 0), ((0,), 1), ((0,), -1), ((1,), 0), ((1,), 1), ((1,), -1), ((2,), -1))


def _neighbours(
    pose: Pose, shape_size_m: Float[np.ndarray, "3"], step: float, resizings: tuple[tuple[tuple[int, ...], int], ...]
) -> list[_Move]:
    R, moves = pose.R_world_object, list[_Move]()
    reach = 0.5 * step * float((shape_size_m * pose.scale).max())
    for sign in (1.0, -1.0):
        moves.append((R @ yaw_rotation(sign * step), pose.position, pose.scale))
        for axis in range(2):
            moves.append((R, pose.position + sign * reach * R[:, axis], pose.scale))
        for axes, fixed in resizings:
            scale, first = pose.scale.copy(), axes[0]
            scale[list(axes)] *= 1.0 + sign * step
            grown = 0.5 * (scale[first] - pose.scale[first]) * shape_size_m[first]
            moves.append((R, pose.position - fixed * grown * R[:, first], scale))
    return moves
