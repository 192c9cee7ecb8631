"""Where along an axis a shape's matter is thin: what must not grow when the shape is stretched along that axis.

The shape is probed along lines parallel to the axis. Where a line passes through solid matter only briefly it crosses a
leg, a board, a frame or an arm; where it stays inside for long, it runs along a top, a rail or a seat, which may become
longer without becoming another one.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from diorama_core.io.arrays import array_of
from diorama_core.io.derived import derive

VERSION = 1
"""Raise it when results change: they are kept on disk."""
LINES = 64
"""Along both sides of the shape's cross-section."""
BINS = 400
"""Along the axis."""
SURELY_THIN, SURELY_THICK = 0.22, 0.32
"""Shares of the shape's extent: legs of a small chair are thin, a third of it is not."""
ENOUGH = 0.002
"""Share of the cross-section: less thin matter counts the less."""
LEAST = 0.25
"""What a leg counts beside the side of a cupboard: where all is thin, the thinnest slices keep their form best."""
_OFF_CENTRE = (0.4731, 0.5397)
"""Place in a line's cell: lines through its middle would often meet edges and diagonals, which two triangles share."""
_EDGE_ON = 1e-9
_CHUNK = 2_000_000


def derive_thin_matter(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], axis: int, folder: Path
) -> Float[np.ndarray, " bins"]:
    """`thin_matter` from its file in a folder, or made now and written: every new process stretches the same shapes.

    Args:
        vertices: Of the shape, metres.
        faces: Triangles.
        axis: Along which it is cut.
        folder: Of the files.
    """
    content = hashlib.sha256(f"{VERSION} {axis} {len(vertices)}".encode())
    content.update(np.ascontiguousarray(vertices, np.float64).tobytes())
    content.update(np.ascontiguousarray(faces, np.int64).tobytes())

    def make() -> bytes:
        data = BytesIO()
        np.save(data, thin_matter(vertices, faces, axis))
        return data.getvalue()

    return derive(folder / f"{content.hexdigest()[:32]}.npy", make, _read)


def _read(data: bytes) -> Float[np.ndarray, " bins"]:
    values = array_of(data)
    if values.shape != (BINS,) or not np.isfinite(values).all():
        raise ValueError("these are no slices of a shape")
    return values


def thin_matter(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], axis: int
) -> Float[np.ndarray, " bins"]:
    """How much of the matter in each slice is thin along the axis: 0 where nothing is, 1 where most is.

    Args:
        vertices: Of the shape.
        faces: Counter-clockwise seen from outside; bodies may touch and overlap, sheets without a back say nothing.
        axis: 0, 1 or 2.
    """
    low, high = vertices[:, axis].min(), vertices[:, axis].max()
    extent = float(high - low)
    starts, ends = _runs(*_crossings(vertices, faces, axis))
    length = (ends - starts) / extent
    weight = np.clip((SURELY_THICK - length) / (SURELY_THICK - SURELY_THIN), 0.0, 1.0)
    first = np.floor((starts - low) / extent * BINS + 1e-6).astype(int).clip(0, BINS - 1)
    last = np.ceil((ends - low) / extent * BINS - 1e-6).astype(int).clip(1, BINS)
    change = np.bincount(first, weight, minlength=BINS + 1) - np.bincount(last, weight, minlength=BINS + 1)
    mass = np.cumsum(change)[:BINS].clip(0.0) / LINES**2
    return np.clip(mass / ENOUGH, 0.0, 1.0) * (LEAST + (1.0 - LEAST) * (mass / max(float(mass.max()), ENOUGH)) ** 2)


def _crossings(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], axis: int
) -> tuple[Int[np.ndarray, " c"], Float[np.ndarray, " c"], Int[np.ndarray, " c"]]:
    """Where lines pass through a surface: line, place along the axis, and 1 into matter or -1 out of it; in order."""
    across = [a for a in range(3) if a != axis]
    low = vertices[:, across].min(axis=0)
    cell = np.maximum(np.ptp(vertices[:, across], axis=0), 1e-9) / LINES
    # Lines are at whole numbers.
    flat = (vertices[:, across] - low) / cell - _OFF_CENTRE
    corners, along = flat[faces], vertices[:, axis][faces]
    lines, places, signs = [], [], []
    for triangle, column, row in _cells_of(corners):
        a, b, c = (corners[triangle, k] for k in range(3))
        point = np.stack([column, row], axis=1)
        area = _cross(b - a, c - a)
        facing = np.abs(area) > _EDGE_ON
        of_two = np.stack([_cross(b - point, c - point), _cross(c - point, a - point)], axis=1)
        of_two = of_two / np.where(facing, area, 1.0)[:, None]
        weights = np.concatenate([of_two, 1.0 - of_two.sum(axis=1, keepdims=True)], axis=1)
        inside = facing & (weights >= 0.0).all(axis=1)
        lines.append((row * LINES + column)[inside])
        places.append((weights * along[triangle]).sum(axis=1)[inside])
        signs.append(np.sign(area[inside]).astype(int))
    # A face whose normal points forward is seen counter-clockwise from the front, where the next two axes are x and y.
    forward = -1 if axis != 1 else 1
    line, at = np.concatenate(lines), np.concatenate(places)
    if not len(line):
        return line, at, line
    enters = forward * np.concatenate(signs)
    if float(enters @ (at - at.mean())) > 0:  # a shape that is inside out: it leaves matter before it enters
        enters = -enters
    order = np.lexsort((-enters, np.round(at, 7), line))
    return line[order], at[order], enters[order]


def _cells_of(
    corners: Float[np.ndarray, "m 3 2"],
) -> Iterator[tuple[Int[np.ndarray, " k"], Int[np.ndarray, " k"], Int[np.ndarray, " k"]]]:
    """Triangles, and column and row of every line within their bounds; in portions."""
    first = np.ceil(corners.min(axis=1)).astype(int).clip(0, LINES)
    counts = (np.floor(corners.max(axis=1)).astype(int).clip(-1, LINES - 1) - first + 1).clip(0)
    total = counts.prod(axis=1)
    portion = np.cumsum(total) // _CHUNK
    for number in np.unique(portion):
        chosen = np.flatnonzero((portion == number) & (total > 0))
        triangle = np.repeat(chosen, total[chosen])
        position = np.arange(len(triangle)) - np.repeat(np.cumsum(total[chosen]) - total[chosen], total[chosen])
        wide = counts[triangle, 0]
        yield triangle, first[triangle, 0] + position % wide, first[triangle, 1] + position // wide


def _runs(
    line: Int[np.ndarray, " n"], at: Float[np.ndarray, " n"], enters: Int[np.ndarray, " n"]
) -> tuple[Float[np.ndarray, " r"], Float[np.ndarray, " r"]]:
    """Where lines enter matter and where they leave it again.

    On lines that enter as often as they leave, what touches or overlaps is one; surfaces that do not close only tell of
    matter where a way in is followed by a way out.
    """
    if not len(line):
        return np.zeros(0), np.zeros(0)
    first = np.flatnonzero(np.concatenate([[True], line[1:] != line[:-1]]))
    count = np.diff(np.append(first, len(line)))
    depth = np.cumsum(enters)
    depth = depth - np.repeat(depth[first] - enters[first], count)
    closes = (np.minimum.reduceat(depth, first) >= 0) & (np.add.reduceat(enters, first) == 0)
    closed = np.repeat(closes, count)
    starts, ends = closed & (enters > 0) & (depth == 1), closed & (enters < 0) & (depth == 0)
    in_out = ~closed[:-1] & (line[1:] == line[:-1]) & (enters[:-1] > 0) & (enters[1:] < 0)
    return np.concatenate([at[starts], at[:-1][in_out]]), np.concatenate([at[ends], at[1:][in_out]])


def _cross(a: Float[np.ndarray, "k 2"], b: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, " k"]:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
