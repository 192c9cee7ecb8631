"""Bookcases, and other furniture with several places, whose boards are where their loads were seen.

No retrieved bookcase has its boards at the heights of the one in the picture, and what stands on them would go up or
down with them. Shelves are adjustable: as long as no gap between two boards changes too much, a shape takes its boards
to the feet of what was observed on them (`library.boards`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations_with_replacement
from math import comb

import numpy as np
from jaxtyping import Float, Int
from scipy.optimize import lsq_linear

from diorama_core.arrangement.surfaces import is_soft
from diorama_core.layout.sight import nearness
from diorama_core.library import taxonomy
from diorama_core.library.boards import BOARD_SHARE, MAX_SLOPE, MIN_SLOPE, levels_m, with_boards, without_boards
from diorama_core.library.record import BUILT_IN, Shape, ShapeLibrary
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.types import Camera, Scene, SceneObject

AGREES_M = 0.01
"""Loads whose feet are nearer to a board than this stand on it already."""
ONE_BOARD_M = 0.06
"""Feet at heights that differ by less stand on one board."""
BELOW_TOP_M = 0.05
"""What was observed so little below the top, or above it, stands on the top."""
MAX_WAYS = 500
"""So many ways to assign feet to boards are looked through; with more, boards stay."""
WORTH = 0.7
"""Boards are moved where that leaves less than this share of the distance between feet and boards."""
KEEP = 0.05
"""Weight of a board's place in the retrieved shape, against the foot of what stands on it."""
FIXED = 1e3
"""Weight of the shape's height, which stays."""
_SLACK_M = 1e-3


@dataclass(frozen=True)
class _Feet:
    """What stands on one board."""

    height_m: float
    """Above the supporter's middle, in its own frame at scale 1."""
    count: int


def fitted_boards(scene: Scene, library: ShapeLibrary, *, reasoned: bool) -> tuple[Scene, tuple[str, ...]]:
    """The scene with the boards of its furniture where their loads were seen, and what was changed.

    Args:
        scene: as observed, before any layout, with its support graph.
        library: where shapes come from.
        reasoned: whether distances were reasoned from a photo alone: what is seen on a bookcase is then taken to be as
            far away as the bookcase.
    """
    reasons = []
    for item in scene.objects:
        wanted = None if item.locked else fitted_shape(scene, item, library, reasoned=reasoned)
        if wanted is not None:
            objects = tuple(replace(o, shape_id=wanted) if o.id == item.id else o for o in scene.objects)
            scene = replace(scene, objects=objects)
            reasons.append(f"shape changed: the boards of {item.label} are where its loads were seen")
    return scene, tuple(reasons)


def fitted_shape(scene: Scene, item: SceneObject, library: ShapeLibrary, *, reasoned: bool) -> str | None:
    """The shape of an object with its boards where its loads were seen; None where it is as good as it is.

    Args:
        scene: as observed, before any layout, with its support graph.
        item: one of its objects, maybe in another shape.
        library: where shapes come from.
        reasoned: whether distances were reasoned from a photo alone.
    """
    shape = library.shape(item.shape_id)
    if not is_adjustable(item, shape):
        return None
    return _adjusted(shape, _feet(scene, item, scene.camera if reasoned else None), float(item.pose.scale[2]))


def is_adjustable(item: SceneObject, shape: Shape) -> bool:
    """Whether an object has places of which some can be at other heights: shelves, a desk below its hutch, no seats.

    Its library must derive such shapes.
    """
    derived = without_boards(shape.id) != shape.id
    kind = taxonomy.resolve(item.category).category
    adjustable = kind.supports_objects and kind.seat_height_m is None and kind.mount in ("floor", "wall")
    return adjustable and shape.source == BUILT_IN and not derived and len(levels_m(shape)) > 1


def _feet(scene: Scene, item: SceneObject, camera: Camera | None) -> tuple[_Feet, ...]:
    """What was observed inside an upright object, board by board from the lowest up."""
    if float(item.pose.R_world_object[:, 2] @ UP_WORLD) < 0.98:
        return ()
    heights = []
    for edge in scene.supports:
        if edge.parent != item.id or edge.relation != "placed on" or is_soft(load := scene.object(edge.child)):
            continue
        foot = float(load.corners_world[:, 2].min())
        if camera is not None:
            front, eye = item.pose.R_world_object[:, 0], camera.position
            factor = nearness(eye, front, item.pose.position, load.pose.position)
            foot = float(eye[2]) + factor * (foot - float(eye[2]))
        heights.append((foot - float(item.pose.position[2])) / float(item.pose.scale[2]))
    top = item.shape_size_m[2] / 2 - BELOW_TOP_M / float(item.pose.scale[2])
    groups: list[list[float]] = []
    for height in sorted(h for h in heights if -item.shape_size_m[2] / 2 - ONE_BOARD_M < h < top):
        if groups and height - groups[-1][0] < ONE_BOARD_M / float(item.pose.scale[2]):
            groups[-1].append(height)
        else:
            groups.append([height])
    return tuple(_Feet(float(np.median(g)), len(g)) for g in groups)


def _adjusted(shape: Shape, feet: Sequence[_Feet], scale: float) -> str | None:
    """The shape with its boards as near to all feet as they can be; None where that is hardly nearer than before."""
    levels = levels_m(shape)
    wanted = np.array([f.height_m for f in feet])
    counts = np.array([f.count for f in feet], dtype=np.float64)
    before = float(counts @ np.abs(wanted[:, None] - np.array(levels)).min(axis=1)) * scale if len(feet) else 0.0
    # The top stays.
    inside = len(levels) - 1
    if before <= AGREES_M * counts.sum() or comb(inside + len(feet) - 1, len(feet)) > MAX_WAYS:
        return None
    least, most = _free_lengths(shape, levels)
    if (least >= most).any():  # boards that lie on one another
        return None
    found: list[tuple[float, str]] = []
    for boards in combinations_with_replacement(range(inside), len(feet)):
        heights = _reaching(shape, levels, np.array(boards), wanted, counts)
        missed = float(counts @ np.abs(heights[list(boards)] - wanted)) * scale
        moved = with_boards(shape, heights)
        if moved is not None and missed < WORTH * before:
            found.append((missed + KEEP * scale * float(np.abs(heights - levels).sum()), moved))
    return min(found)[1] if found else None


def _reaching(
    shape: Shape,
    levels: Sequence[float],
    boards: Int[np.ndarray, " f"],
    wanted: Float[np.ndarray, " f"],
    counts: Float[np.ndarray, " f"],
) -> Float[np.ndarray, " k"]:
    """Heights of all levels with some of them as near to wanted ones as the free lengths between boards allow."""
    half, board = shape.size_m[2] / 2, BOARD_SHARE * shape.size_m[2]
    tops = np.array([*levels[:-1], half])
    free = _between(shape, levels)
    steps = np.tril(np.ones((len(tops), len(tops))))
    kept = (np.arange(len(tops)) + 1) * board - half
    rows = [
        np.sqrt(counts)[:, None] * steps[boards],
        KEEP * np.eye(len(tops)),
        FIXED * steps[-1:],
    ]
    sought = [np.sqrt(counts) * (wanted - kept[boards]), KEEP * free, FIXED * np.array([half - kept[-1]])]
    lengths = lsq_linear(np.vstack(rows), np.concatenate(sought), _free_lengths(shape, levels)).x
    return np.concatenate([(kept + steps @ lengths)[:-1], levels[-1:]])


def _between(shape: Shape, levels: Sequence[float]) -> Float[np.ndarray, " k"]:
    """Free lengths from the foot to the lowest board and from board to board, metres."""
    half, board = shape.size_m[2] / 2, BOARD_SHARE * shape.size_m[2]
    return np.diff(np.array([-half, *levels[:-1], half])) - board


def _free_lengths(shape: Shape, levels: Sequence[float]) -> tuple[Float[np.ndarray, " k"], Float[np.ndarray, " k"]]:
    """The least and most that they may become."""
    free = _between(shape, levels)
    return MIN_SLOPE * free + _SLACK_M, MAX_SLOPE * free - _SLACK_M
