"""Walls stand where the things that hang on them were found.

What several photos see is placed by rays that meet, within a few centimetres; a wall's line is what single photos made
of the room's edges and of what stands before it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.errors import EditRefused
from diorama_core.library.taxonomy import category
from diorama_core.multiview.joint_fit import JointCuboid, PosedBoxes
from diorama_core.scene.room_edits import move_plane
from diorama_core.scene.types import Architecture, Plane, Scene, yaw_rotation


@dataclass(frozen=True)
class MountedWallsSettings:
    """When a wall is moved to what hangs on it."""

    reach_m: float = 0.4
    """So far may a wall be from the backs of what hangs on it."""
    moved_m: float = 0.02
    """Less is not worth moving a wall."""
    deepest_m: float = 0.3
    """Deeper things tell little of where their backs are."""
    max_sigma_m: float = 0.1
    """Deviation of a thing's place across the wall."""
    beside_m: float = 0.1
    """How far the middle of a thing may be beyond a wall's end."""


SETTINGS = MountedWallsSettings()


def walls_at_mounted(
    room: Architecture, mounted: Sequence[JointCuboid], movable: Collection[str] | None = None
) -> Architecture:
    """The room, each wall moved to the middle of the backs of the things that surely hang on it.

    Args:
        room: closed; walls that cannot move without another one vanishing stay.
        mounted: what hangs on walls, seen by two photos or more.
        movable: ids of walls that may move; all by default. The others stay in their planes, and end where they meet
            one that moved.
    """
    for wall in room.by_role("wall"):
        if movable is not None and wall.id not in movable:
            continue
        gaps = [gap for thing in mounted if (gap := _gap(wall, thing, room)) is not None]
        if not gaps or abs(float(np.median(gaps))) < SETTINGS.moved_m:
            continue
        try:
            room = move_plane(Scene(architecture=room), wall.id, -float(np.median(gaps))).architecture
        except EditRefused:
            continue  # the room is too small there for what was measured: the wall stays where photos saw it
    return room


def room_holding(
    preferred: Architecture, others: Iterable[Architecture], mounted: Sequence[JointCuboid]
) -> Architecture:
    """The first of several readings of a room in which the fewest things on walls are without a wall.

    Args:
        preferred: taken unless another one holds more.
        others: looked at only where the preferred one leaves something without a wall.
        mounted: what hangs on walls.
    """

    def without_wall(room: Architecture) -> int:
        return sum(not _is_near_wall(room, thing) for thing in mounted)

    return preferred if without_wall(preferred) == 0 else min((preferred, *others), key=without_wall)


def _is_near_wall(room: Architecture, thing: JointCuboid) -> bool:
    """Whether a wall is within reach of a thing in plan."""
    reach = SETTINGS.reach_m + float(thing.size_m[:2].min()) / 2
    return any(_from_wall(wall, thing.centre[:2]) < reach for wall in room.by_role("wall"))


def _from_wall(wall: Plane, place: Float[np.ndarray, "2"]) -> float:
    along = np.cross([0.0, 0.0, 1.0], wall.normal)[:2]
    span, at = wall.polygon[:, :2] @ along, float(place @ along)
    beside = max(float(span.min()) - at, at - float(span.max()), 0.0)
    return float(np.hypot(float(wall.normal[:2] @ place) - wall.offset, beside))


def hangs_on_wall(kind: str) -> bool:
    """Whether things of a category have their backs at a wall wherever they are."""
    return category(kind).mount == "wall" or kind == "door"


def is_seen_whole(sightings: Sequence[tuple[PosedBoxes, int]]) -> bool:
    """Whether two photos or more show a thing, and one of them uncut: else its usual size says where it is."""
    return len(sightings) > 1 and any(not photo.observations.truncated[box].any() for photo, box in sightings)


def _gap(wall: Plane, thing: JointCuboid, room: Architecture) -> float | None:
    """From a wall into the room to the back of a thing that hangs on it; None where it hangs elsewhere."""
    gaps = {w.id: gap for w in room.by_role("wall") if (gap := _distance(w, thing)) is not None}
    gap_m = gaps.get(wall.id)
    return gap_m if gap_m is not None and abs(gap_m) == min(map(abs, gaps.values())) else None


def _distance(wall: Plane, thing: JointCuboid) -> float | None:
    axes = np.abs(yaw_rotation(thing.yaw_rad).T @ wall.normal)
    depth = float(axes @ thing.size_m)
    along = np.cross([0.0, 0.0, 1.0], wall.normal)
    span, at = wall.polygon @ along, float(thing.centre @ along)
    gap = float(wall.normal @ thing.centre) - depth / 2 - wall.offset
    unsure = float(np.abs(wall.normal[:2]) @ np.array(thing.place_sigma_m)) > SETTINGS.max_sigma_m
    beside = span.min() - SETTINGS.beside_m < at < span.max() + SETTINGS.beside_m
    return gap if depth < SETTINGS.deepest_m and beside and not unsure and abs(gap) < SETTINGS.reach_m else None
