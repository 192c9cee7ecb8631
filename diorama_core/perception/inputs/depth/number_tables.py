"""Depth as text: a row of numbers for each row of the picture (numpy's savetxt, spreadsheets, MATLAB's writematrix)."""

from __future__ import annotations

import io
import re

import numpy as np
from jaxtyping import Float

from diorama_core.errors import InputError
from diorama_core.perception.inputs.source import Source

MIN_SIDE = 24
"""Rows and columns: lists of boxes, cameras and points are narrower."""
_ROW = re.compile(rb"[0-9eE.,;\t +-]+|(?i:[0-9eE.,;\t +-]|nan|inf)+")
_SEPARATED = re.compile(rb"[\s,;]+")


def is_number_table(source: Source) -> bool:
    """Whether its first lines are rows of equally many numbers, as many as a picture has columns."""
    head = source.data[:400_000].lstrip(b"\xef\xbb\xbf").splitlines()[:MIN_SIDE]
    counts = {len(_SEPARATED.split(row.strip())) for row in head if _ROW.fullmatch(row)}
    numbers_only = len(head) == MIN_SIDE and all(_ROW.fullmatch(row) for row in head)
    return numbers_only and len(counts) == 1 and min(counts) >= MIN_SIDE


def read_number_table(source: Source) -> Float[np.ndarray, "h w"]:
    """The numbers.

    Raises:
        InputError: a row is damaged or of another length.
    """
    text = _SEPARATED_IN_ROW.sub(b" ", source.data.lstrip(b"\xef\xbb\xbf"))
    try:
        values = np.loadtxt(io.BytesIO(text), dtype=np.float64, ndmin=2)
    except (ValueError, OverflowError) as error:
        raise InputError(f"{source.name}: a row of the table of depth is damaged; save it as .npy") from error
    if min(values.shape) < MIN_SIDE:
        raise InputError(f"{source.name}: a table of {values.shape[1]} x {values.shape[0]} numbers is no depth map")
    return values


_SEPARATED_IN_ROW = re.compile(rb"[,;\t]+")
