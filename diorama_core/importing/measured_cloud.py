"""A room in measured points: floor and ceiling, walls at right angles, and a box around everything that stands between.

Floor and ceiling are where heights are densest. Walls are lines along the room's two axes above which points reach up;
the lines divide the plan into cells, and those that were scanned are the room (as in Mura et al., Automatic room
detection and reconstruction in cluttered indoor environments, 2014, for two axes). What is left is split where it does
not touch, and where things lie on furniture (`scanned_tops`). Doors and windows are holes and leaves in walls
(`find_openings`).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float
from shapely.geometry import Polygon, box
from shapely.ops import unary_union

from diorama_core.errors import InputError
from diorama_core.importing.measured_types import MeasuredFloor, MeasuredRoom, MeasuredWall
from diorama_core.importing.point_cloud import LEVEL_M, PointCloud, likely_up, sharpness
from diorama_core.importing.scanned_boxes import OFF_M, ScannedRoom, boxes_in, is_part_of, rugs_in
from diorama_core.importing.scanned_openings import find_openings
from diorama_core.importing.storeys import largest_polygon
from diorama_core.scene.types import yaw_rotation

MAX_REACH_M = 60.0
FARTHEST_M = 1e8
"""From the file's zero: surveyors' grids are within 10,000 km."""
VOXEL_M = 0.03
LEVEL_SHARE = 0.3
"""Points of a floor or ceiling, as a share of the densest level's."""
LEVEL_PEAK = 1.5
"""As many points as at most heights are on a floor or a ceiling."""
BEYOND_SHARE = 0.1
"""Largest share of all points below the floor, or above the ceiling."""
LOWEST_ROOM_M = 1.8
LINE_M = 0.03
"""Bin width of the histograms across walls."""
SPAN_M = 0.1
"""Along walls."""
REACH_SHARE = 0.45
"""Share of the height above furniture that the points of a wall cover."""
FURNITURE_M = 1.0
"""Lines are looked for above this height."""
MIN_WALL_M = 0.5
APART_M = 0.15
"""Nearer parallel lines are one wall."""
SCANNED_SHARE = 0.45
"""Scanned share from which a cell of the plan belongs to the room."""


def measure_cloud(cloud: PointCloud) -> MeasuredRoom:
    """Walls, floor and boxes of a cloud; the world is +Z up, the floor at 0, axes along x and y.

    Raises:
        InputError: there is no floor in it.
    """
    _spread(cloud.points, 2 * MAX_REACH_M)  # whichever way they are turned: a diagonal is shorter than two sides
    T = np.eye(4)
    T[:3, :3] = _upright_axes(cloud)
    points = _thin(cloud.points @ T[:3, :3].T)
    levels = _levels(points[:, 2])
    floor_m, top_m = levels.floor_m, levels.top_m - levels.floor_m
    points = points - [0.0, 0.0, floor_m]
    turn = yaw_rotation(-_heading(points, top_m))
    points = points @ turn.T
    T[2, 3] = -floor_m
    T[:3] = turn @ T[:3]
    outline = _outline(points, top_m, walls_alone=not (levels.floored or levels.closed))
    room = ScannedRoom(outline, top_m)
    walls, ring = _walls(room), np.asarray(outline.exterior.coords)[:-1]
    openings = find_openings(points, walls, ring)
    boxes, left_out = boxes_in(points, room)
    boxes = (*boxes, *rugs_in(points, room))
    boxes = tuple(b for b in boxes if not any(is_part_of(b, o) for o in openings))
    notes = [*cloud.notes, "kinds of objects are guessed; correct them where they are wrong"]
    if not levels.floored:
        notes.append("no floor was scanned; it is where points begin")
    if not levels.closed:
        notes.append("no ceiling was scanned; walls end where points end")
    if left_out:
        notes.append(f"{left_out} smaller objects were left out")
    photos = tuple(p.move(T) for p in cloud.photos)
    return MeasuredRoom(walls, boxes, openings, floors=(MeasuredFloor(ring, 0.0),), notes=tuple(notes), photos=photos)


def _upright_axes(cloud: PointCloud) -> Float[np.ndarray, "3 3"]:
    """The rotation to +Z up: as the format says, or along the axis across which levels are densest."""
    up = likely_up(cloud.points) if cloud.up is None else cloud.up
    z = up / np.linalg.norm(up)
    x = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.9 else np.array([0.0, 0.0, 1.0])
    x = x - (x @ z) * z
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


def _thin(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "m 3"]:
    """One point for each occupied voxel, so that what was scanned from near does not outweigh the rest."""
    low, high = _spread(points, MAX_REACH_M)
    points = points[((points > low - 0.5) & (points < high + 0.5)).all(axis=1)]
    cells = np.floor((points - points.min(axis=0)) / VOXEL_M).astype(np.int64)
    counts = cells.max(axis=0) + 1
    keys = (cells[:, 0] * counts[1] + cells[:, 1]) * counts[2] + cells[:, 2]
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.append(True, np.diff(keys[order]) > 0))
    sums = np.add.reduceat(points[order], starts, axis=0)
    return sums / np.diff(np.append(starts, len(points)))[:, None]


def _spread(points: Float[np.ndarray, "n 3"], most_m: float) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """The least and the largest coordinates of all points but stray ones; an error where they are too far apart."""
    low, high = np.quantile(points, [0.001, 0.999], axis=0)
    if not (np.abs([low, high]) < FARTHEST_M).all():
        raise InputError("the points lie too far from the file's zero to be told apart; export them near it, in metres")
    if not (high - low < most_m).all():
        raise InputError(f"the points reach over more than {MAX_REACH_M:.0f} m; cut out one room, in metres")
    return low, high


@dataclass(frozen=True)
class _Levels:
    """Heights of the floor and of the room's top."""

    floor_m: float
    top_m: float
    floored: bool
    """Whether the floor was scanned."""
    closed: bool
    """Whether the top is a ceiling."""


def _levels(heights: Float[np.ndarray, "n"]) -> _Levels:
    low, high = float(heights.min()), float(heights.max())
    counts, edges = np.histogram(heights, np.arange(low, max(high, low + LEVEL_M) + 2 * LEVEL_M, LEVEL_M))
    smooth = np.convolve(counts, [1, 1, 1], "same")[: len(counts)]
    walls = float(np.median(smooth[smooth > 0]))  # are in every level
    strong = np.flatnonzero((smooth >= LEVEL_SHARE * smooth.max()) & (smooth > LEVEL_PEAK * walls))
    # A table is the lowest level where nobody scanned the floor: walls go on below it.
    floors = [b for b in strong[:1] if (heights < edges[b] - LEVEL_M).mean() < BEYOND_SHARE]
    floored, closed = bool(floors), False
    floor_m = (
        _median_near(heights, float(edges[floors[0]]), 2.5 * LEVEL_M) if floored else float(np.quantile(heights, 0.005))
    )
    top_m = float(np.quantile(heights, 0.999))
    for b in strong[-1:]:
        closed = bool(edges[b] > floor_m + LOWEST_ROOM_M and (heights > edges[b] + 2 * LEVEL_M).mean() < BEYOND_SHARE)
        top_m = _median_near(heights, float(edges[b]), 2.5 * LEVEL_M) if closed else top_m
    if top_m < floor_m + 0.5:
        raise InputError("there is no room in the points: nothing rises from their lowest level; check that up is up")
    return _Levels(floor_m, top_m, floored, closed)


def _median_near(values: Float[np.ndarray, "n"], near: float, within: float) -> float:
    return float(np.median(values[np.abs(values - near) <= within]))


def _heading(points: Float[np.ndarray, "n 3"], top_m: float) -> float:
    """The turn of the room's axes, modulo a quarter: where walls are sharpest."""
    plan = _band(points, top_m)[:, :2]

    def sharp(angle: float) -> float:
        turned = plan @ yaw_rotation(-angle)[:2, :2].T
        return sum(sharpness(turned[:, axis], LINE_M) for axis in (0, 1))

    coarse = max(np.radians(np.arange(0.0, 90.0, 1.0)), key=sharp)
    return float(max(coarse + np.radians(np.arange(-1.0, 1.01, 0.1)), key=sharp))


def _band(points: Float[np.ndarray, "n 3"], top_m: float) -> Float[np.ndarray, "m 3"]:
    """What is above furniture and below the ceiling."""
    inside = (points[:, 2] > min(FURNITURE_M, 0.4 * top_m)) & (points[:, 2] < top_m - OFF_M)
    return points[inside] if inside.sum() >= 200 else points


def _outline(points: Float[np.ndarray, "n 3"], top_m: float, *, walls_alone: bool) -> Polygon:
    """The room seen from above: cells between wall lines that were scanned.

    All cells are of the room where walls alone were scanned, without floor and ceiling.
    """
    lines = [_lines(points, top_m, axis) for axis in (0, 1)]
    plan = points[:, :2]
    cells = []
    for x0, x1 in zip(lines[0][:-1], lines[0][1:], strict=True):
        for y0, y1 in zip(lines[1][:-1], lines[1][1:], strict=True):
            inside = plan[((plan > [x0, y0]) & (plan < [x1, y1])).all(axis=1)]
            grid = np.unique(np.floor((inside - [x0, y0]) / SPAN_M).astype(int), axis=0)
            if walls_alone or len(grid) * SPAN_M**2 >= SCANNED_SHARE * (x1 - x0) * (y1 - y0):
                cells.append(box(x0, y0, x1, y1))
    largest = largest_polygon(unary_union(cells))
    if largest is None:
        low, high = np.quantile(plan, [0.005, 0.995], axis=0)
        return box(*low, *high)
    return Polygon(largest.exterior).simplify(0.01)


def _lines(points: Float[np.ndarray, "n 3"], top_m: float, axis: int) -> list[float]:
    """Coordinates of the walls across an axis, with the ends of what was scanned."""
    band = _band(points, top_m)
    low, high = (float(v) for v in np.quantile(points[:, axis], [0.003, 0.997]))
    base, other = min(FURNITURE_M, 0.4 * top_m), 1 - axis
    count = max(1, round((high - low + 2 * APART_M) / LINE_M))
    column = np.clip(((band[:, axis] - low + APART_M) / LINE_M).astype(int), 0, count - 1)
    along = ((band[:, other] - band[:, other].min()) / SPAN_M).astype(int)
    # Where next to nothing is above furniture, the band is all points, and begins below.
    level = np.maximum((band[:, 2] - base) / SPAN_M, 0.0).astype(int)
    filled = np.zeros((count, along.max() + 1, level.max() + 1), bool)
    filled[column, along, level] = True
    filled[1:] |= filled[:-1]  # a wall may lie on the border of two columns
    length = (filled.mean(axis=2) >= REACH_SHARE).sum(axis=1) * SPAN_M
    weighted: list[tuple[float, float]] = []
    for index in np.argsort(-length, kind="stable"):
        if length[index] < MIN_WALL_M:
            break
        near = float(low - APART_M + index * LINE_M)
        at = _median_near(band[:, axis], near, LINE_M) if (np.abs(band[:, axis] - near) <= LINE_M).any() else near
        if all(abs(at - other_at) > APART_M for other_at, _ in weighted):
            weighted.append((at, float(length[index])))
    lines = [at for at, _ in weighted]
    for end in (low, high):
        if all(abs(end - at) > 2 * APART_M for at in lines) and (not lines or not min(lines) < end < max(lines)):
            lines.append(end)
    return sorted(lines)


def _walls(room: ScannedRoom) -> tuple[MeasuredWall, ...]:
    ring = np.asarray(room.outline.exterior.coords)[:, :2]
    return tuple(
        MeasuredWall(f"wall_{number}", np.array([[*a, 0.0], [*b, 0.0], [*b, room.top_m], [*a, room.top_m]]))
        for number, (a, b) in enumerate(pairwise(ring), 1)
    )
