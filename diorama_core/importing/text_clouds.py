"""Point clouds in plain text (XYZ, PTS, ASC, CSV) and PCD."""

from __future__ import annotations

import re
import warnings
from itertools import islice
from pathlib import Path

import numpy as np
from jaxtyping import Float

from diorama_core.errors import InputError

TEXT_SUFFIXES = (".xyz", ".pts", ".ptx", ".asc", ".txt", ".csv", ".xyzrgb", ".xyzn")
LOOKED_AT = 40
"""Lines that tell how a file is written."""
_NUMBER = r"[-+]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|(?i:nan))"
_AXIS = re.compile(r"(?:pos(?:ition)?|coord|points?)?[_: ]?([xyz])(?:[ _\[(].*)?")
"""Names of columns, as in X, pos_x, "y [m]"."""
_ROW = re.compile(rf"^\s*{_NUMBER}(?:[\s,;]+{_NUMBER}){{2,}}\s*[,;]?\s*$")


def is_text_cloud(text: str) -> bool:
    """Whether a text's lines are rows of three numbers or more, after at most a few lines of another kind."""
    lines = [line for line in text.splitlines()[:-1] or text.splitlines() if line.strip()][:LOOKED_AT]
    rows = [bool(_ROW.match(line)) for line in lines]
    return len(lines) >= 3 and sum(rows) >= 0.8 * len(rows) and all(rows[len(rows) // 2 :])


def read_text_cloud(path: Path) -> Float[np.ndarray, "n 3"]:
    """The points of a text file: the columns x, y and z where a heading names them, else the first three.

    Raises:
        InputError: there are no rows of numbers in it.
    """
    with path.open(encoding="utf-8-sig", errors="replace") as stream:
        beginning = list(islice(stream, LOOKED_AT))
    first = next((k for k, line in enumerate(beginning) if _ROW.match(line)), None)
    if first is None:
        raise InputError(f"{path.name} has no rows of three numbers; export the points as 'x y z' lines")
    delimiter = next((d for d in (";", ",") if d in beginning[first]), None)
    columns = _columns(beginning[first - 1] if first else "", delimiter)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        rows = np.loadtxt(
            path, np.float64, comments=("#", "//"), delimiter=delimiter, skiprows=first, usecols=columns, ndmin=2,
            encoding="utf-8-sig",
        )  # fmt: skip
    return np.asarray(rows, np.float64).reshape(-1, 3)


def _columns(heading: str, delimiter: str | None) -> tuple[int, ...]:
    words = [w.strip(" \t\r\n\"'/#").lower() for w in (heading.split(delimiter) if delimiter else heading.split())]
    names = [match[1] if (match := _AXIS.fullmatch(word)) else "" for word in words]
    return tuple(names.index(axis) for axis in "xyz") if {"x", "y", "z"} <= set(names) else (0, 1, 2)


def read_pcd(path: Path) -> Float[np.ndarray, "n 3"]:
    """The points of a PCD file in any of its three encodings."""
    from diorama_core.io.large_libraries import o3d

    cloud = o3d.io.read_point_cloud(str(path), format="pcd")
    return np.asarray(cloud.points, np.float64).reshape(-1, 3)
