"""What the stages of a build found so far, in a few words each, for those who wait."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from diorama_core.artefacts import ArchitectureEstimate, CameraEstimate


def finding(name: str, artefact: Any) -> str:
    """What is worth telling about an artefact of the plan; empty for most and for None."""
    words = WORDS.get(name)
    return "" if words is None or artefact is None else words(artefact)


def _camera(camera: CameraEstimate) -> str:
    view = np.degrees(camera.best.intrinsics.horizontal_fov_rad)
    return f"field of view {view:.0f}°"


def _room(room: ArchitectureEstimate) -> str:
    return _count(len(room.architecture.by_role("wall")), "wall")


def _objects(objects: Sequence[object]) -> str:
    return _count(len(objects), "object")


def _shapes(shapes: Sequence[object]) -> str:
    return f"shapes for {_count(len(shapes), 'object')}"


def _count(number: int, one: str) -> str:
    return f"1 {one}" if number == 1 else f"{number} {one}s"


WORDS: dict[str, Callable[[Any], str]] = {
    "detected_boxes": lambda boxes: f"{_count(len(boxes), 'piece')} of furniture",
    "camera": _camera,
    "outlined_objects": _objects,
    "architecture": _room,
    "shapes": _shapes,
}
