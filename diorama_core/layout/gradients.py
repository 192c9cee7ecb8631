"""The costs of `layout.costs` with gradients by hand, in numpy: an optimiser's inner loop at a tenth of the overhead.

At a room's size a step of the published optimiser is all call overhead; through autograd it takes hundreds of calls, so
each function here returns its value and its gradient in a handful. Tests compare both with autograd.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.geometry.vectors import cross

EPSILON = 1e-9
"""Smooths the norms where they vanish; metres or radians."""

Array = np.ndarray


def _unit(v: Float[Array, "*b d"]) -> tuple[float, Float[Array, "*b d"]]:
    """Sum of smoothed norms, and its gradient."""
    length = np.sqrt(np.einsum("...d,...d->...", v, v) + EPSILON**2)
    return float(length.sum() - EPSILON * length.size), v / length[..., None]


def align(contact_in: Float[Array, "e 3"], support: Float[Array, "e 3"]) -> tuple[float, Float[Array, "e 3"]]:
    """`costs.e_align`; the gradient is with respect to `contact_in` (negated, to `support`)."""
    return _unit(contact_in - support)


def semantic(front: Float[Array, "n 3"], front_observed: Float[Array, "n 3"]) -> tuple[float, Float[Array, "n 3"]]:
    """`costs.e_sem`; the gradient is with respect to `front`."""
    difference = front - front_observed
    difference[:, 2] = 0.0
    return _unit(difference)


def place(
    centre: Float[Array, "e 3"], point: Float[Array, "e 3"], normal: Float[Array, "e 3"]
) -> tuple[float, Float[Array, "e 3"]]:
    """`costs.e_place`; the gradient is with respect to `centre` (negated, to `point`)."""
    distance = np.einsum("ec,ec->e", centre - point, normal)
    weight = np.abs(normal).sum(axis=1)
    return float(np.abs(distance) @ weight), (np.sign(distance) * weight)[:, None] * normal


def relative(
    moved: Float[Array, "n 3"], pairs: Int[Array, "m 2"], incidence: Float[Array, "n m"]
) -> tuple[float, Float[Array, "n 3"]]:
    """`costs.e_rel`, of the moves so far; the gradient is with respect to the positions."""
    value, unit = _unit(moved[pairs[:, 0]] - moved[pairs[:, 1]])
    return value, incidence @ unit


def volume(
    corners: Float[Array, "e 4 3"],
    top: Float[Array, " e"],
    outward: Float[Array, "e k 3"],
    offset: Float[Array, "e k"],
    clearance: Float[Array, " e"],
) -> tuple[float, Float[Array, "e 4 3"], Float[Array, " e"]]:
    """`costs.e_vol`; gradients with respect to the corners and the tops.

    Args:
        corners: of the contact face.
        top: height above the surface.
        outward: normals of the volume's sides.
        offset: of the sides.
        clearance: above the surface.
    """
    past = np.matmul(corners, outward.transpose(0, 2, 1)) - offset[:, None, :]
    over = top - clearance
    value = float(np.maximum(past, 0.0).sum() + np.maximum(over, 0.0).sum())
    return value, np.matmul((past > 0).astype(np.float64), outward), (over > 0).astype(np.float64)


@dataclass(frozen=True, eq=False)
class BoxPairs:
    """The fifteen axes of box pairs and how far the boxes reach along them: fixed while nothing turns."""

    i: Int[Array, " m"]
    j: Int[Array, " m"]
    axes: Float[Array, "m 15 3"]
    reach: Float[Array, "m 15"]
    """Sum of both half extents; inf where an axis vanishes."""
    weight: Float[Array, "m 6"]
    """How much the overlap along each of the two boxes' own axes counts."""

    @classmethod
    def of(
        cls, R: Float[Array, "n 3 3"], size: Float[Array, "n 3"], pairs: Int[Array, "m 2"], *, walls_from: int
    ) -> BoxPairs:
        """Axes of the given pairs (first index smaller).

        Boxes from index `walls_from` on are walls with their normal as first axis: only the overlap along it counts,
        or a wall would also push objects along itself.

        Args:
            R: rotations of the boxes.
            size: their extents.
            pairs: of indices, the smaller first.
            walls_from: index of the first wall.
        """
        i, j = pairs[:, 0], pairs[:, 1]
        a, b = R[i].transpose(0, 2, 1), R[j].transpose(0, 2, 1)
        product = cross(a[:, :, None, :], b[:, None, :, :]).reshape(len(i), 9, 3)
        square = np.einsum("mac,mac->ma", product, product)[..., None]
        product = np.where(square > 1e-12, product / np.sqrt(np.maximum(square, 1e-12)), 0.0)
        axes = np.concatenate([a, b, product], axis=1)
        reach = sum(0.5 * np.einsum("mak,mk->ma", np.abs(np.matmul(axes, R[k])), size[k]) for k in (i, j))
        used = np.einsum("mac,mac->ma", axes, axes) > 0.25
        weight = np.where((j >= walls_from)[:, None], np.eye(6)[3], 0.5)
        return cls(i, j, axes, np.where(used, reach, np.inf), weight)

    def collision(self, p: Float[Array, "n 3"], incidence: Float[Array, "n m"]) -> tuple[float, Float[Array, "n 3"]]:
        """`costs.e_col`; the gradient is with respect to the positions."""
        along = np.matmul(self.axes, (p[self.i] - p[self.j])[..., None])[..., 0]
        depth = self.reach - np.abs(along)
        hit = depth.min(axis=1) > 0
        if not hit.any():
            return 0.0, np.zeros_like(p)
        weight = self.weight[hit]
        slope = -np.matmul((np.sign(along[hit, :6]) * weight)[:, None], self.axes[hit, :6])[:, 0]
        return float((depth[hit, :6] * weight).sum()), incidence[:, hit] @ slope


def incidence(pairs: Int[Array, "m 2"], count: int) -> Float[Array, "n m"]:
    """+1 at a pair's first index, -1 at its second: scatters pair gradients to objects."""
    matrix = np.zeros((count, len(pairs)))
    matrix[pairs[:, 0], np.arange(len(pairs))] += 1.0
    matrix[pairs[:, 1], np.arange(len(pairs))] -= 1.0
    return matrix


def candidate_pairs(
    R: Float[Array, "n 3 3"], p: Float[Array, "n 3"], size: Float[Array, "n 3"], apart: Bool[Array, "n n"], gap_m: float
) -> Int[Array, "m 2"]:
    """Pairs of boxes that may collide (`apart`) and whose bounds are nearer than `gap_m`.

    Args:
        R: rotations, world from object.
        p: centres, world, metres.
        size: extents along the axes of each box.
        apart: which pairs may collide.
        gap_m: distance of bounds.
    """
    half = 0.5 * np.einsum("nck,nk->nc", np.abs(R), size)
    low, high = p - half - gap_m / 2, p + half + gap_m / 2
    near = (low[:, None] <= high[None]).all(axis=2)
    near &= near.T
    near &= apart
    i, j = np.nonzero(np.triu(near, 1))
    return np.column_stack([i, j])
