"""Depth in pictures of three channels: one number in all of them, or its bytes spread over them."""

from __future__ import annotations

from itertools import permutations

import numpy as np
from jaxtyping import Bool, Integer, Shaped, UInt8

MIN_STEPS = 200
"""Pixels at which the lower byte starts anew, from which on they tell."""
SMOOTH = 96
"""Share of 256 by which the second difference is off zero at most where a lower byte starts anew."""
MIN_SMOOTH = 0.6
"""Share of such pixels: where two channels are no bytes of one number there are next to none."""


def depth_of_colours(colours: Shaped[np.ndarray, "h w 3"]) -> tuple[Shaped[np.ndarray, "h w"], tuple[str, ...]] | None:
    """The numbers of red, green and blue as one, and a note where they were packed; None where they are colours."""
    if (colours == colours[..., :1]).all():
        return colours[..., 0], ()
    return _unpacked(colours) if colours.dtype == np.uint8 else None


def _unpacked(colours: UInt8[np.ndarray, "h w 3"]) -> tuple[Integer[np.ndarray, "h w"], tuple[str, ...]] | None:
    """Two or three channels as the bytes of one number."""
    for high, low in permutations(range(3), 2):
        if not _counts(colours[..., high], colours[..., low]):
            continue
        third = 3 - high - low
        values = colours[..., high].astype(np.int64) * 256 + colours[..., low]
        names, spare = [high, low], colours[..., third]
        if spare.min() != spare.max():
            if not _counts(spare, colours[..., high], least=MIN_STEPS // 10):
                continue
            values, names = values + spare.astype(np.int64) * 65536, [third, *names]
        words = ", ".join(["red", "green", "blue"][k] for k in names)
        return values, (f"the depth is packed in the bytes of the colours; it was read from {words}, highest first",)
    return None


def _counts(high: UInt8[np.ndarray, "h w"], low: UInt8[np.ndarray, "h w"], least: int = MIN_STEPS) -> bool:
    """Whether one channel counts how often the other one starts anew: only so is the number smooth where that jumps."""
    bends = [np.diff(channel.astype(np.int32), n=2, axis=1) for channel in (high, low)]
    jumps: Bool[np.ndarray, "h w"] = np.abs(bends[1]) > 128
    whole = np.abs(256 * bends[0] + bends[1])[jumps]
    return bool(whole.size >= least and (whole < SMOOTH).mean() > MIN_SMOOTH)
