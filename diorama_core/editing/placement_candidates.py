"""Where an object could go: stances on floor, furniture, walls and ceiling, and what holds it up there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.editing.collisions import WALKED_ON_M
from diorama_core.editing.footprints import footprint_of, gap_between, lie_within, overlapping
from diorama_core.editing.habits import carries, host_cost, stands, tuck_hosts
from diorama_core.editing.placing import places_of
from diorama_core.editing.relations import Relation, Stances
from diorama_core.editing.room_frame import RoomFrame, WallLine
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import broad, category, having
from diorama_core.scene.types import Pose, Scene, SceneObject, Support, yaw_rotation

WALL_GAP_M = 0.015
STEP_M = 0.12
GRID_M = 0.22
EYE_M = 1.55
OVERHANG = 0.35
"""Share of an object's width by which it may reach beyond what it stands on: a lamp's shade, a plant's leaves."""
ON_FLOOR_COST = 1.5
"""What it costs to put on the floor what belongs on furniture."""
WITHIN_REACH_M = 1.2
"""What is put beside something goes on furniture that is no farther from it."""


@dataclass(eq=False)
class Candidates:
    """Stances on one level, and what holds the object up there."""

    stances: Stances
    base_m: Float[np.ndarray, "n"]
    supports: list[Support | None]
    extra: Float[np.ndarray, "n"]
    """What a place costs in itself."""
    usable: Bool[np.ndarray, "n"]

    def pose(self, item: SceneObject, k: int) -> Pose:
        """The pose of an object at one of them."""
        x, y = self.stances.places[k]
        z = float(self.base_m[k]) + float(item.size_m[2]) / 2
        return Pose(yaw_rotation(float(self.stances.yaws_rad[k])), np.array([x, y, z]), item.pose.scale)


def candidates_for(
    scene: Scene, item: SceneObject, relations: Sequence[Relation], frame: RoomFrame, library: ShapeLibrary
) -> list[Candidates]:
    """All places that an object could take, level by level: on what relations and its category say.

    Args:
        scene: without the object.
        item: what; its size counts.
        relations: "on" and "above" decide where candidates come from.
        frame: of the scene.
        library: where surfaces of shapes are.
    """
    mount = category(item.category).mount
    on = [t for r in relations if r.kind == "on" for t in r.targets if scene.has_object(t)]
    above = [t for r in relations if r.kind == "above" for t in r.targets if scene.has_object(t)]
    if on:
        return _object_candidates(scene, item, on, library)
    if mount == "wall":
        return [_wall_candidates(scene, item, above, frame)]
    if mount == "ceiling":
        return [_ceiling_candidates(scene, item, above, frame)]
    floor = _floor_candidates(scene, item, relations, frame)
    if mount == "surface":
        named = [t for r in relations for t in r.targets if scene.has_object(t)]
        carriers = [o.id for o in scene.objects if carries(o) and o.id not in named]
        targets = [t for t in named if carries(scene.object(t))]
        beside_named = [
            c for c in carriers
            if any(gap_between(scene.object(c), scene.object(t)) < WITHIN_REACH_M for t in named)
        ]  # fmt: skip
        on_objects = _object_candidates(scene, item, beside_named if named else carriers + targets, library)
        if not named:
            return on_objects or [floor]
        return [*on_objects, replace(floor, extra=floor.extra + ON_FLOOR_COST)]
    return [floor]


def _floor_candidates(scene: Scene, item: SceneObject, relations: Sequence[Relation], frame: RoomFrame) -> Candidates:
    stances = _floor_stances(scene, item, relations, frame)
    count = len(stances.places)
    quads = stances.quads
    usable = lie_within(quads, frame.outline)
    usable &= ~_is_blocked(scene, item, quads, relations)
    support = None if frame.floor_id is None else Support(item.id, frame.floor_id)
    base = np.full(count, frame.floor_m)
    supports: list[Support | None] = [support] * count
    if item.category not in having("rug"):
        for rug in (o for o in scene.objects if o.category in having("rug")):
            on = np.array(lie_within(quads, footprint_of(rug), 0.001))
            base[on] = float(rug.corners_world[:, 2].max())
            for k in np.flatnonzero(on):
                supports[k] = Support(item.id, rug.id)
    return Candidates(stances, base, supports, np.zeros(count), usable)


def _floor_stances(scene: Scene, item: SceneObject, relations: Sequence[Relation], frame: RoomFrame) -> Stances:
    """Along the walls, about what the relations name, and over all of the floor."""
    places: list[np.ndarray] = []
    yaws: list[np.ndarray] = []

    def add(xy: np.ndarray, yaw: np.ndarray | float) -> None:
        places.append(np.atleast_2d(xy))
        yaws.append(np.broadcast_to(np.asarray(yaw, dtype=float), (len(places[-1]),)))

    depth, width = float(item.size_m[0]), float(item.size_m[1])
    for wall in frame.walls:
        t = _steps_along(wall, width, WALL_GAP_M)
        if len(t):
            add(wall.start + t[:, None] * wall.direction + wall.inward * (depth / 2 + WALL_GAP_M), wall.yaw_rad)
    targets = [scene.object(t) for r in relations for t in r.targets if scene.has_object(t)]
    turns = frame.axis_rad + np.arange(4) * np.pi / 2
    for target in targets:
        for xy, yaw in _places_around(target, item):
            add(xy, yaw)
    if len(targets) > 1:
        middle = np.mean([t.pose.position[:2] for t in targets], axis=0)
        for yaw in turns:
            add(middle, float(yaw))
    low, high = frame.outline.min(axis=0), frame.outline.max(axis=0)
    grid = _grid([np.arange(a + 0.1, b, GRID_M) for a, b in zip(low, high, strict=True)])
    for yaw in turns:
        add(np.concatenate([grid, frame.middle[None]]), float(yaw))
    for target in targets[:3]:
        toward = target.pose.position[:2] - grid
        add(grid, np.arctan2(toward[:, 1], toward[:, 0]))
    return Stances(item.size_m, np.concatenate(places), np.concatenate(yaws))


def _steps_along(wall: WallLine, width_m: float, gap_m: float, more: Sequence[float] = ()) -> Float[np.ndarray, "n"]:
    """Places along a wall for something so wide that keeps a gap to its ends: every step, the middle, and some more."""
    low, high = width_m / 2 + gap_m, wall.length_m - width_m / 2 - gap_m
    if high < low:
        return np.zeros(0)
    steps = np.unique(np.concatenate([np.arange(low, high, STEP_M), [high, 0.5 * wall.length_m]]))
    steps = np.concatenate([steps, more])
    return steps[(steps >= low - 1e-9) & (steps <= high + 1e-9)]


def _grid(steps: Sequence[Float[np.ndarray, "_"]]) -> Float[np.ndarray, "n 2"]:
    """All points with one of the first and one of the second coordinates."""
    return np.stack(np.meshgrid(*steps), axis=-1).reshape(-1, 2)


def _places_around(target: SceneObject, item: SceneObject) -> list[tuple[Float[np.ndarray, "n 2"], float]]:
    """Places on the four sides of a target, at several distances and shifts, with headings in quarter turns to it."""
    candidates = []
    half, yaw0 = target.size_m[:2] / 2, target.pose.yaw_rad
    R = yaw_rotation(yaw0)[:2, :2]
    for quarter in range(4):
        half_size = item.size_m[:2] / 2 if quarter % 2 == 0 else item.size_m[1::-1] / 2
        for side in range(4):
            out = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]][side], dtype=float)
            across = np.array([-out[1], out[0]])
            reach = float(np.abs(out) @ (half + half_size))
            free = float(np.abs(across) @ half)
            flush = max(float(np.abs(across) @ (half - half_size)), 0.0)
            slides = sorted({0.0, 0.33 * free, -0.33 * free, 0.6 * free, -0.6 * free, flush, -flush})
            distances = (-0.3, -0.22, -0.15, -0.08, 0.03, 0.08, 0.2, 0.35, 0.5, 0.8, 1.2, 1.8, 2.4)
            local = np.array([out * (reach + g) + across * s for g in distances for s in slides])
            candidates.append((local @ R.T + target.pose.position[:2], yaw0 + quarter * np.pi / 2))
    turns = np.arange(12) * np.pi / 6
    for reach in (0.25, 0.4, 0.6):
        radius = float(half.max() + item.size_m[0] / 2 + reach) - 0.3
        ring = target.pose.position[:2] + radius * np.stack([np.cos(turns + yaw0), np.sin(turns + yaw0)], axis=1)
        candidates += [(ring[k : k + 1], float(turns[k] + yaw0 + np.pi)) for k in range(len(turns))]
    candidates.append((target.pose.position[None, :2], yaw0))
    candidates.append((target.pose.position[None, :2], yaw0 + np.pi / 2))
    return candidates


def _is_blocked(
    scene: Scene, item: SceneObject, quads: Float[np.ndarray, "n 4 2"], relations: Sequence[Relation]
) -> Bool[np.ndarray, "n"]:
    """Stances on the floor that share their place with furniture, seats pushed under tables apart."""
    hit = np.zeros(len(quads), dtype=bool)
    if item.size_m[2] < WALKED_ON_M:
        return hit
    under = {t for r in relations if r.kind == "under" for t in r.targets}
    tucked = tuck_hosts(item)
    for other in scene.objects:
        low, high = float(other.corners_world[:, 2].min()), float(other.corners_world[:, 2].max())
        if other.size_m[2] < WALKED_ON_M or low > item.size_m[2] + 0.01 or high < 0.02 or other.hidden:
            continue
        if other.id in under or broad(other.category) in tucked or item.category in tuck_hosts(other):
            continue
        hit |= overlapping(quads, footprint_of(other), 0.004)
    return hit


def _object_candidates(
    scene: Scene, item: SceneObject, hosts: Sequence[str], library: ShapeLibrary
) -> list[Candidates]:
    candidates: list[Candidates] = []
    usual = category(item.category).mount
    for place in places_of(scene, library):
        if place.parent not in hosts or not place.upward:
            continue
        host = scene.object(place.parent)
        if item.size_m[2] > place.surface.clearance_m - 0.01:
            continue
        outline = place.surface.polygon[:, :2]
        R = host.pose.R_world_object[:2, :2]
        local = (outline - host.pose.position[:2]) @ R
        low, high = local.min(axis=0), local.max(axis=0)
        steps = [np.linspace(a, b, max(3, min(13, int((b - a) / 0.05)))) for a, b in zip(low, high, strict=True)]
        flat = _grid(steps)
        yaws = [0.0, np.pi / 2] if item.size_m[1] > np.ptp(local[:, 1]) or item.category in having("rug") else [0.0]
        turns = np.repeat(yaws, len(flat)) + host.pose.yaw_rad
        flat = np.concatenate([flat] * len(yaws))
        stances = Stances(item.size_m, flat @ R.T + host.pose.position[:2], turns)
        quads = stances.quads
        share = 1.0 - OVERHANG if usual == "surface" or item.category == "plant" else 1.0
        usable = np.array(lie_within(replace(stances, size_m=stances.size_m * share).quads, outline, 0.01))
        off = np.abs(flat - 0.5 * (low + high)) / np.maximum((high - low) / 2, 0.05)
        extra = 0.15 * off.sum(axis=1) + 0.4 * ~np.array(lie_within(quads, outline, 0.01))
        deep = max(float(high[0] - low[0]), 0.05)
        if item.category in having("along_the_back"):
            extra += 0.3 * (flat[:, 0] - low[0]) / deep
        if item.category in having("near_the_edge"):
            extra += 0.3 * (high[0] - flat[:, 0]) / deep
        for child in scene.children_of(place.parent):
            other = scene.object(child)
            if abs(float(other.corners_world[:, 2].min()) - place.surface.level) < 0.08:
                usable &= ~overlapping(quads, footprint_of(other), -0.01)
        inner = np.isfinite(place.surface.clearance_m)
        extra = extra + 0.5 * inner + host_cost(item, host) * (usual == "surface")
        edge = Support(item.id, place.parent, parent_surface=place.index)
        base = np.full(len(flat), place.surface.level)
        candidates.append(Candidates(stances, base, [edge] * len(flat), extra, usable))
    return candidates


def _wall_candidates(scene: Scene, item: SceneObject, above: Sequence[str], frame: RoomFrame) -> Candidates:
    places, yaws, base, extra, usable = [], [], [], [], []
    supports: list[Support | None] = []
    height, width = float(item.size_m[2]), float(item.size_m[1])
    for wall in frame.walls:
        if wall.high_m - wall.low_m < height:
            continue
        hosts = [float(wall.t_of(scene.object(i).pose.position[:2])) for i in above]
        for t in _steps_along(wall, width, 0.05, hosts):
            span = (t - width / 2, t + width / 2)
            top = frame.floor_m
            behind = 0.0
            for other in scene.objects:
                corners = other.corners_world
                along = wall.t_of(corners[:, :2])
                if float(wall.off_of(corners[:, :2]).min()) > 0.4 or other.hidden:
                    continue
                if along.max() > span[0] and along.min() < span[1]:
                    if category(other.category).mount == "wall":
                        behind += 5.0
                    elif stands(scene, other):
                        top = max(top, float(corners[:, 2].max()))
            centre = max(frame.floor_m + EYE_M, top + 0.12 + height / 2)
            low_z = centre - height / 2
            if category(item.category).name in ("curtain", "door"):
                low_z = frame.floor_m + 0.01
            places.append(wall.start + t * wall.direction + wall.inward * item.size_m[0] / 2)
            yaws.append(wall.yaw_rad)
            base.append(low_z)
            supports.append(Support(item.id, wall.id, "mounted on", child_face="back"))
            usable.append(low_z + height <= wall.high_m - 0.03)
            extra.append(behind + 0.5 * abs(centre - frame.floor_m - EYE_M) + 0.3 * abs(t / wall.length_m - 0.5))
    stances = Stances(item.size_m, np.array(places).reshape(-1, 2), np.array(yaws))
    return Candidates(stances, np.array(base), supports, np.array(extra), np.array(usable, dtype=bool))


def _ceiling_candidates(scene: Scene, item: SceneObject, above: Sequence[str], frame: RoomFrame) -> Candidates:
    low, high = frame.outline.min(axis=0), frame.outline.max(axis=0)
    steps = [np.linspace(a, b, 15)[1:-1] for a, b in zip(low, high, strict=True)]
    hosts = [scene.object(i).pose.position[None, :2] for i in above]
    places = np.concatenate([_grid(steps), frame.middle[None], *hosts])
    stances = Stances(item.size_m, places, np.full(len(places), frame.axis_rad))
    usable = np.array(lie_within(stances.quads, frame.outline))
    heights, support = np.full(len(places), frame.floor_m + 2.5), None
    if frame.ceiling is not None:
        n = frame.ceiling.normal
        heights = (frame.ceiling.offset - places @ n[:2]) / n[2]
        support = Support(item.id, frame.ceiling.id, "mounted on", child_face="top")
    base = heights - item.size_m[2] - 0.005
    extra = 0.3 * np.linalg.norm(places - frame.middle, axis=1)
    return Candidates(stances, base, [support] * len(places), extra, usable)
