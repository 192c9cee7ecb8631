"""SUN RGB-D pictures: a folder with `image/`, `depth_bfx/` (or `depth/`), `intrinsics.txt` and
`annotation2Dfinal/index.json` (polygons), as published.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
from jaxtyping import Int32

from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.files import boxes_of, read_json, read_matrix
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS
from diorama_core.perception.inputs import read_inputs


def read_sunrgbd(folder: Path) -> Inputs:
    """Read one picture's folder with its annotation; `InputError` says what is missing."""
    K = read_matrix(folder / "intrinsics.txt", 3, 3)
    depth = _only(folder / ("depth_bfx" if (folder / "depth_bfx").is_dir() else "depth"), "*.png")
    read = read_inputs(
        _only(folder / "image", "*.jpg"),
        depth=depth,
        depth_encoding="sunrgbd",
        intrinsics=(K[0, 0], K[1, 1], K[0, 2], K[1, 2]),
        max_side=100_000,
    ).inputs
    instances, named = _polygons(folder, (read.photo.height, read.photo.width))
    boxes = tuple(b for _, b in named)
    return Inputs(read.photo, boxes, instances, named, depth_m=read.depth_m, intrinsics=read.intrinsics)


def _only(folder: Path, pattern: str) -> Path:
    paths = sorted(folder.glob(pattern))
    if not paths:
        raise InputError(f"{folder}: no {pattern} is there; give a folder laid out as SUN RGB-D publishes it")
    return paths[0]


def _polygons(
    folder: Path, shape: tuple[int, int]
) -> tuple[Int32[np.ndarray, "h w"], tuple[tuple[int, LabelledBox], ...]]:
    """The instance map drawn from the annotated polygons, large ones first, and a box for each."""
    index = read_json(folder / "annotation2Dfinal" / "index.json")
    drawn: list[tuple[float, str, np.ndarray]] = []
    for polygon in index["frames"][0]["polygon"]:
        label = _label(index["objects"], int(polygon["object"]))
        corners = np.column_stack([polygon["x"], polygon["y"]]).astype(np.float32)
        if label and len(corners) >= 3:
            drawn.append((float(cv2.contourArea(corners)), label, corners))
    drawn.sort(key=lambda d: -d[0])
    instances = np.zeros(shape, np.int32)
    for number, (_, _, corners) in enumerate(drawn, start=1):
        cv2.fillPoly(instances, [np.rint(corners).astype(np.int32)], number)
    return instances, boxes_of(instances, [label for _, label, _ in drawn])


def _label(objects: list[Any], index: int) -> str:
    """The object's name; empty for the room itself and for holes in the list."""
    record = objects[index] if 0 <= index < len(objects) else None
    name = str(record["name"]).split(":")[0].strip().lower() if record else ""
    return "" if name in ARCHITECTURE_WORDS else name
