"""Numbers of a depth map that mean that nothing was measured."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Shaped

SKY_M = 1e4
"""What renderers write where there is nothing (Blender 1e10, half floats 65504) is beyond this."""
MIN_VOID_SHARE = 0.003
"""Share of a map's pixels from which one repeated number stands for missing depth."""
GAP = 1.25
"""By which such a number is beyond what nearly all other pixels measured."""
REPEATED = 8.0
"""Times a number must be more frequent than the next most frequent one."""
_SENTINELS = (65535.0, 65534.0, 65504.0, 65500.0, 32767.0, 32001.0, 9999.0, 10000.0, 99999.0, 1e5, 999.0, 4294967295.0)
MIN_DIFFERENT = 20
"""Numbers that a map has beside such a one: of a few steps each may be a surface."""
NOTED_SHARE = 0.01

SURE_LEVEL, SURE_GREY = 1, 100
"""Least confidence of a pixel, where it is a level (0 to 2, ARKit's) and where it is a grey value (0 to 255)."""
MIN_SURE = 0.05
"""Share of the measured pixels that must be sure: fewer are no depth of a room."""


def find_measured_pixels(values: Shaped[np.ndarray, "h w"]) -> tuple[Bool[np.ndarray, "h w"], tuple[str, ...]]:
    """Where a map's numbers are measurements, and a note about numbers that mean the opposite.

    Zero, negative numbers, NaN, infinities and a renderer's sky never are. Beyond these, the ends of the integer type
    and any number that is repeated far beyond (or below) all others mean nothing.
    """
    is_float = values.dtype.kind == "f"
    with np.errstate(invalid="ignore"):
        seen = (values > 0) & (values < SKY_M) if is_float else values > 0
    notes = []
    ends = [] if is_float else [float(np.iinfo(values.dtype).max)]
    for _ in range(3):  # a map may mark several reasons: too near, too far, not matched
        void = _void_number(values, seen, ends)
        if void is None:
            break
        hit = seen & (values == void)
        seen &= ~hit
        share = float(hit.mean())
        if share >= NOTED_SHARE:
            notes.append(
                f"{share:.0%} of the depth has the number {void:g}, which means that nothing was measured there"
            )
    return seen, tuple(notes)


def _void_number(values: np.ndarray, seen: np.ndarray, ends: list[float]) -> float | None:
    """The largest or smallest number, where it means nothing."""
    known = values[seen]
    if known.size < 20:
        return None
    for extreme, larger in ((known.max(), True), (known.min(), False)):
        number = float(extreme)
        same = known == extreme
        share = float(np.count_nonzero(same)) / values.size
        if larger and number in ends:
            return number
        others = known[~same]
        if share < MIN_VOID_SHARE or others.size < 0.02 * values.size:
            continue
        if _is_apart(number, others, larger) and (number in _SENTINELS or _is_repeated(others, share * values.size)):
            return number
    return None


def _is_apart(number: float, others: np.ndarray, larger: bool) -> bool:
    """Whether nearly all other measurements are clearly nearer, or clearly farther."""
    near = float(np.percentile(others, 99.5 if larger else 0.5))
    return number > GAP * near if larger else number * GAP < near


def _is_repeated(others: np.ndarray, count: float) -> bool:
    """Whether one number is far more frequent than any other."""
    few = others if others.size < 200_000 else others[:: others.size // 100_000]
    counts = np.unique(few, return_counts=True)[1] * (others.size / few.size)
    return len(counts) >= MIN_DIFFERENT and (count > REPEATED * counts.max() or count > 0.02 * others.size)


def is_sure(confidence: Shaped[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """Where depth is sure, by levels or by grey values."""
    return np.asarray(confidence >= (SURE_LEVEL if confidence.max() <= 2 else SURE_GREY))


def only_sure(
    values: Shaped[np.ndarray, "h w"], confidence: Shaped[np.ndarray, "h w"], name: str
) -> tuple[Shaped[np.ndarray, "h w"], tuple[str, ...]]:
    """A map with 0 where its confidence, called `name`, is low, and what was done."""
    measured = values > 0
    unsure = measured & ~is_sure(confidence)
    share = float(unsure.sum() / max(int(measured.sum()), 1))
    if share > 1.0 - MIN_SURE:
        return values, (f"{name} calls {share:.0%} of the depth unsure; it was not used",)
    return np.where(unsure, 0, values), (f"{share:.0%} of the depth is unsure by {name}, and left out",)
