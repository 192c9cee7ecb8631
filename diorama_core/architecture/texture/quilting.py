"""Continues the look of a surface where nobody saw it: image quilting (Efros and Freeman 2001) of its fine detail.

Broad shading and fine detail are told apart first. Shading spreads smoothly and calms down away from what was seen;
detail (boards, weave, panelling, plaster) is copied in blocks that match what is already there, outward from it.
"""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Bool, Float32

from diorama_core.io.cache import LruCache

BLOCKS_PX = ((96, 200, 384), (48, 24, 49), (32, 60, 33), (20, 400, 21))
"""Sizes of the copied squares, how many must have been seen, and least sides of the picture.

Copies of few small squares show as a weave; large ones hold patterns of carpets and tiles."""
LARGEST_BLOCK_PX = BLOCKS_PX[0][0]
BROADEST = 0.1
"""Detail broader than this share of a block is not copied."""
MIN_SOURCE = 0.005
"""A material seen on a smaller share of the surface is not continued."""
OVERLAP = 0.34
"""Share of a block that lies on what is already known."""
WEIGHTS_KEPT = 16
"""Blocks with equal weights need the same sums, which are needed again; most lie beside one another."""
SEARCH_STEP = 2
"""Matches are looked for at half resolution."""
TOLERANCE = 0.1
"""One of the places is drawn whose match is worse than the best by at most this share."""
ODD_SHARE = 0.3
"""Where more than this share of the texels around deviate too much, there is an object."""
REUSE_COST = 0.1
"""A place costs so much more for every time it was copied from."""


def detail_continued(
    detail: Float32[np.ndarray, "h w 3"],
    seen: Bool[np.ndarray, "h w"],
    strongest: float,
    seed: int = 0,
    source: Bool[np.ndarray, "h w"] | None = None,
) -> Float32[np.ndarray, "h w 3"] | None:
    """Detail everywhere: as seen, else copied from where it was seen; none where too little was seen to copy from.

    Args:
        detail: What is left of the colours without their broad shading, in levels of 255.
        seen: Where it is known and the surface's own.
        strongest: Detail beyond this many levels is an object and not the surface.
        seed: Of the draw among equally good places.
        source: The part of it to copy from, unless that is too little; all of it by default.
    """
    source = plain_texels(detail, seen, strongest, source)
    size = block_size(source)
    if size is None:
        return None
    given = detail
    # What is nearly as broad as a block shows as a weave when the block is copied side by side.
    detail = detail - broad_shading(detail, source, BROADEST * size)
    out = np.where(source[..., None], detail, 0.0).astype(np.float32)
    # What hides or decorates the surface stays in its own picture but is not continued.
    known = source.copy()
    finder = _Finder(detail, source, size, np.random.default_rng(seed))
    for row, column in _outward(source, size):
        window = (slice(row, row + size), slice(column, column + size))
        wanted = ~known[window]
        if not wanted.any():
            continue
        y, x = finder.best(out[window], known[window])
        block = detail[y : y + size, x : x + size]
        out[window] = np.where(
            wanted[..., None], block, _blend_blocks(out[window], block, known[window], source[window])
        )
        known[window] = True
    return np.asarray(np.where(seen[..., None], given, out), dtype=np.float32)


def plain_texels(
    detail: Float32[np.ndarray, "h w 3"],
    seen: Bool[np.ndarray, "h w"],
    strongest: float,
    preferred: Bool[np.ndarray, "h w"] | None = None,
) -> Bool[np.ndarray, "h w"]:
    """The texels that show the surface without anything on it: the preferred ones, unless those are too few to copy.

    Args:
        detail, seen, strongest: As for `detail_continued`.
        preferred: All by default.
    """
    plain = np.asarray(seen & ~_odd(detail, seen, strongest))
    best = plain if preferred is None else plain & preferred
    return plain if block_size(best) is None else best


def block_size(source: Bool[np.ndarray, "h w"]) -> int | None:
    """Side of the blocks to copy from a source; None where it is too little."""
    if source.mean() < MIN_SOURCE:
        return None
    return next(
        (b for b, enough, side in BLOCKS_PX if min(source.shape) >= side and _places(source, b).sum() >= enough), None
    )


def _odd(
    detail: Float32[np.ndarray, "h w 3"], seen: Bool[np.ndarray, "h w"], strongest: float
) -> Bool[np.ndarray, "h w"]:
    """Pictures, sockets, cables, and whatever else must not be copied, with a margin."""
    strength = np.abs(detail).max(axis=-1)
    odd = cv2.blur(((strength > strongest) & seen).astype(np.float32), (5, 5)) > ODD_SHARE
    return cv2.dilate(odd.astype(np.uint8), np.ones((9, 9), np.uint8)).astype(bool)


def _places(source: Bool[np.ndarray, "h w"], size: int) -> Bool[np.ndarray, "p q"]:
    """Top-left corners of blocks that hold nothing but source."""
    total = cv2.integral(source.astype(np.uint8))
    count = total[size:, size:] - total[:-size, size:] - total[size:, :-size] + total[:-size, :-size]
    return np.asarray(count == size * size)


def _outward(seen: Bool[np.ndarray, "h w"], size: int) -> list[tuple[int, int]]:
    """Corners of overlapping blocks that cover what was not seen, nearest to what was seen first."""
    height, width = seen.shape
    step = max(1, round(size * (1.0 - OVERLAP)))
    rows, columns = ([*range(0, n - size, step), n - size] for n in (height, width))
    distance = cv2.distanceTransform((~seen).astype(np.uint8), cv2.DIST_L2, 5)
    patches = [
        (float(distance[r : r + size, c : c + size].min()), float(distance[r : r + size, c : c + size].mean()), r, c)
        for r in rows
        for c in columns
        if not seen[r : r + size, c : c + size].all()
    ]
    return [(r, c) for _, _, r, c in sorted(patches)]


def _blend_blocks(
    old: Float32[np.ndarray, "b b 3"],
    new: Float32[np.ndarray, "b b 3"],
    known: Bool[np.ndarray, "b b"],
    seen: Bool[np.ndarray, "b b"],
) -> Float32[np.ndarray, "b b 3"]:
    """Known detail that turns into the new block's over a few texels; what was really seen stays."""
    framed = cv2.copyMakeBorder(known.astype(np.uint8), 1, 1, 1, 1, cv2.BORDER_REPLICATE)
    inward = cv2.distanceTransform(framed, cv2.DIST_L2, 3)[1:-1, 1:-1]
    keep = np.clip(inward / 5.0, 0.0, 1.0)
    keep[seen] = 1.0
    return np.asarray(keep[..., None] * old + (1.0 - keep[..., None]) * new, dtype=np.float32)


class _Finder:
    """Looks up where in the source a block fits best."""

    def __init__(
        self, detail: Float32[np.ndarray, "h w 3"], source: Bool[np.ndarray, "h w"], size: int, rng: np.random.Generator
    ) -> None:
        rows, columns = np.flatnonzero(source.any(axis=1)), np.flatnonzero(source.any(axis=0))
        self._top, self._left = int(rows[0]), int(columns[0])
        bottom, right = max(int(rows[-1]) + 1, self._top + size), max(int(columns[-1]) + 1, self._left + size)
        everywhere = _places(source[self._top : bottom, self._left : right], size)
        starts = [(row, column) for row in range(SEARCH_STEP) for column in range(SEARCH_STEP)]
        windows = [everywhere[row::SEARCH_STEP, column::SEARCH_STEP] for row, column in starts]
        most = int(np.argmax([places.sum() for places in windows]))
        self._places = windows[most]
        self._top, self._left = self._top + starts[most][0], self._left + starts[most][1]
        part = (slice(self._top, bottom), slice(self._left, right))
        grey = cv2.cvtColor(np.where(source[part][..., None], detail[part], 0.0).astype(np.float32), cv2.COLOR_RGB2GRAY)
        self._picture = grey[::SEARCH_STEP, ::SEARCH_STEP].copy()
        self._squares = self._picture**2
        self._square_by_weight: LruCache[bytes, np.ndarray] = LruCache(WEIGHTS_KEPT)
        self._rng = rng
        self._rows, self._columns = np.nonzero(self._places)
        self._uses = np.zeros(self._places.shape, np.float32)

    def best(self, block: Float32[np.ndarray, "b b 3"], known: Bool[np.ndarray, "b b"]) -> tuple[int, int]:
        """Top-left corner of a block of the source that continues what is known of a block."""
        rows, columns = self._rows, self._columns
        if known.any():
            grey = cv2.cvtColor(block, cv2.COLOR_RGB2GRAY)[::SEARCH_STEP, ::SEARCH_STEP]
            weight = known[::SEARCH_STEP, ::SEARCH_STEP].astype(np.float32)
            cross = cv2.matchTemplate(self._picture, grey * weight, cv2.TM_CCORR)
            square = self._square_of(weight)
            misfit = self._pad_to_grid(square - 2.0 * cross + float((weight * grey**2).sum()))
            costs = np.maximum(misfit[rows, columns], 0.0)
        else:
            costs = np.zeros(len(rows))
        costs = (costs + 1e-3) * (1.0 + REUSE_COST * self._uses[rows, columns])
        good = np.flatnonzero(costs <= float(costs.min()) * (1.0 + TOLERANCE) + 1e-6)
        pick = int(good[self._rng.integers(len(good))])
        row, column = int(rows[pick]), int(columns[pick])
        self._uses[max(0, row - 3) : row + 4, max(0, column - 3) : column + 4] += 1.0
        return self._top + SEARCH_STEP * row, self._left + SEARCH_STEP * column

    def _square_of(self, weight: Float32[np.ndarray, "q q"]) -> Float32[np.ndarray, "a b"]:
        """Sum of squares of the source under a weight at every place: many blocks know the same of themselves."""
        return self._square_by_weight.get(
            weight.tobytes(), lambda: cv2.matchTemplate(self._squares, weight, cv2.TM_CCORR)
        )

    def _pad_to_grid(self, misfit: Float32[np.ndarray, "a b"]) -> Float32[np.ndarray, "p q"]:
        """The misfits at the places' grid: reduced sizes may differ by one at the far ends."""
        wanted: tuple[int, int] = (self._places.shape[0], self._places.shape[1])
        padded = np.full(wanted, np.float32(np.inf))
        rows, columns = min(wanted[0], misfit.shape[0]), min(wanted[1], misfit.shape[1])
        padded[:rows, :columns] = misfit[:rows, :columns]
        return padded


def broad_shading(
    colours: Float32[np.ndarray, "h w 3"], seen: Bool[np.ndarray, "h w"], width_px: float
) -> Float32[np.ndarray, "h w 3"]:
    """The colours without detail finer than about `width_px`, from what was seen only."""
    weight = wide_blur(seen.astype(np.float32), width_px)[..., None]
    blurred = wide_blur((colours * seen[..., None]).astype(np.float32), width_px)
    return np.asarray(blurred / np.maximum(weight, 1e-4), dtype=np.float32)


MIN_COARSE_SIGMA = 6.0
"""The grid is so fine that the blur's sigma has so many cells: linear interpolation then hardly shows."""


def wide_blur(picture: Float32[np.ndarray, "h w *c"], sigma_px: float) -> Float32[np.ndarray, "h w *c"]:
    """The picture blurred by a Gaussian."""
    height, width = picture.shape[:2]
    step = int(sigma_px / MIN_COARSE_SIGMA)
    if step < 2:
        return cv2.GaussianBlur(picture, (0, 0), sigma_px)
    cells = (max(width // step, 1), max(height // step, 1))
    coarse = cv2.resize(picture, cells, interpolation=cv2.INTER_AREA)
    # Averaging over cells and interpolating between them blur a little, too.
    sigmas = [_remaining(sigma_px * n / size) for n, size in zip(cells, (width, height), strict=True)]
    edge = cv2.BORDER_REFLECT  # mirrors at the picture's edge, as the default does on a fine grid
    coarse = cv2.GaussianBlur(coarse, (0, 0), sigmaX=sigmas[0], sigmaY=sigmas[1], borderType=edge)
    return cv2.resize(coarse, (width, height), interpolation=cv2.INTER_LINEAR)


def _remaining(sigma_cells: float) -> float:
    return float(np.sqrt(max(sigma_cells**2 - 1 / 12 - 1 / 6, 0.25)))
