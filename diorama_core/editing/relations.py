"""How objects stand to one another and to the room, as costs: 0 where a relation holds, above `MET` where it does not.

One definition serves placement, which seeks the least sum, and reports, which name what is not met. Costs are in units
of what people would notice: 0.3 to 0.5 m, or a quarter of a turn.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from diorama_core.editing.footprints import Points, Quads, footprint_of, footprints, gap_between, gaps
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.taxonomy import broad, category, having
from diorama_core.scene.support import ancestors
from diorama_core.scene.types import Scene, SceneObject

RelationKind = Literal[
    "on", "under", "above", "beside", "near", "in front of", "behind", "left of", "right of", "around", "between",
    "facing", "opposite", "aligned with", "against wall", "in corner", "in middle",
]  # fmt: skip
OF_ROOM = ("against wall", "in corner", "in middle")
"""Relations to the room: they name no object."""
MET = 0.6
SIDE_GAP_M = 0.45
"""Beside something is at most this far from it."""
NEAR_M = 0.9
AT_WALL_M = 0.15
IN_CORNER_M = 0.45
THAT_WAY = 0.7
"""Cosine of the angle up to which a wall counts as being in a direction."""
MIDDLE_SHARE = 0.2
"""The middle of a room is this share of its extents."""
FACING_RAD = float(np.radians(30.0))
FACING_REACH_M = 4.0
WATCHING_REACH_M = 7.0
SEATS_FACING_M = 1.1
SEAT_COST = 1.5
"""Cost of a metre from one's own place at a table; wishes are judged without it: another place is as good for them."""
SEATS = having("seat")
BETWEEN_BEDS_M = 0.7
"""Beds side by side lie the same way, with a way to get up and a night stand between them."""
LONG_RATIO = 1.25
"""What is longer than wide by this has a long side, which lies along what it stands before."""
NO_FRONT = having("no_front")
"""Categories that look alike from all sides: anything beside them is beside them."""


@dataclass(frozen=True)
class Relation:
    """One wish about where an object is."""

    kind: RelationKind
    targets: tuple[str, ...] = ()
    """Ids of objects: two for "between", none for relations to the room."""
    aside_m: float = 0.0
    """Distance by which this one's middle is to the target's left, where several are in a row before or opposite it."""
    seat_m: tuple[float, float] | None = None
    """This one's place, where several are around a table: from the table's middle along its own axes."""
    toward: tuple[float, float] | None = None
    """Level direction from the middle of the room: only walls and corners that way are meant."""
    side: str = ""
    """That direction in words."""

    def words(self, scene: Scene) -> str:
        """In words: "beside sofa 1"."""
        if self.kind in OF_ROOM:
            which = f"the {self.side}" if self.side else "a"
            return {
                "against wall": f"against {which} wall",
                "in corner": f"in {which} corner",
                "in middle": "in the middle",
            }[self.kind]
        names = [scene.object(t).label for t in self.targets if scene.has_object(t)]
        return f"{self.kind} {' and '.join(names) or 'each other'}"


@dataclass(frozen=True, eq=False)
class Stances:
    """Many places and headings of one object on a level."""

    size_m: Float[np.ndarray, "3"]
    places: Points
    yaws_rad: Float[np.ndarray, "n"]

    @property
    def quads(self) -> Quads:
        """Their outlines."""
        return footprints(self.size_m, self.places, self.yaws_rad)

    @property
    def fronts(self) -> Points:
        """Unit directions of their fronts."""
        return np.stack([np.cos(self.yaws_rad), np.sin(self.yaws_rad)], axis=1)

    @classmethod
    def of(cls, item: SceneObject) -> Stances:
        """The one stance that an object has."""
        return cls(item.size_m, item.pose.position[None, :2], np.array([item.pose.yaw_rad]))


def relation_cost(
    relation: Relation, stances: Stances, kind: str, targets: Mapping[str, SceneObject], frame: RoomFrame
) -> Float[np.ndarray, "n"]:
    """What a relation costs at every stance of an object of a category.

    "on", "above" for what hangs, and "under" for what lies are made true by where candidates come from; here they cost
    only how far the object is from its target, seen from above.

    Args:
        relation: what was asked for.
        stances: places, headings and sizes.
        kind: category.
        targets: objects by id.
        frame: the room's axes and outline.
    """
    if relation.kind == "against wall":
        return _against_wall(stances, frame, relation.toward)
    if relation.kind == "in corner":
        return _corner_cost(stances, frame, relation.toward)
    if relation.kind == "in middle":
        extent = np.ptp(frame.outline, axis=0) * MIDDLE_SHARE
        return np.maximum(np.abs(stances.places - frame.middle) / np.maximum(extent, 0.1) - 1.0, 0.0).max(axis=1)
    present = [targets[t] for t in relation.targets if t in targets]
    if not present:
        return np.full(len(stances.places), 2.0)
    if relation.kind == "between":
        return _cost_between(stances, present) if len(present) > 1 else np.full(len(stances.places), 2.0)
    cost = np.zeros(len(stances.places))
    for target in present:
        cost = cost + _to_target(relation.kind, stances, kind, target, relation.aside_m)
        if relation.seat_m is not None:
            local = (stances.places - target.pose.position[:2]) @ target.pose.R_world_object[:2, :2]
            cost = cost + SEAT_COST * np.minimum(np.linalg.norm(local - np.array(relation.seat_m), axis=1), 1.0)
    return cost / len(present)


@dataclass(frozen=True, eq=False)
class _Relative:
    """Stances of one object seen from another: n of them, in the frame of the target."""

    kind: RelationKind
    stances: Stances
    name: str
    """Category of the object that stands there."""
    target: SceneObject
    aside_m: float
    local: Float[np.ndarray, "n 2"]
    half: Float[np.ndarray, "2"]
    gap: Float[np.ndarray, "n"]
    """Between the two footprints (m)."""

    @property
    def looking(self) -> Float[np.ndarray, "n"]:
        """Angle between where the object looks and where the target is (rad)."""
        toward = self.target.pose.position[:2] - self.stances.places
        # Whoever sits at a desk looks over it, away from its front.
        over = np.pi if broad(self.name) == "desk" else 0.0
        return _angle(self.stances.yaws_rad + over, np.arctan2(toward[:, 1], toward[:, 0]))

    @property
    def too_far(self) -> Float[np.ndarray, "n"]:
        """Cost of a distance at which the target is not used: people talk across a few metres, and watch a screen
        across more, which stays at its wall in a large room.
        """
        apart = np.linalg.norm(self.target.pose.position[:2] - self.stances.places, axis=1)
        watched = {self.name, self.target.category} & having("watched")
        return np.maximum(apart - (WATCHING_REACH_M if watched else FACING_REACH_M), 0.0) / 0.5


def _to_target(
    kind: RelationKind, stances: Stances, category_name: str, target: SceneObject, aside_m: float
) -> Float[np.ndarray, "n"]:
    local = (stances.places - target.pose.position[:2]) @ target.pose.R_world_object[:2, :2]
    gap = gaps(stances.quads, footprint_of(target))
    return _COSTS[kind](_Relative(kind, stances, category_name, target, aside_m, local, target.size_m[:2] / 2, gap))


def _cost_over(r: _Relative) -> Float[np.ndarray, "n"]:
    outside = np.maximum(np.abs(r.local) - r.half, 0.0).sum(axis=1) / 0.3
    return outside + 0.2 * np.abs(r.local).sum(axis=1) * (r.kind != "on")


def _cost_beside(r: _Relative) -> Float[np.ndarray, "n"]:
    if category(r.target.category).mount == "wall":
        return _cost_by_window(r)
    if broad(r.name) == broad(r.target.category) == "bed":
        heading = _angle(r.stances.yaws_rad, r.target.pose.yaw_rad)
        off_side = np.maximum(r.half[1] - np.abs(r.local[:, 1]), 0.0) / 0.3 + np.abs(r.local[:, 0]) / 0.6
        return heading / FACING_RAD + off_side + np.abs(r.gap - BETWEEN_BEDS_M) / 0.6
    far = np.maximum(r.gap - SIDE_GAP_M, 0.0) / 0.3
    if r.target.category in NO_FRONT:
        return far + 0.15 * r.gap
    off_side = np.maximum(np.abs(r.local[:, 0]) - r.half[0], 0.0) / max(r.half[0], 0.2)
    ahead = np.maximum(np.abs(r.local[:, 0]) - 0.8 * r.half[0], 0.0)
    not_side = np.maximum(r.half[1] - np.abs(r.local[:, 1]), 0.0)
    return far + 0.4 * np.minimum(off_side, 2.0) + 0.4 * ahead + 0.6 * np.minimum(not_side, 1.0) + 0.2 * r.gap


def _cost_near(r: _Relative) -> Float[np.ndarray, "n"]:
    if category(r.target.category).mount == "wall":
        return _cost_by_window(r)
    return np.maximum(r.gap - NEAR_M, 0.0) / 0.4 + 0.1 * r.gap


def _cost_by_window(r: _Relative) -> Float[np.ndarray, "n"]:
    """Cost of places that are neither before what is on a wall nor next to it."""
    corners = (r.stances.quads - r.stances.places[:, None]) @ r.target.pose.R_world_object[:2, 1]
    aside = np.maximum(np.abs(r.local[:, 1]) - r.half[1] - np.abs(corners).max(axis=1), 0.0)
    return np.maximum(r.gap - 0.5, 0.0) / 0.3 + aside / 0.5 + 0.1 * r.gap


def _cost_before_or_behind(r: _Relative) -> Float[np.ndarray, "n"]:
    sign = 1.0 if r.kind == "in front of" else -1.0
    ahead = sign * r.local[:, 0] - r.half[0]
    aside = np.maximum(np.abs(r.local[:, 1]) - r.half[1], 0.0)
    off = np.abs(r.local[:, 1] - r.aside_m)
    return (
        np.maximum(-ahead, 0.0) / 0.2
        + aside / 0.3
        + np.maximum(r.gap - 1.0, 0.0) / 0.4
        + (0.1 if r.aside_m == 0.0 else 0.5) * off
        + _use_distance_cost(r.name, r.target, r.gap)
        + 0.4 * _across(r.stances, r.target)
    )


def _left_or_right(r: _Relative) -> Float[np.ndarray, "n"]:
    """As seen by whoever stands before the target."""
    sign = 1.0 if r.kind == "right of" else -1.0
    aside = sign * r.local[:, 1] - r.half[1]
    ahead = np.maximum(np.abs(r.local[:, 0]) - r.half[0], 0.0)
    return np.maximum(-aside, 0.0) / 0.2 + ahead / 0.4 + np.maximum(r.gap - NEAR_M, 0.0) / 0.4 + 0.15 * r.gap


def _cost_around(r: _Relative) -> Float[np.ndarray, "n"]:
    half, local, yaws = r.half, r.local, r.stances.yaws_rad
    seat, at_front = np.zeros(len(local)), np.zeros(len(local))
    if r.name in SEATS:  # a long table is looked at across, not along to its middle
        spine = half - half.min()
        across = (np.clip(local, -spine, spine) - local) @ r.target.pose.R_world_object[:2, :2].T
        seat = np.maximum(_angle(yaws, np.arctan2(across[:, 1], across[:, 0])) - FACING_RAD, 0.0) / FACING_RAD
    if broad(r.target.category) == "desk":
        ahead = np.maximum(half[0] - local[:, 0], 0.0) / 0.3
        at_front = ahead + np.maximum(np.abs(local[:, 1]) - 0.5 * half[1], 0.0) / 0.3
    square = 0.5 * np.abs(np.sin(2.0 * (yaws - r.target.pose.yaw_rad))) if is_long(r.target.size_m) else 0.0
    corner = np.maximum(np.abs(local) - half, 0.0).min(axis=1) / 0.3 if is_long(r.target.size_m) else 0.0
    near = 1.0 if broad(r.target.category) in ("table", "desk") else 0.4
    return np.maximum(r.gap - 0.5, 0.0) / 0.3 + seat + near * r.gap + at_front + square + corner


def _facing(r: _Relative) -> Float[np.ndarray, "n"]:
    return (
        np.maximum(r.looking - FACING_RAD, 0.0) / FACING_RAD
        + 0.5 * r.looking
        + r.too_far
        + 0.08 * r.gap
        + _too_near(r.name, r.target, r.gap)
    )


def _opposite(r: _Relative) -> Float[np.ndarray, "n"]:
    heading = _angle(r.stances.yaws_rad, r.target.pose.yaw_rad + np.pi)
    aside = np.maximum(np.abs(r.local[:, 1]) - 0.5 * r.half[1] - 0.2, 0.0)
    before = np.maximum(r.half[0] - r.local[:, 0], 0.0) / 0.3
    turned = np.minimum(np.maximum(r.looking - FACING_RAD, 0.0), np.maximum(heading - FACING_RAD, 0.0)) / FACING_RAD
    return (
        before
        + aside / 0.5
        + turned
        + 0.3 * heading
        + (0.3 if r.aside_m == 0.0 else 0.6) * np.abs(r.local[:, 1] - r.aside_m)
        + r.too_far
        + _too_near(r.name, r.target, r.gap)
    )


def _alignment(r: _Relative) -> Float[np.ndarray, "n"]:
    square = np.abs(np.sin(2.0 * (r.stances.yaws_rad - r.target.pose.yaw_rad)))
    offsets = np.abs(r.local)
    edges = np.abs(offsets - np.abs(r.half - r.stances.size_m[:2] / 2))
    return np.minimum(offsets, edges).min(axis=1) / 0.15 * 0.6 + square


_COSTS: dict[RelationKind, Callable[[_Relative], Float[np.ndarray, "n"]]] = {
    "on": _cost_over, "under": _cost_over, "above": _cost_over, "beside": _cost_beside, "near": _cost_near,
    "around": _cost_around, "in front of": _cost_before_or_behind, "behind": _cost_before_or_behind,
    "left of": _left_or_right, "right of": _left_or_right, "facing": _facing, "opposite": _opposite,
    "aligned with": _alignment,
}  # fmt: skip


def _use_distance_cost(name: str, target: SceneObject, gap_m: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
    """Cost by distance: footstools are before the seat, benches at the bed's foot, nobody sits in the fire."""
    within_m, too_hot_m = category(name).used_within_m, category(target.category).too_hot_m or 0.0
    far = 0.0 if within_m is None else 0.6 * np.maximum(gap_m - within_m, 0.0)
    return far + 0.6 * np.maximum(too_hot_m - gap_m, 0.0)


def is_long(size_m: Float[np.ndarray, "3"]) -> bool:
    """Whether something of this size has long sides, seen from above."""
    return float(size_m[:2].max()) > LONG_RATIO * float(size_m[:2].min())


def _across(stances: Stances, target: SceneObject) -> Float[np.ndarray, "n"]:
    """0 where an object's long side runs along the target's front, 1 where it stands out from it."""
    if not is_long(stances.size_m):
        return np.zeros(len(stances.places))
    long_rad = stances.yaws_rad + (0.0 if stances.size_m[0] > stances.size_m[1] else np.pi / 2)
    return np.abs(np.cos(long_rad - target.pose.yaw_rad))


def _too_near(name: str, target: SceneObject, gap_m: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
    """Seats that face each other leave room for legs, and for a table between."""
    if not (name in SEATS and target.category in SEATS):
        return np.zeros(len(gap_m))
    return 0.8 * np.maximum(SEATS_FACING_M - gap_m, 0.0)


def _angle(a: Float[np.ndarray, "n"], b: Float[np.ndarray, "n"] | float) -> Float[np.ndarray, "n"]:
    return np.abs(np.arctan2(np.sin(a - b), np.cos(a - b)))


def _cost_between(stances: Stances, objects: list[SceneObject]) -> Float[np.ndarray, "n"]:
    a, b = objects[0].pose.position[:2], objects[1].pose.position[:2]
    along = (b - a) / max(float(np.linalg.norm(b - a)), 1e-6)
    t = (stances.places - a) @ along / max(float(np.linalg.norm(b - a)), 1e-6)
    across = np.array([-along[1], along[0]])
    aside = np.abs((stances.places - a) @ across)
    # Between two beds is also at their heads.
    beside_both = min(float(np.ptp(footprint_of(o) @ across)) for o in objects[:2]) / 2 - 0.1
    return (
        np.maximum(np.abs(t - 0.5) - 0.2, 0.0) / 0.2
        + np.maximum(aside - max(beside_both, 0.3), 0.0) / 0.3
        + 0.2 * aside
    )


def _against_wall(stances: Stances, frame: RoomFrame, toward: tuple[float, float] | None) -> Float[np.ndarray, "n"]:
    best = np.full(len(stances.places), 3.0)
    for wall in frame.walls:
        if toward is not None and -float(wall.inward @ toward) < THAT_WAY:
            continue
        turned = _angle(stances.yaws_rad, wall.yaw_rad)
        back = wall.off_of(stances.places) - stances.size_m[0] / 2
        t = wall.t_of(stances.places)
        off_end = np.maximum(np.maximum(-t, t - wall.length_m), 0.0)
        off = np.maximum(np.abs(back) - AT_WALL_M, 0.0) / 0.3 + 2.0 * np.clip(back, 0.0, AT_WALL_M)
        best = np.minimum(best, off + turned / FACING_RAD + off_end)
    return best


def _corner_cost(stances: Stances, frame: RoomFrame, toward: tuple[float, float] | None) -> Float[np.ndarray, "n"]:
    corners = [c for c in frame.corners if toward is None or float((c - frame.middle) @ toward) > 0.0]
    if not corners:
        return np.full(len(stances.places), 3.0)
    quads = stances.quads
    reach = np.min([np.linalg.norm(quads - corner, axis=-1).min(axis=1) for corner in corners], axis=0)
    return np.maximum(reach - IN_CORNER_M, 0.0) / 0.3 + 0.2 * reach


def unmet_cost(scene: Scene, object_id: str, relation: Relation, frame: RoomFrame) -> float:
    """What a relation of a placed object costs; above `MET` it is not met.

    Args:
        scene: as it is.
        object_id: of the object.
        relation: what was asked for.
        frame: the room's axes and outline.
    """
    item = scene.object(object_id)
    targets = {t: scene.object(t) for t in relation.targets if scene.has_object(t)}
    if relation.kind == "on":
        above = ancestors(scene, object_id)
        return 0.0 if any(t in above for t in relation.targets) else 2.0
    if relation.kind == "under" and targets:
        under = all(item.corners_world[:, 2].max() <= t.corners_world[:, 2].max() + 0.02 for t in targets.values())
        meet = all(gap_between(item, t) <= 1e-6 for t in targets.values())
        return 0.0 if under and meet else 2.0
    if relation.kind == "above" and targets:
        over = all(item.corners_world[:, 2].min() >= t.corners_world[:, 2].max() - 0.05 for t in targets.values())
        beside = max(gap_between(item, t) for t in targets.values())
        return 0.0 if over and beside < 0.5 else 2.0
    if relation.kind == "against wall" and category(item.category).mount == "wall" and relation.toward is None:
        return 0.0
    return float(relation_cost(relation, Stances.of(item), item.category, targets, frame)[0])


def is_met(scene: Scene, object_id: str, relation: Relation, frame: RoomFrame) -> bool:
    """Whether a relation of a placed object holds.

    Args:
        scene: as it is.
        object_id: of the object.
        relation: what was asked for.
        frame: the room's axes and outline.
    """
    return unmet_cost(scene, object_id, relation, frame) <= MET
