"""Furnished rooms to try the editor on, composed of the library on demand; each is the same every time."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace

from diorama_core.appearance.patterns import COLOURS
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Architecture, Plane, Scene, SurfaceFinish, SurfacePattern
from diorama_core.synthesis.grammar import RoomKind, furnish_room

PATTERNS: dict[str, SurfacePattern] = {
    "planks": "boards", "parquet": "parquet", "tiles": "tiles", "checker": "checker", "carpet": "carpet",
    "paint": "paint", "paper": "stripes", "brick": "brick", "panelled": "panelling",
}  # fmt: skip
"""What a finish of a composed room is called where people choose it."""


@dataclass(frozen=True)
class ExampleRoom:
    """What a room is made from."""

    name: str
    kind: RoomKind
    seed: int


EXAMPLE_ROOMS = (
    ExampleRoom("Bedroom", "bedroom", 3),
    ExampleRoom("Study", "study", 6),
    ExampleRoom("Kitchen", "kitchen", 4),
)


def example_room(room: ExampleRoom, library: ShapeLibrary) -> Scene:
    """The furnished room, its walls and floor finished so that they can be finished differently.

    Raises:
        LibraryError: the library has too few shapes to furnish a room.
    """
    scene = furnish_room(room.seed, room.kind, library, outline="box")
    planes = tuple(_finish(plane) for plane in scene.architecture.planes)
    count = Counter(o.category for o in scene.objects)
    # "bed" where there is one, "armchair 2" where there are several.
    objects = tuple(replace(o, label=o.category) if count[o.category] == 1 else o for o in scene.objects)
    return replace(scene, architecture=Architecture(planes), objects=objects)


def _finish(plane: Plane) -> Plane:
    """A plane with the finish that its picture's name tells (`synthesis.finishes`)."""
    if plane.texture is None:
        return plane
    part, style, colour, _ = plane.texture.split(":")
    pattern = "metro" if part == "wall" and style == "tiles" else PATTERNS[style]
    finish = SurfaceFinish(pattern, COLOURS[colour])
    return replace(plane, texture=None, finish=finish, colour=finish.colour, photo_colour=Plane.colour)
