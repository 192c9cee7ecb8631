"""Which way the doors of a room open, and how far: into it where nothing stands in the way, else out of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from jaxtyping import Float

from diorama_core.library.furniture.articulation import Articulation
from diorama_core.library.furniture.joints import Joint
from diorama_core.scene.types import SceneObject

QUARTER_RAD = np.pi / 2
STEP_RAD = float(np.radians(5.0))
MIN_OPEN_RAD = float(np.radians(70.0))
"""A leaf of 0.8 m that is open so far leaves half a metre to go through."""
TOUCH_M = 0.01
"""Boxes of objects are so much larger than what is in them, at least."""
STEP_OVER_M = 0.03
"""What is lower, a rug, lies under the leaf."""
ONE_LEAF_M = 1.15
"""Doors whose joints are not known have two leaves when they are wider."""
Outline = Float[np.ndarray, "_ 2"]


@dataclass(frozen=True, eq=False)
class Leaf:
    """One leaf of a door from above, in the world."""

    hinge: Float[np.ndarray, "2"]
    """Place of the axis in the plan."""
    tip: Float[np.ndarray, "2"]
    """Its other end on the hinge's side, shut."""
    outline: Outline
    """Corners of the shut leaf."""
    sign: float
    """Sign of its turn about up, 1 or -1."""

    def turn(self, points: Outline, angle_rad: float) -> Outline:
        """Points of the shut leaf when it is open by an angle."""
        c, s = np.cos(angle_rad), np.sin(self.sign * angle_rad)
        return (points - self.hinge) @ np.array([[c, s], [-s, c]]) + self.hinge


@dataclass(frozen=True, eq=False)
class DoorSwing:
    """Leaves of a hinged door and the side to which they open."""

    outward: bool
    leaves: tuple[Leaf, ...]
    free_rad: float
    """Angle up to which all leaves turn clear of other objects."""

    @property
    def can_open(self) -> bool:
        """True where somebody comes through."""
        return self.free_rad >= MIN_OPEN_RAD


def door_swings(
    items: Sequence[SceneObject], pieces_of: Callable[[str], Articulation | None]
) -> Mapping[str, DoorSwing]:
    """The swing of each door by its id; those whose shape is known to have no hinge are left out.

    Args:
        items: All that stands in the room.
        pieces_of: The moving parts of a shape, by its id.
    """
    doors = {o.id: o for o in items if o.category == "door"}
    others = [o for o in items if o.id not in doors]
    swings = {}
    for door in doors.values():
        pieces = pieces_of(door.shape_id)
        inward, outward = tuple(_leaves(door, pieces, outward=False)), tuple(_leaves(door, pieces, outward=True))
        if not inward:
            continue
        near = _obstacles(door, others)
        swing = DoorSwing(False, inward, _free_rad(inward, near))
        if not swing.can_open and door.open_share == 0.0:
            other = DoorSwing(True, outward, _free_rad(outward, near))
            swing = other if other.can_open else swing
        swings[door.id] = swing
    return swings


def opening_out(joint: Joint, pieces: Articulation, number: int) -> Joint:
    """The hinge of a leaf that opens out of the room: on the edge of its back."""
    back = float(_panel(pieces, number)[:, 0].min())
    x, y, z = joint.axis
    return replace(joint, origin=(back, *joint.origin[1:]), axis=(-x, -y, -z))


def _leaves(door: SceneObject, pieces: Articulation | None, *, outward: bool) -> Iterator[Leaf]:
    """Leaves of a door, into the room or out of it; of one whose joints are not known, as usual."""
    if pieces is None:
        depth, width, _ = door.shape_size_m
        count = 1 if width * float(door.pose.scale[1]) <= ONE_LEAF_M else 2
        x = -depth / 2 if outward else depth / 2
        for side in (1.0, -1.0)[:count]:
            far = side * (width / 2 - width / count)
            yield _leaf(door, x, side * width / 2, np.array([[-depth / 2, far], [depth / 2, far]]), side, outward)
        return
    for number, joint in enumerate(pieces.joints):
        if joint.kind == "hinge":
            turns = opening_out(joint, pieces, number) if outward else joint
            panel = _panel(pieces, number)[:, :2]
            side = float(np.sign(joint.axis[2])) or 1.0
            yield _leaf(door, turns.origin[0], turns.origin[1], panel, side, outward)


def _leaf(door: SceneObject, x: float, y: float, panel: Outline, side: float, outward: bool) -> Leaf:
    """A leaf from its hinge and the extent of its panel in the shape's frame."""
    far = panel[:, 1].min() if side > 0 else panel[:, 1].max()
    low, high = panel[:, 0].min(), panel[:, 0].max()
    flat = np.array([[x, y], [x, far], [low, y], [low, far], [high, far], [high, y]])
    world = door.pose.apply(np.column_stack([flat, np.zeros(len(flat))]))[:, :2]
    return Leaf(world[0], world[1], world[2:], -side if outward else side)


def _panel(pieces: Articulation, number: int) -> Float[np.ndarray, "n 3"]:
    """Corners of the largest piece of a leaf: handles and bars stand off it."""
    largest = max(
        pieces.of_joint(number), key=lambda solid: float(np.prod(np.sort(np.ptp(solid.vertices, axis=0))[1:]))
    )
    return largest.vertices


def _obstacles(door: SceneObject, others: Sequence[SceneObject]) -> shapely.Geometry:
    """Outlines from above of objects as high as a door's leaf."""
    low, high = float(door.corners_world[:, 2].min()) + STEP_OVER_M, float(door.corners_world[:, 2].max())
    outlines = []
    for corners in (o.corners_world for o in others):
        if corners[:, 2].max() > low and corners[:, 2].min() < high:
            outlines.append(shapely.MultiPoint(corners[:, :2]).convex_hull.buffer(-TOUCH_M))
    return shapely.union_all(outlines)


def _free_rad(leaves: Sequence[Leaf], obstacles: shapely.Geometry) -> float:
    """Angle up to which no leaf meets anything, a quarter turn at most."""
    for angle in np.arange(STEP_RAD, QUARTER_RAD + STEP_RAD / 2, STEP_RAD):
        turned = (shapely.Polygon(leaf.turn(leaf.outline, float(angle))) for leaf in leaves)
        if any(t.intersects(obstacles) for t in turned):
            return float(angle - STEP_RAD)
    return float(QUARTER_RAD)
