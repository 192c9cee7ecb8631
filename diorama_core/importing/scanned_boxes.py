"""Boxes around what stands, lies and hangs in a scanned room, each with its back at the wall that it stands at.

A rug is thinner than what `measure_cloud` leaves to the floor: it is a place that is a little higher, level, and
rectangular, seen where a scan is finer than it is thick. Furniture on it hides a part, so that its rectangle need not
be full, but no bare floor may be inside.

Furniture is apart from what lies on it. A board is a level that much of a thing's outline fills and above which little
is. What is above it lies on it, unless it reaches from one side to the other, as backs of chairs and heads of beds do.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import ndimage
from scipy.spatial import cKDTree
from shapely.geometry import Polygon, box

from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.importing.measured_types import MeasuredBox, MeasuredOpening
from diorama_core.library.taxonomy import CARRIED_KINDS, CATEGORIES, RUGS, UNKNOWN
from diorama_core.scene.types import yaw_rotation

OFF_M = 0.06
"""Points nearer to floor, ceiling or walls are theirs."""
CELL_M = 0.06
"""Things are apart where so much is free between them."""
SPARSE = 2.0
"""As many distances between points must be free in a thin scan."""
MIN_SIZE_M, MIN_CELLS = 0.15, 12
MIN_TOP_M = 0.12
"""Share of what lies on something."""
STANDS_M = 0.35
"""So far above the floor thin legs may go unseen."""
TABLE_M, BOARD_M, MIN_BOARD_M = (0.35, 1.1), 0.12, 0.4
"""Heights of boards that stand on legs, how thick they are at most, and the least shorter side."""
SQUARE_RAD = float(np.radians(10.0))
WALL_SHARE = 0.85
"""Share of the room's height: what is thinner than `OFF_M` and reaches so high is a wall."""
LOWEST_LAMP_SHARE = 0.5
"""Share of the room's height, below which nothing reaches that hangs from the ceiling."""
HANGS_CLEAR_M = 0.15
FURNITURE_M = 1.0
"""What begins above it, away from walls and ceiling, stands on nothing: it is a part of something unseen."""
PART_M = 0.15
"""Limits of a door or window: what is deeper, or larger than it by more, is before it."""
MAX_BOXES = 200
AT_WALL_M = 0.4
GUESS = 0.4
"""Confidence in a kind that no word tells."""
UNLIKELY = (UNKNOWN.name, *OPENING_CATEGORIES, "curtain", "rug")
MAX_DEVIATION = 1.4826
"""Standard deviations in a median absolute deviation of normal noise."""
TOP_CELL_M = 0.05
MIN_BOARD = 0.6
"""Share of the outline that a board fills."""
MAX_ABOVE = 0.45
"""Share of the outline that may be filled at any height above it."""
MIN_HEIGHT_M = 0.25
"""Height of a board above the object's foot; lower ones are rugs, plinths and pedals."""
MIN_ABOVE_M = 0.08
REACHES_ALONG, REACHES_ACROSS = 0.78, 0.9
"""Shares of the longer side, and of the shorter one unless about square, at which a part belongs to the object."""
SQUARE = 0.75


@dataclass(frozen=True, eq=False)
class ScannedRoom:
    """The room's shell, its axes along x and y."""

    outline: Polygon
    top_m: float


def boxes_in(points: Float[np.ndarray, "n 3"], room: ScannedRoom) -> tuple[tuple[MeasuredBox, ...], int]:
    """Boxes of what stands in the room, the largest first, and how many more there are."""
    import shapely

    inner = room.outline.buffer(-OFF_M)
    inside = shapely.contains_xy(inner, points[:, 0], points[:, 1])
    inside &= (points[:, 2] > OFF_M) & (points[:, 2] < room.top_m - OFF_M)
    left = points[inside]
    if not len(left):
        return (), 0
    cells, grid = _cells(left, max(CELL_M, SPARSE * _spacing(left)))
    grid[tuple(cells.T)] = True
    labels, count = ndimage.label(grid, np.ones((3, 3, 3)))
    which = labels[tuple(cells.T)]
    sizes = ndimage.sum_labels(grid, labels, np.arange(1, count + 1))
    boxes = []
    for number in np.argsort(-sizes, kind="stable"):
        points_of_box = left[which == number + 1]
        if sizes[number] < MIN_CELLS or _middle_extent(points_of_box) < MIN_SIZE_M:
            continue
        thing, *on_it = apart_from_tops(points_of_box)
        around = _box(thing, room)
        if _is_wall(around, room):
            continue
        boxes.append(around)
        boxes += [replace(_box(top, room), kinds=_kinds("surface")) for top in on_it if _is_thing(top)]
    return tuple(boxes[:MAX_BOXES]), max(0, len(boxes) - MAX_BOXES)


def rugs_in(points: Float[np.ndarray, "n 3"], room: ScannedRoom) -> tuple[MeasuredBox, ...]:
    """Boxes of rugs on the floor."""
    import shapely

    inside = points[shapely.contains_xy(room.outline.buffer(-OFF_M), points[:, 0], points[:, 1])]
    return tuple(replace(_box(rug, room), kinds=dict.fromkeys(sorted(RUGS), 1.0)) for rug in find_rugs(inside))


def _cells(points: Float[np.ndarray, "n d"], side_m: float) -> tuple[Int[np.ndarray, "n d"], Bool[np.ndarray, "..."]]:
    """The cell of each point, and an empty grid of all cells."""
    cells = np.floor((points - points.min(axis=0)) / side_m).astype(int)
    return cells, np.zeros(cells.max(axis=0) + 1, bool)


def _spacing(points: Float[np.ndarray, "n 3"]) -> float:
    """Usual distance from a point to the next one."""
    if len(points) < 2:
        return 0.0
    asked = points[:: max(1, len(points) // 2000)]
    distances, _ = cKDTree(points).query(asked, k=[2])
    return float(np.median(distances))


def _middle_extent(points: Float[np.ndarray, "n 3"]) -> float:
    return float(np.sort(np.ptp(points, axis=0))[1])


def _is_wall(box: MeasuredBox, room: ScannedRoom) -> bool:
    """Whether a box is around a piece of a wall that stands elsewhere than where walls were found."""
    return bool(box.size_m[:2].min() < OFF_M and box.size_m[2] > WALL_SHARE * room.top_m)


def is_part_of(box: MeasuredBox, opening: MeasuredOpening) -> bool:
    """Whether a box is around a handle, a sill or a frame."""
    off = np.abs(box.centre - opening.centre)
    within = np.hypot(*off[:2]) < opening.width_m / 2 and off[2] < opening.height_m / 2
    smaller = box.size_m[:2].max() < opening.width_m + PART_M and box.size_m[2] < opening.height_m + PART_M
    return bool(within and smaller and box.size_m[:2].min() < PART_M)


def _is_clear_of_walls(points: Float[np.ndarray, "n 3"], room: ScannedRoom) -> bool:
    """Whether no wall is near enough to hold a thing: cords and rods of lamps are too thin to be scanned."""
    around = box(*points[:, :2].min(axis=0), *points[:, :2].max(axis=0))
    return bool(room.outline.exterior.distance(around) > HANGS_CLEAR_M)


def _is_board(points: Float[np.ndarray, "n 3"], room: ScannedRoom) -> bool:
    """Whether points are a level board at a table's height, away from walls: its legs are too thin to be seen."""
    x, y, thickness = np.ptp(points, axis=0)
    at_height = TABLE_M[0] < float(points[:, 2].min()) < TABLE_M[1]
    return bool(at_height and thickness < BOARD_M and min(x, y) > MIN_BOARD_M and _is_clear_of_walls(points, room))


def _is_thing(points: Float[np.ndarray, "n 3"]) -> bool:
    """Whether what lies on something is large enough, and no few points of a larger thing's edge."""
    return len(points) >= 2 * MIN_CELLS and _middle_extent(points) >= MIN_TOP_M


def _box(points: Float[np.ndarray, "n 3"], room: ScannedRoom) -> MeasuredBox:
    """The upright box around a thing, its back at the wall that it stands at."""
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    hangs = low > LOWEST_LAMP_SHARE * room.top_m and _is_clear_of_walls(points, room)
    stands = low < STANDS_M or _is_board(points, room)
    floats = not hangs and low > FURNITURE_M and _is_clear_of_walls(points, room)
    low, high = 0.0 if stands else low, room.top_m if hangs else high
    plan = points[:, :2]
    (cx, cy), (a, b), degrees = cv2.minAreaRect(plan.astype(np.float32))
    turn = np.radians(degrees)
    quarter = np.pi / 2
    off = (turn + quarter / 2) % quarter - quarter / 2
    if abs(off) < SQUARE_RAD or min(a, b) > 0.8 * max(a, b):
        lower, upper = plan.min(axis=0), plan.max(axis=0)
        (cx, cy), (a, b), turn = (lower + upper) / 2, upper - lower, 0.0
    best = max(range(4), key=lambda k: _likely_front(np.array([cx, cy]), turn + k * quarter, (a, b)[k % 2], room))
    depth, width = (a, b) if best % 2 == 0 else (b, a)
    size = np.maximum(np.array([depth, width, high - low]), 0.02)
    return MeasuredBox(
        "object",
        {UNKNOWN.name: 1.0} if floats else _kinds("ceiling" if hangs else "floor"),
        yaw_rotation(turn + best * quarter),
        np.array([cx, cy, (low + high) / 2]),
        size,
        confidence=GUESS,
        points=points,
    )


def _likely_front(centre: Float[np.ndarray, "2"], yaw: float, depth_m: float, room: ScannedRoom) -> tuple[bool, float]:
    """How likely a thing faces that way: its back at a wall; else its longer side in front."""
    import shapely

    back = centre - (depth_m / 2 + AT_WALL_M) * np.array([np.cos(yaw), np.sin(yaw)])
    at_wall = not shapely.contains_xy(room.outline, *back)
    return bool(at_wall), -depth_m


def _kinds(where: Literal["floor", "surface", "ceiling"]) -> dict[str, float]:
    """Everything that stands or hangs in rooms, lies on furniture, or hangs from the ceiling; sizes decide."""
    mounts = ("floor", "wall") if where == "floor" else (where,)
    also = CARRIED_KINDS if where == "surface" else frozenset[str]()
    return {c.name: 1.0 for c in CATEGORIES if c.name not in UNLIKELY and (c.mount in mounts or c.name in also)}


@dataclass(frozen=True)
class RugSettings:
    """Finds the rug in points whose floor is at 0."""

    min_height_m: float = 0.007
    sigmas: float = 4.0
    """Multiple of the floor's noise that a rug is higher."""
    unlevel: float = 0.3
    """Deviation of a rug's heights, as a share of its height: a floor that bends rises little by little."""
    max_height_m: float = 0.06
    standing_m: float = 0.3
    """What has points between the height of a rug and this one stands there, and hides the rug."""
    cell_m: float = 0.1
    reach: int = 2
    """Cells by which pieces of one rug grow before they meet: what stands on it hides so much."""
    min_side_m: float = 0.5
    min_points: int = 40
    max_floor: float = 0.08
    """Share of floor among the low points inside its rectangle."""


SETTINGS = RugSettings()


def find_rugs(points: Float[np.ndarray, "n 3"]) -> list[Float[np.ndarray, "_ 3"]]:
    """Points of each rug, the largest first, among those of a room away from its walls, its floor at 0."""
    low = _free(points)
    below = low[low[:, 2] <= 0, 2]
    if len(below) < SETTINGS.min_points:
        return []
    noise_m = MAX_DEVIATION * float(np.median(-below))  # half of the floor's noise is below it
    raised = low[:, 2] > max(SETTINGS.min_height_m, SETTINGS.sigmas * noise_m)
    rugs = [p for p in _pieces(low, raised) if _is_rug(p, low[~raised], noise_m)]
    return sorted(rugs, key=len, reverse=True)


def _free(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "m 3"]:
    """Points at the floor where nothing stands."""
    points = points[points[:, 2] < SETTINGS.standing_m]
    if not len(points):
        return points
    cells, grid = _cells(points[:, :2], SETTINGS.cell_m)
    low = points[:, 2] < SETTINGS.max_height_m
    grid[tuple(cells[~low].T)] = True
    return points[low & ~grid[tuple(cells.T)]]


def _pieces(low: Float[np.ndarray, "n 3"], raised: Bool[np.ndarray, " n"]) -> Iterator[Float[np.ndarray, "_ 3"]]:
    """Raised points in groups that are apart from each other."""
    cells, grid = _cells(low[:, :2], SETTINGS.cell_m)
    grid[tuple(cells[raised].T)] = True
    grown = ndimage.binary_dilation(grid, np.ones((3, 3), bool), iterations=SETTINGS.reach)
    labels, count = ndimage.label(grown)
    which = np.where(raised, labels[tuple(cells.T)], 0)
    for number in range(count):
        piece = low[which == number + 1]
        level = float(np.median(piece[:, 2]))
        yield piece[np.abs(piece[:, 2] - level) < level / 2]  # without what stands on it


def _is_rug(piece: Float[np.ndarray, "n 3"], floor: Float[np.ndarray, "m 3"], noise_m: float) -> bool:
    if len(piece) < SETTINGS.min_points:
        return False
    height = float(np.median(piece[:, 2]))
    rectangle = cv2.minAreaRect(piece[:, :2].astype(np.float32))
    if min(rectangle[1]) < SETTINGS.min_side_m or piece[:, 2].std() > max(SETTINGS.unlevel * height, 1.5 * noise_m):
        return False
    corners = cv2.boxPoints(rectangle)
    near = floor[((floor[:, :2] > corners.min(axis=0)) & (floor[:, :2] < corners.max(axis=0))).all(axis=1), :2]
    inside = sum(cv2.pointPolygonTest(corners, (float(x), float(y)), False) > 0 for x, y in near)
    return inside <= SETTINGS.max_floor * (inside + len(piece))


def apart_from_tops(points: Float[np.ndarray, "n 3"]) -> list[Float[np.ndarray, "_ 3"]]:
    """The points of a thing, and those of each thing that lies on it; all of them together where nothing does."""
    cells, grid = _cells(points, TOP_CELL_M)
    grid[tuple(cells.T)] = True
    board = _board(grid)
    if board is None or np.ptp(points[:, 2]) - (board + 1) * TOP_CELL_M < MIN_ABOVE_M:
        return [points]
    above = grid.copy()
    above[:, :, : board + 2] = False
    labels, count = ndimage.label(above, np.ones((3, 3, 3)))
    if not count or any(_reaches(labels == k + 1) for k in range(count)):
        return [points]
    which = labels[tuple(cells.T)]
    return [points[which == 0], *(points[which == k + 1] for k in range(count))]


def _board(grid: Bool[np.ndarray, "x y z"]) -> int | None:
    """The highest level that fills much of the outline, all levels above it filling little."""
    area = grid.any(axis=2).sum()
    # A board may lie on the border of two levels, and its edge hides what is right below.
    level = np.array([grid[:, :, k : k + 2].any(axis=2).sum() for k in range(grid.shape[2])]) / max(area, 1)
    boards = np.flatnonzero(level >= MIN_BOARD)
    if not len(boards) or boards[-1] * TOP_CELL_M < MIN_HEIGHT_M:
        return None
    board = int(boards[-1])
    return board if (level[board + 3 :] <= MAX_ABOVE).all() else None


def _reaches(part: Bool[np.ndarray, "x y z"]) -> bool:
    """Whether a part goes from one side of the thing nearly to the other."""
    sides = part.shape[:2]
    for axes, side in zip(((1, 2), (0, 2)), sides, strict=True):
        share = (np.ptp(np.flatnonzero(part.any(axis=axes))) + 1) / side
        if share >= (REACHES_ALONG if side >= SQUARE * max(sides) else REACHES_ACROSS):
            return True
    return False
