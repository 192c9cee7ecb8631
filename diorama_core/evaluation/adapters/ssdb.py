"""Renderings of the Stanford Scene Database in the layout of the paper's authors.

A scene is a folder: `scene.png` (or `.jpg`), `gt.json` and a segmentation (`seg.npy`, n x h x w masks in the order of
`seg.json`, or one id map). `gt.json` maps object ids to `class`, `name` and `parent_id` (0 for the room).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from diorama_core.artefacts import Inputs
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.files import boxes_of, existing, read_array, read_json
from diorama_core.library.taxonomy import resolve
from diorama_core.perception.inputs import read_inputs

ROOM_WORDS = ("floor", "wall", "ceiling")


@dataclass(frozen=True, eq=False)
class SsdbObject:
    """One annotated object."""

    id: int
    label: str
    category: str
    parent: int | None
    """Id of the object it is placed on; None for the room."""


@dataclass(frozen=True, eq=False)
class SsdbScene:
    """One rendering with its truth."""

    name: str
    inputs: Inputs
    objects: tuple[SsdbObject, ...]


def read_ssdb(folder: Path) -> SsdbScene:
    """Read one scene folder; `InputError` says what is missing."""
    records = read_json(folder / "gt.json")
    if not isinstance(records, dict):
        raise InputError(f"{folder / 'gt.json'}: expected an object of object ids")
    objects = tuple(_object(int(key), value) for key, value in records.items() if not _is_room(value))
    inputs = read_inputs(existing(folder, "scene.png", "scene.jpg")).inputs
    instances = _segmentation(folder, [o.id for o in objects])
    if instances.shape != inputs.photo.rgb.shape[:2]:
        raise InputError(f"{folder}: the segmentation is {instances.shape}, the picture {inputs.photo.rgb.shape[:2]}")
    named = boxes_of(instances, [o.label for o in objects])
    given = Inputs(inputs.photo, tuple(b for _, b in named), instances, named)
    return SsdbScene(folder.name, given, objects)


def _is_room(record: dict[str, object]) -> bool:
    return str(record.get("class") or record.get("name") or "").lower() in ROOM_WORDS


def _object(number: int, record: dict[str, object]) -> SsdbObject:
    label = str(record.get("class") or record.get("name") or "object")
    parent = int(str(record.get("parent_id") or 0))
    return SsdbObject(number, label, resolve(label).category.name, parent or None)


def _segmentation(folder: Path, ids: list[int]) -> np.ndarray:
    """Instance map with id k for the k-th object."""
    path = existing(folder, "seg.npy")
    values = read_array(path)
    rank = {number: k for k, number in enumerate(ids, start=1)}
    if values.ndim == 2:
        instances = np.zeros(values.shape, np.int32)
        for number, k in rank.items():
            instances[values == number] = k
        return instances
    order = [int(r["id"]) for r in read_json(folder / "seg.json")]
    if values.ndim != 3 or len(order) != len(values):
        raise InputError(f"{path}: {values.shape} does not fit the {len(order)} entries of seg.json")
    instances = np.zeros(values.shape[1:], np.int32)
    for number, mask in sorted(zip(order, values, strict=True), key=lambda pair: -int(pair[1].sum())):
        if number in rank:
            instances[mask.astype(bool)] = rank[number]
    return instances
