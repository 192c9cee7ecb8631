"""What the adapters share: reading JSON and tables with errors that name the file, and turning Y-up worlds upright."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.errors import InputError

R_ZUP_YUP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From worlds with +Y up to ours with +Z up."""


def read_json(path: Path) -> Any:
    """A JSON file; one clear line when it is absent or broken."""
    try:
        return json.loads(path.read_text())
    except OSError:
        raise InputError(f"{path}: there is no such file; give a folder laid out as the dataset publishes it") from None
    except ValueError as error:
        raise InputError(f"{path}: not valid JSON ({error}); download it again") from None


def read_matrix(path: Path, rows: int, columns: int) -> Float[np.ndarray, "r c"]:
    """Whitespace-separated numbers of a known shape."""
    try:
        values = np.loadtxt(path, dtype=np.float64, ndmin=2)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: expected {rows} x {columns} numbers ({error})") from None
    if values.shape != (rows, columns):
        raise InputError(f"{path}: expected {rows} x {columns} numbers, found {values.shape[0]} x {values.shape[1]}")
    return values


def existing(folder: Path, *names: str) -> Path:
    """The first of several files that exists."""
    for name in names:
        if (folder / name).is_file():
            return folder / name
    raise InputError(f"{folder}: none of {', '.join(names)} is there; lay it out as the dataset is published")
