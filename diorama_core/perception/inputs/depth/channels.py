"""The one channel of an array that is depth: singleton axes dropped, the depth of a point map, and pictures of three
channels with one number in all of them or its bytes spread over them.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np
from jaxtyping import Bool, Integer, Shaped, UInt8

from diorama_core.errors import InputError

AGREEING = 0.9
"""Correlation between a ray's slope and where its pixel is, from which an array is taken for a point map."""


def one_channel(array: Shaped[np.ndarray, "..."], name: str) -> tuple[Shaped[np.ndarray, "h w"], tuple[str, ...]]:
    """The depth of an array, and a note where it was one of several channels.

    It is (h, w) with singleton axes, or a point map (h, w, 3) or (3, h, w).

    Raises:
        InputError: it has another shape, or channels of which none is depth.
    """
    squeezed = _squeeze(array)
    if squeezed.ndim == 2 and 0 not in squeezed.shape and min(squeezed.shape) > 1:
        return squeezed, ()
    if squeezed.ndim == 3 and squeezed.shape[0] in (3, 4) and squeezed.shape[2] > 4:
        squeezed = np.moveaxis(squeezed, 0, -1)
    if squeezed.ndim == 3 and squeezed.shape[2] in (3, 4) and min(squeezed.shape[:2]) > 4:
        depth = _depth_of_points(squeezed[..., :3].astype(np.float64))
        if depth is not None:
            values, words = depth
            return values.astype(np.float32), (f"the depth is a point map; its {words} is used",)
        if (squeezed[..., :3] == squeezed[..., :1]).all():
            return squeezed[..., 0], ()
    raise InputError(
        f"{name}: depth must be two-dimensional, this has shape {tuple(array.shape)}; save one channel, z in the camera"
    )


def _squeeze(array: np.ndarray) -> np.ndarray:
    axes = tuple(k for k, n in enumerate(array.shape) if n == 1)
    return np.squeeze(array, axis=axes) if array.ndim > 2 else array


def _depth_of_points(points: Shaped[np.ndarray, "h w 3"]) -> tuple[np.ndarray, str] | None:
    """The channel that is depth in the camera, with its sign; None where the points are not those of a photo."""
    height, width = points.shape[:2]
    rows, columns = np.mgrid[:height, :width]
    step = max(1, int(np.sqrt(height * width / 5000)))
    some = points[::step, ::step].reshape(-1, 3)
    u, v = columns[::step, ::step].ravel(), rows[::step, ::step].ravel()
    for channel, sign in ((2, 1.0), (2, -1.0), (0, 1.0), (1, 1.0)):
        z = sign * some[:, channel]
        across, down = (k for k in range(3) if k != channel)
        with np.errstate(all="ignore"):
            slopes = some[:, [across, down]] / z[:, None]
        known = np.isfinite(slopes).all(axis=1) & (z > 0)
        if known.sum() < 50 or np.median(z[known]) <= 0:
            continue
        related = [abs(_correlation(slopes[known, k], pixel[known])) for k, pixel in ((0, u), (1, v))]
        if min(related) > AGREEING:
            return sign * points[..., channel], f"{'XYZ'[channel]} channel"
    return None


def _correlation(one: np.ndarray, other: np.ndarray) -> float:
    low, high = np.percentile(one, [2, 98])
    inside = (one >= low) & (one <= high)
    a, b = one[inside] - one[inside].mean(), other[inside] - other[inside].mean()
    scale = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(a @ b) / scale if scale > 0 else 0.0


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
    return _unpack_colours(colours) if colours.dtype == np.uint8 else None


def _unpack_colours(colours: UInt8[np.ndarray, "h w 3"]) -> tuple[Integer[np.ndarray, "h w"], tuple[str, ...]] | None:
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
