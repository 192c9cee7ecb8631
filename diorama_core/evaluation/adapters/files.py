"""What the adapters share: reading files with errors that name them, boxes around instances, and upright worlds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float, Int32

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import InputError
from diorama_core.io import bounded
from diorama_core.io.arrays import array_of
from diorama_core.library.taxonomy import resolve

MAX_METADATA_BYTES = 600_000_000
R_ZUP_YUP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From worlds with +Y up to ours with +Z up."""


def read_json(path: Path) -> Any:
    """A JSON file; one clear line when it is absent or broken."""
    if not path.exists():
        raise InputError(f"{path}: there is no such file; give a folder laid out as the dataset publishes it")
    data = bounded.read_bytes(path, MAX_METADATA_BYTES, InputError, "download it again")
    return bounded.parse_json(data, str(path), InputError, advice="download it again", finite=False)


def read_matrix(path: Path, rows: int, columns: int) -> Float[np.ndarray, "r c"]:
    """Whitespace-separated numbers of a known shape."""
    try:
        values = np.loadtxt(path, dtype=np.float64, ndmin=2)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: expected {rows} x {columns} numbers ({error})") from None
    if values.shape != (rows, columns):
        raise InputError(f"{path}: expected {rows} x {columns} numbers, found {values.shape[0]} x {values.shape[1]}")
    return values


def read_array(path: Path) -> np.ndarray:
    """A `.npy` file; one clear line when it is broken."""
    content = bounded.read_bytes(path, MAX_METADATA_BYTES, InputError, "download it again")
    try:
        return array_of(content)
    except Exception as error:  # a damaged header raises almost anything
        reason = bounded.shorten(str(error)) or type(error).__name__
        raise InputError(f"{path}: not an array ({reason}); download it again") from error


def existing(folder: Path, *names: str) -> Path:
    """The first of several files that exists."""
    for name in names:
        if (folder / name).is_file():
            return folder / name
    raise InputError(f"{folder}: none of {', '.join(names)} is there; lay it out as the dataset is published")


def boxes_of(instances: Int32[np.ndarray, "h w"], labels: Sequence[str]) -> tuple[tuple[int, LabelledBox], ...]:
    """Boxes around what is seen of the objects 1, 2, ... of an instance map, with the kinds that their labels mean."""
    boxes = []
    for number, label in enumerate(labels, start=1):
        x, y, width, height = cv2.boundingRect((instances == number).astype(np.uint8))
        if width:
            box = (float(x), float(y), float(x + width), float(y + height))
            boxes.append((number, LabelledBox(box, resolve(label).category.name, label)))
    return tuple(boxes)
