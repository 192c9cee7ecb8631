"""Gaussian splats as points: those that are plainly there. Faint ones and huge ones float around what was filmed.

PLY as Kerbl et al., 3D Gaussian Splatting (2023), write it (opacity as a logit, scales as logarithms), and `.splat`
(32 bytes a splat).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.errors import InputError

MIN_OPACITY = 0.1
MAX_SCALE = 20.0
"""Times the usual splat's largest side: larger ones are sky and fog."""
SPLAT = np.dtype([("at", "<f4", 3), ("scale", "<f4", 3), ("colour", "u1", 4), ("turn", "u1", 4)])
_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip


def is_splat_ply(head: bytes) -> bool:
    """Whether a PLY's heading names what only splats have."""
    heading = head[: head.find(b"end_header")]
    return head.startswith(b"ply") and b" opacity" in heading and b" scale_0" in heading


def read_splat_ply(path: Path) -> Float[np.ndarray, "n 3"]:
    """The centres of the splats that are plainly there.

    Raises:
        InputError: the file is cut off or not written plainly.
    """
    rows = _vertices(path)
    scales = np.exp(np.column_stack([rows[f"scale_{k}"] for k in range(3)]).astype(np.float64))
    points = np.column_stack([rows[axis] for axis in "xyz"]).astype(np.float64)
    opacity = 1.0 / (1.0 + np.exp(-np.clip(rows["opacity"].astype(np.float64), -60.0, 60.0)))
    return points[_plain(opacity, scales)]


def read_splats(path: Path) -> Float[np.ndarray, "n 3"]:
    """The centres of the splats of a `.splat` file that are plainly there."""
    rows = np.fromfile(path, SPLAT, count=path.stat().st_size // SPLAT.itemsize)
    return rows["at"].astype(np.float64)[_plain(rows["colour"][:, 3] / 255.0, rows["scale"].astype(np.float64))]


def _plain(opacity: Float[np.ndarray, "n"], scales: Float[np.ndarray, "n 3"]) -> Bool[np.ndarray, "n"]:
    largest = scales.max(axis=1)
    is_visible = (opacity >= MIN_OPACITY) & np.isfinite(largest)
    usual = float(np.median(largest[is_visible])) if is_visible.any() else 0.0
    return is_visible & (largest <= MAX_SCALE * usual)


def _vertices(path: Path) -> np.ndarray:
    """The vertices of a PLY, by property."""
    with path.open("rb") as stream:
        heading = b""
        while not heading.endswith(b"end_header\n") and len(heading) < 65_536:
            line = stream.readline(4096)
            if not line:
                break
            heading += line.replace(b"\r\n", b"\n")
        lines = heading.decode("ascii", "replace").split("\n")
        kind = next((line.split()[1] for line in lines if line.startswith("format ")), "")
        elements = [k for k, line in enumerate(lines) if line.startswith("element ")]
        first = lines[elements[0]].split() if elements else []
        if (
            len(first) != 3
            or first[1] != "vertex"
            or kind not in ("ascii", "binary_little_endian", "binary_big_endian")
        ):
            raise InputError(f"{path.name} is no plain PLY of splats; export it uncompressed")
        ends = elements[1] if len(elements) > 1 else len(lines)
        properties = [line.split() for line in lines[elements[0] + 1 : ends] if line.startswith("property ")]
        order = ">" if kind == "binary_big_endian" else "<"
        types = np.dtype([(name, order + _TYPES[of]) for _, of, name in properties])
        if kind == "ascii":
            return np.loadtxt(stream, types, max_rows=int(first[2]), ndmin=1)
        return np.fromfile(stream, types, count=int(first[2]))
