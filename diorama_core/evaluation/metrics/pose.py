"""Alignment of object poses: the paper's scene-aware alignment in both readings, and object-focus alignment.

Scene-aware alignment (paper, section 4) compares objects with one another, so that one wrong global scale or depth does
not count against everything: relative rotation and the direction of relative translation within 20 degrees, relative
size within 20 % in the mean over the three axes. "Counts when right against every other object" can be read strictly,
or as the mean over pairs; both are given, always under their names. Pairs are ordered: the size of a against b is
judged as well as that of b against a, so that nothing depends on the order of a list. Object-focus alignment (Scan2CAD:
20 cm, 20 degrees, 20 %) compares each object with its own truth. Rotations are compared up to the true shape's symmetry
about its up axis, unless `without_symmetry` is asked for. What is missing is wrong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.scene.types import yaw_rotation
from diorama_core.scene.values import ArrayValue

MAX_ANGLE_RAD = float(np.deg2rad(20.0))
MAX_RATIO = 0.2
MAX_DISTANCE_M = 0.2
READINGS = ("mean over pairs", "against every other object", "object-focus")
"""How "right" is counted."""


@dataclass(frozen=True, eq=False)
class Placed(ArrayValue):
    """Where an object is and how large: rotation, centre and extents, all predictions and truths in one frame."""

    R: Float[np.ndarray, "3 3"]
    centre: Float[np.ndarray, "3"]
    size_m: Float[np.ndarray, "3"]
    symmetry: int = 1
    """Turns about its up axis that leave the true shape looking the same."""


@dataclass(frozen=True)
class Alignment:
    """Shares of objects (or pairs) whose rotation, translation and scale are right, and all three."""

    reading: str
    """One of `READINGS`."""
    count: int
    """Objects that should have been placed."""
    r_acc: float
    t_acc: float
    s_acc: float
    acc: float

    @property
    def shares(self) -> tuple[float, float, float, float]:
        """Rotation, translation, scale, and all three."""
        return self.r_acc, self.t_acc, self.s_acc, self.acc


def nothing_right(count: int) -> tuple[Alignment, Alignment, Alignment]:
    """Every reading of a scene in which no object is right."""
    pairs, every, own = (Alignment(reading, count, 0.0, 0.0, 0.0, 0.0) for reading in READINGS)
    return pairs, every, own


@dataclass(frozen=True, eq=False)
class PairChecks(ArrayValue):
    """For every ordered pair of objects whether its relative pose is right; the diagonal is True.

    `scale[i, j]` is of i against j and may differ from `scale[j, i]`; the other two are symmetric.
    """

    rotation: Bool[np.ndarray, "n n"]
    translation: Bool[np.ndarray, "n n"]
    scale: Bool[np.ndarray, "n n"]

    @property
    def all_three(self) -> Bool[np.ndarray, "n n"]:
        """Pairs in which everything is right."""
        return self.rotation & self.translation & self.scale


def without_symmetry(truth: Sequence[Placed]) -> list[Placed]:
    """The objects with every heading counted: a round table turned by 30 degrees is wrong."""
    return [replace(t, symmetry=1) for t in truth]


def pair_checks(truth: Sequence[Placed], predicted: Sequence[Placed | None], *, every_axis: bool = False) -> PairChecks:
    """Compare all relative poses.

    Args:
        truth: every object of the scene.
        predicted: in the same order; None where an object is missing, and then all its pairs are wrong.
        every_axis: whether the relative size must be right along each axis, not only in the mean over the three.
    """
    n = len(truth)
    rotation, translation, scale = (np.eye(n, dtype=bool) for _ in range(3))
    for i in range(n):
        for j in range(i + 1, n):
            a, b = predicted[i], predicted[j]
            if a is None or b is None:
                continue
            rotation[i, j] = rotation[j, i] = _same_turn(truth[i], truth[j], a, b)
            translation[i, j] = translation[j, i] = _same_way(truth[i], truth[j], a, b)
            ratio = _size_ratio(truth[i], truth[j], a, b)
            scale[i, j], scale[j, i] = (_same_size(r, every_axis=every_axis) for r in (ratio, 1.0 / ratio))
    return PairChecks(rotation, translation, scale)


def scene_alignment(
    truth: Sequence[Placed], predicted: Sequence[Placed | None], *, every_axis: bool = False
) -> tuple[Alignment, Alignment]:
    """Both readings of the paper's scene-aware alignment: the mean over pairs, and against every other object.

    A scene of one object has no pairs: it is right when the object is there.
    """
    n = len(truth)
    if n < 2:
        shares = [float(n > 0 and all(p is not None for p in predicted))] * 4
        return Alignment(READINGS[0], n, *shares), Alignment(READINGS[1], n, *shares)
    checks = pair_checks(truth, predicted, every_axis=every_axis)
    grids = [checks.rotation, checks.translation, checks.scale, checks.all_three]
    off = ~np.eye(n, dtype=bool)
    pairs = [float(g[off].mean()) for g in grids]
    every = [float(g.all(axis=1).mean()) for g in grids]
    return Alignment(READINGS[0], n, *pairs), Alignment(READINGS[1], n, *every)


def object_alignment(truth: Sequence[Placed], predicted: Sequence[Placed | None]) -> Alignment:
    """Scan2CAD's alignment of each object with its own truth: 20 cm, 20 degrees, 20 %."""
    right = np.zeros((len(truth), 3), dtype=bool)
    for k, (true, placed) in enumerate(zip(truth, predicted, strict=True)):
        if placed is not None:
            angle, ratio = _own_errors(true, placed)
            distance = float(np.linalg.norm(placed.centre - true.centre))
            right[k] = angle <= MAX_ANGLE_RAD, distance <= MAX_DISTANCE_M, ratio <= MAX_RATIO
    shares = [float(column.mean()) if len(truth) else 0.0 for column in (*right.T, right.all(axis=1))]
    return Alignment(READINGS[2], len(truth), *shares)


def pool(alignments: Sequence[Alignment]) -> Alignment:
    """The mean over scenes, each counting by its objects."""
    weights, reading = np.array([a.count for a in alignments], dtype=float), next((a.reading for a in alignments), "")
    if weights.sum() == 0:
        return Alignment(reading, 0, 0.0, 0.0, 0.0, 0.0)
    shares = weights @ np.array([a.shares for a in alignments]) / weights.sum()
    return Alignment(reading, int(weights.sum()), *shares.tolist())


def rotation_angle(a: Float[np.ndarray, "*#n 3 3"], b: Float[np.ndarray, "*#n 3 3"]) -> Float[np.ndarray, "*_"]:
    """Geodesic angle between rotations, radians."""
    trace = np.einsum("...ij,...ij->...", a, b)
    return np.asarray(np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0)))


def symmetry_turns(fold: int) -> Float[np.ndarray, "k 3 3"]:
    """The turns about up that leave a shape of this symmetry looking the same."""
    return np.array([yaw_rotation(2 * np.pi * k / fold) for k in range(fold)])


def _same_turn(true_a: Placed, true_b: Placed, a: Placed, b: Placed) -> bool:
    relative = a.R.T @ b.R
    wanted = true_a.R.T @ true_b.R
    turned = np.einsum("aji,jk,bkl->abil", symmetry_turns(true_a.symmetry), relative, symmetry_turns(true_b.symmetry))
    return float(rotation_angle(turned, wanted).min()) <= MAX_ANGLE_RAD


def _same_way(true_a: Placed, true_b: Placed, a: Placed, b: Placed) -> bool:
    way, true_way = b.centre - a.centre, true_b.centre - true_a.centre
    lengths = float(np.linalg.norm(way) * np.linalg.norm(true_way))
    if lengths < 1e-12:
        return bool(np.linalg.norm(way - true_way) < 1e-6)
    return bool(np.arccos(np.clip(way @ true_way / lengths, -1.0, 1.0)) <= MAX_ANGLE_RAD)


def _size_ratio(true_a: Placed, true_b: Placed, a: Placed, b: Placed) -> Float[np.ndarray, "3"]:
    """The found relative extents of a against b over the true ones, along each axis."""
    return (_align_size(true_a, a) / _align_size(true_b, b)) / (true_a.size_m / true_b.size_m)


def _same_size(ratio: Float[np.ndarray, "3"], *, every_axis: bool) -> bool:
    off = np.abs(ratio - 1.0)
    return bool((off.max() if every_axis else off.mean()) <= MAX_RATIO)


def _own_errors(true: Placed, placed: Placed) -> tuple[float, float]:
    """Angle up to symmetry, and mean relative error of the extents."""
    turned = placed.R @ symmetry_turns(true.symmetry)
    angle = float(rotation_angle(turned, true.R).min())
    return angle, float(np.abs(_align_size(true, placed) / true.size_m - 1.0).mean())


def _align_size(true: Placed, placed: Placed) -> Float[np.ndarray, "3"]:
    """The found extents along the true object's axes: where symmetry allows a quarter turn, width may be depth."""
    if true.symmetry % 4:
        return placed.size_m
    turns = symmetry_turns(true.symmetry)
    best = turns[int(rotation_angle(placed.R @ turns, true.R).argmin())]
    swapped = abs(best[0, 1]) > abs(best[0, 0])
    return placed.size_m[[1, 0, 2]] if swapped else placed.size_m
