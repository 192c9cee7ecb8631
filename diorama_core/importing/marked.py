"""What a file written by Diorama says when it is read: the scene document, and every node as it is now."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.errors import InputError
from diorama_core.io.bounded import parse_json


@dataclass(frozen=True, eq=False)
class ObjectNode:
    """One object's node."""

    id: str
    """Object id that the node was written with; copies of a node share it."""
    name: str
    M_world_shape: Float[np.ndarray, "4 4"]
    """Shape frame to world (+Z up, metres), scale included."""
    entry: Mapping[str, Any] | None
    """The object's entry of the scene document, as the node carries it."""
    parent: int | None
    """Index of the nearest object node above it; None where there is none."""


@dataclass(frozen=True, eq=False)
class MarkedFile:
    """A file with Diorama's marks in it."""

    document: str
    """The scene document (`scene.schema`) as text."""
    nodes: tuple[ObjectNode, ...]
    """In the file's order, parents before children."""
    written: frozenset[str] | None = None
    """Ids of the objects that were written; None when the file does not say."""
    planes: Mapping[str, Float[np.ndarray, "4 4"]] = field(default_factory=dict)
    """How each plane was moved since it was written, in the world."""
    T_world_camera: Float[np.ndarray, "4 4"] | None = None
    """Where the photo's camera is, axes x right, y down, z forward; None when the file has none."""
    pictures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]] = field(default_factory=dict)
    """Pictures on planes, by plane id."""
    material_pictures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]] = field(default_factory=dict)
    """Pictures of the objects' materials from the photo, by texture name."""
    provenance: Mapping[str, Any] = field(default_factory=dict)
    photo: bytes | None = None
    """File of the photo; None when it was not put in."""


def as_mapping(value: object) -> Mapping[str, Any] | None:
    """A mark as a mapping: files keep it as JSON text, some programs turn it into a table; None when it is neither."""
    if isinstance(value, str):
        value = _parse(value)
    return value if isinstance(value, Mapping) else None


def as_bytes(value: object) -> bytes | None:
    """Bytes written in base 64; None when it is something else."""
    try:
        return base64.b64decode(value, validate=True) if isinstance(value, str) and value else None
    except ValueError:
        return None


def _parse(text: str) -> object:
    """JSON out of a foreign file; None when it is none."""
    try:
        return parse_json(text, "a mark", InputError)
    except InputError:
        return None


def as_ids(value: object) -> frozenset[str] | None:
    """A list of ids, as JSON text or as a list; None when it is neither."""
    if isinstance(value, str):
        value = _parse(value)
    return frozenset(str(v) for v in value) if isinstance(value, list) else None
