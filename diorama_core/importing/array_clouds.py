"""Point clouds as bare numbers: arrays of numpy, and dumps of 32-bit floats, as KITTI and nuScenes have them."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import numpy as np
from jaxtyping import Float

from diorama_core.errors import InputError
from diorama_core.io.file_heads import FileHead
from diorama_core.perception.inputs.arrays import array_header

MIN_POINTS = 2000
"""Rows from which an array is a list of points, not a small table."""
MAX_ARRAY_BYTES = 2_000_000_000
MAX_COLUMNS = 12
"""Position, colour, normal, labels and how bright it is; more columns are features, or a picture."""
WIDTHS = (3, 4, 5, 6)
"""Floats a point: position; how bright (KITTI); its ring (nuScenes); or a colour."""
MIN_DIFFERENCE = 0.06
"""Distance of the columns' distributions, in shares of their spread; with a wrong width each column mixes all."""
FARTHEST, NEAREST = 1e5, 1e-6
"""Between which the floats of positions lie, but for zeros: bytes of another meaning are beyond."""
MAX_ODD_SHARE = 0.02
_MAGIC = b"\x93NUMPY"


def is_array_cloud(head: FileHead) -> bool:
    """Whether an array, or one of an archive, is a list of points."""
    if not head.head.startswith(_MAGIC) and not (head.is_zip and all(n.endswith(".npy") for n in head.names)):
        return False
    try:
        return _cloud_in(head.path) is not None
    except (OSError, ValueError, SyntaxError, zipfile.BadZipFile, NotImplementedError):
        return False  # damaged: NumPy reads headers as Python, and zipfile cannot read all ways of packing


def read_array_cloud(path: Path) -> Float[np.ndarray, "n 3"]:
    """The points of the first array that is a list of them: its fields x, y and z, or its first three columns."""
    name = _cloud_in(path)
    for array_name, stream, size in _arrays(path):
        if array_name != name:
            continue
        array_header(stream, min(size, MAX_ARRAY_BYTES))
        rows = np.load(stream, allow_pickle=False)
        if rows.dtype.names is not None:
            return np.column_stack([rows[axis].astype(np.float64).ravel() for axis in "xyz"])
        rows = rows[0] if rows.ndim == 3 else rows
        rows = rows.T if rows.shape[0] == 3 < rows.shape[1] else rows
        return np.asarray(rows[:, :3], np.float64)
    raise InputError(f"{path.name} holds no list of points; save them as an array of three columns")


def is_float_dump(head: FileHead) -> bool:
    """Whether a file without a heading is rows of floats, of which the first three are places."""
    return head.suffix == ".bin" and head.size >= 12 * MIN_POINTS and _width(head.head, head.size) is not None


def read_float_dump(path: Path) -> Float[np.ndarray, "n 3"]:
    """The places of a dump's points."""
    with path.open("rb") as stream:
        width = _width(stream.read(1 << 16), path.stat().st_size)
    if width is None:
        raise InputError(f"{path.name} holds no points; export them as PLY or XYZ")
    return np.fromfile(path, "<f4").reshape(-1, width)[:, :3].astype(np.float64)


def _width(head: bytes, size: int) -> int | None:
    """How many floats a point has; None where they are no points."""
    with np.errstate(invalid="ignore"):
        values = np.frombuffer(head[: len(head) // 4 * 4], "<f4").astype(np.float64)
        odd = ~np.isfinite(values) | (np.abs(values) > FARTHEST) | ((np.abs(values) < NEAREST) & (values != 0))
    if len(values) < 100 or odd.mean() > MAX_ODD_SHARE:
        return None
    usual = np.where(odd, 0.0, values)
    differences = {w: _difference(usual, w) for w in WIDTHS if size % (4 * w) == 0}
    most = max(differences.values(), default=0.0)
    return None if most < MIN_DIFFERENCE else min(w for w, d in differences.items() if d > 0.9 * most)


def _difference(values: Float[np.ndarray, "n"], width: int) -> float:
    """How much the distributions of columns differ at most, in shares of the spread of all."""
    rows = values[: len(values) // width * width].reshape(-1, width)
    quantiles = np.quantile(rows, np.linspace(0.05, 0.95, 19), axis=0)
    apart = np.abs(quantiles[:, :, None] - quantiles[:, None, :]).mean(axis=0).max()
    return float(apart / max(np.ptp(np.quantile(values, [0.05, 0.95])), 1e-9))


def _cloud_in(path: Path) -> str | None:
    """The name of the array that is a list of points; empty for the only one of a file."""
    for name, stream, size in _arrays(path):
        shape, dtype = array_header(stream, min(size, MAX_ARRAY_BYTES))
        if dtype.names is not None:
            if {"x", "y", "z"} <= set(dtype.names) and np.prod(shape) >= MIN_POINTS:
                return name
            continue
        rows = shape[1:] if len(shape) == 3 and shape[0] == 1 else shape
        long = dtype.kind in "fi" and len(rows) == 2 and max(rows) >= MIN_POINTS
        if long and (3 <= rows[1] <= MAX_COLUMNS or rows[0] == 3):
            return name
    return None


def _arrays(path: Path) -> Iterator[tuple[str, IO[bytes], int]]:
    """The name, stream and bytes of each array."""
    if not zipfile.is_zipfile(path):
        with path.open("rb") as stream:
            yield "", stream, path.stat().st_size
        return
    with zipfile.ZipFile(path) as archive:
        for member in archive.infolist():
            with archive.open(member) as stream:
                yield member.filename, stream, member.file_size
