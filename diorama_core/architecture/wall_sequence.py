"""From walls seen in some order to a closed outline: corners, hidden connections, ends beyond the picture.

All in plan: x and y of the world, seen from above. Headings are measured from +Y, growing to the right.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int

from diorama_core.architecture.wall_candidates import MeasuredSurface, WallCandidate

HEADING_BINS = 180
MIN_RUN_SHARE = 0.025
"""A wall that leads in fewer headings than this share of the view is dropped."""
CORNER_SLACK_RAD = np.deg2rad(5.0)
MAX_HIDDEN_M = 3.0
BEYOND_VIEW_M = 0.3
MAX_RANGE_M = 12.0


@dataclass(frozen=True)
class WallPiece:
    """One straight piece of the outline, from left to right as seen from the room."""

    start: Float[np.ndarray, "2"]
    end: Float[np.ndarray, "2"]
    candidate: WallCandidate | None
    """The measured wall; none where the piece only closes a gap."""

    @property
    def length_m(self) -> float:
        """From start to end."""
        return float(np.linalg.norm(self.end - self.start))


@dataclass(frozen=True)
class _Run:
    wall: WallCandidate
    first: float
    last: float


def heading(point: Float[np.ndarray, "*n 2"], origin: Float[np.ndarray, "2"]) -> Float[np.ndarray, "*n"]:
    """Heading of points seen from `origin`, from +Y to the right, radians."""
    offset = np.asarray(point) - origin
    return np.arctan2(offset[..., 0], offset[..., 1])


def outline(surface: MeasuredSurface, walls: list[WallCandidate], view: tuple[float, float]) -> tuple[WallPiece, ...]:
    """The walls as a chain of pieces that meet, from the left to the right end of the view.

    Args:
        surface: The measured points.
        walls: Candidates that may be walls.
        view: Headings of the picture's left and right side.
    """
    origin = surface.camera_position[:2]
    runs = _runs(surface, walls, view)
    if not runs:
        return ()
    pieces: list[WallPiece] = []
    start = _beyond_view(runs[0], view[0], origin, left=True)
    for run, following in pairwise(runs):
        end, hidden, restart = _joint(run, following, origin)
        pieces.append(WallPiece(start, end, run.wall))
        pieces += hidden
        start = restart
    pieces.append(WallPiece(start, _beyond_view(runs[-1], view[1], origin, left=False), runs[-1].wall))
    return tuple(p for p in pieces if p.length_m > 0.02)


def _runs(surface: MeasuredSurface, walls: list[WallCandidate], view: tuple[float, float]) -> list[_Run]:
    """Which wall leads in each heading, as runs from left to right; short runs give way to their neighbours."""
    if not walls:
        return []
    origin = surface.camera_position[:2]
    headings = heading(surface.points[:, :2], origin)
    width = (view[1] - view[0]) / HEADING_BINS
    index = ((headings - view[0]) / width).astype(int).clip(0, HEADING_BINS - 1)
    votes = np.array([np.bincount(index[w.inliers], minlength=HEADING_BINS) for w in walls])
    labels = np.where(votes.max(axis=0) >= 3, votes.argmax(axis=0), -1)
    labels = _without_short_runs(labels, max(2, round(MIN_RUN_SHARE * HEADING_BINS)))
    runs: list[_Run] = []
    for first, last, label in _spans(labels):
        if label >= 0:
            runs.append(_Run(walls[label], view[0] + first * width, view[0] + last * width))
    return _merged(runs)


def _spans(labels: Int[np.ndarray, "m"]) -> list[tuple[int, int, int]]:
    """(first, one past last, label) of each stretch of equal labels."""
    breaks = [0, *(np.flatnonzero(np.diff(labels)) + 1).tolist(), len(labels)]
    return [(a, b, int(labels[a])) for a, b in pairwise(breaks)]


def _without_short_runs(labels: Int[np.ndarray, "m"], least: int) -> Int[np.ndarray, "m"]:
    """Labels whose total length is below `least`, or stretches below a third of it, become unknown."""
    out = labels.copy()
    for label in set(labels.tolist()) - {-1}:
        if (labels == label).sum() < least:
            out[labels == label] = -1
    for first, last, label in _spans(out):
        if label >= 0 and last - first < max(2, least // 2):
            out[first:last] = -1
    return out


def _merged(runs: list[_Run]) -> list[_Run]:
    """Neighbouring runs of the same wall become one, whatever was unknown between them."""
    out: list[_Run] = []
    for run in runs:
        if out and out[-1].wall is run.wall:
            out[-1] = _Run(run.wall, out[-1].first, run.last)
        else:
            out.append(run)
    return out


def meeting_point(a: WallCandidate, b: WallCandidate) -> Float[np.ndarray, "2"] | None:
    """Where two walls' lines cross; none when they are nearly parallel."""
    system = np.stack([a.normal, b.normal])
    if abs(np.linalg.det(system)) < 0.17:
        return None
    return np.linalg.solve(system, np.array([a.offset, b.offset]))


def point_at(wall: WallCandidate, toward: float, origin: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"] | None:
    """The point of a wall's line in a heading; none where the line is not met in front."""
    direction = np.array([np.sin(toward), np.cos(toward)])
    slope = float(direction @ wall.normal)
    if abs(slope) < 0.02:
        return None
    distance = (wall.offset - float(origin @ wall.normal)) / slope
    return origin + distance * direction if 0 < distance < MAX_RANGE_M else None


def _joint(
    a: _Run, b: _Run, origin: Float[np.ndarray, "2"]
) -> tuple[Float[np.ndarray, "2"], list[WallPiece], Float[np.ndarray, "2"]]:
    """How run a hands over to run b: a shared corner, or a hidden piece between the nearer and the farther wall."""
    corner = meeting_point(a.wall, b.wall)
    if corner is not None and np.linalg.norm(corner - origin) < MAX_RANGE_M:
        at = float(heading(corner, origin))
        between = a.last - CORNER_SLACK_RAD <= at <= b.first + CORNER_SLACK_RAD
        if between:
            return corner, [], corner
    end = point_at(a.wall, a.last, origin)
    start = point_at(b.wall, b.first, origin)
    if end is None or start is None:
        fallback = corner if corner is not None else _nearest_on(a.wall, origin)
        return fallback, [], fallback
    nearer_is_a = np.linalg.norm(end - origin) < np.linalg.norm(start - origin)
    if nearer_is_a:
        start = _behind(a.wall, end, b.wall, start)
    else:
        end = _behind(b.wall, start, a.wall, end)
    return end, [WallPiece(end, start, None)], start


def _nearest_on(wall: WallCandidate, origin: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    return origin + (wall.offset - float(origin @ wall.normal)) * wall.normal


def _behind(
    near: WallCandidate, edge: Float[np.ndarray, "2"], far: WallCandidate, seen: Float[np.ndarray, "2"]
) -> Float[np.ndarray, "2"]:
    """Where the farther wall begins when the nearer one turns square away from the room at its edge."""
    slope = float(-near.normal @ far.normal)
    if abs(slope) < 0.17:
        return seen
    distance = (far.offset - float(edge @ far.normal)) / slope
    return edge - distance * near.normal if 0 < distance < MAX_HIDDEN_M else seen


def _beyond_view(run: _Run, side: float, origin: Float[np.ndarray, "2"], *, left: bool) -> Float[np.ndarray, "2"]:
    """Where the first or last wall ends: a little outside the picture, or where it was last seen."""
    outward = -run.wall.along if left else run.wall.along
    seen = run.first if left else run.last
    at_side = point_at(run.wall, side, origin)
    if at_side is None or np.linalg.norm(at_side - origin) > 2.5 * _range(run, origin):
        at_side = point_at(run.wall, seen, origin)
    if at_side is None:
        at_side = _nearest_on(run.wall, origin)
    return at_side + BEYOND_VIEW_M * outward


def _range(run: _Run, origin: Float[np.ndarray, "2"]) -> float:
    """Distance of the farther end of what is seen of a run."""
    ends = [point_at(run.wall, h, origin) for h in (run.first, run.last)]
    return max((float(np.linalg.norm(e - origin)) for e in ends if e is not None), default=MAX_RANGE_M)
