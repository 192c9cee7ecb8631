"""What the stages of a build found so far, in a few words each and as lines over the photo, for those who wait."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from diorama_core.artefacts import ArchitectureEstimate, CameraEstimate
from diorama_core.geometry.wireframe import box_edges, plane_edges, seen_segments
from diorama_core.progress import Segments


def finding(name: str, artefact: Any) -> str:
    """What is worth telling about an artefact of the plan; empty for most and for None."""
    words = WORDS.get(name)
    return "" if words is None or artefact is None else words(artefact)


def drawing(name: str, known: Mapping[str, Any]) -> Segments:
    """The objects' cuboids and the room's edges over the photo, once they are known; nothing for other artefacts."""
    artefact = known[name]
    if artefact is None:
        return ()
    if name == "measured_geometry":
        camera, edges = artefact.camera, [box_edges(c.corners_world) for c in artefact.cuboids]
    elif name == "architecture":
        camera = known["measured_geometry"].camera
        edges = [plane_edges(p) for p in artefact.architecture.planes if p.seen]
    else:
        return ()
    lines = np.round(seen_segments(camera, edges).reshape(-1, 4), 1)
    return tuple((x1, y1, x2, y2) for x1, y1, x2, y2 in lines.tolist())


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
    "measured_geometry": lambda geometry: f"places of {_count(len(geometry.cuboids), 'object')}",
    "architecture": _room,
    "shapes": _shapes,
}
