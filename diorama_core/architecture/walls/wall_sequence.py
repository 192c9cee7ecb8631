"""From walls seen in some order to a closed outline: corners, hidden connections, ends beyond the picture.

All in plan: x and y of the world, seen from above. Headings are measured from +Y, growing to the right.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from diorama_core.architecture.walls.settings import SETTINGS, WallSettings
from diorama_core.architecture.walls.surface import MeasuredSurface
from diorama_core.architecture.walls.wall_candidates import WallCandidate
from diorama_core.architecture.walls.wall_path import Run, heading, wall_runs

CORNER_SLACK_RAD = np.deg2rad(5.0)
ALIKE_COSINE = float(np.cos(np.deg2rad(25.0)))
GAP_RAD = np.deg2rad(7.0)
"""Wider unknown stretches of the view are closed behind everything measured there."""


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


def outline(
    surface: MeasuredSurface,
    walls: list[WallCandidate],
    view: tuple[float, float],
    top_m: float,
    settings: WallSettings,
) -> tuple[WallPiece, ...]:
    """The walls as a chain of pieces that meet, from the left to the right end of the view.

    Args:
        surface: The measured points.
        walls: Candidates that may be walls.
        view: Headings of the picture's left and right side.
        top_m: Height at which walls end.
    """
    origin = surface.camera_position[:2]
    runs = wall_runs(surface, walls, view, top_m)
    if not runs:
        return ()
    return chain_runs(
        _merge_runs(_fill_gaps(_merge_runs(runs, origin, settings), surface, view), origin, settings),
        view,
        origin,
        settings,
    )


def chain_runs(
    runs: list[Run], view: tuple[float, float], origin: Float[np.ndarray, "2"], settings: WallSettings = SETTINGS
) -> tuple[WallPiece, ...]:
    """Runs as pieces that meet.

    Args:
        runs: At least one, from left to right.
        view: Headings of the picture's left and right side.
        origin: The camera, in plan.
    """
    pieces: list[WallPiece] = []
    start = _beyond_view(runs[0], view[0], origin, left=True, settings=settings)
    for run, following in pairwise(runs):
        end, hidden, restart = _joint(run, following, origin, settings)
        pieces.append(WallPiece(start, end, run.wall))
        pieces += hidden
        start = restart
    pieces.append(
        WallPiece(start, _beyond_view(runs[-1], view[1], origin, left=False, settings=settings), runs[-1].wall)
    )
    return tuple(p for p in pieces if p.length_m > 0.02)


def _merge_runs(runs: list[Run], origin: Float[np.ndarray, "2"], settings: WallSettings) -> list[Run]:
    """Neighbouring runs of what is about the same wall become one, whatever was unknown between them."""
    out: list[Run] = []
    for run in runs:
        if out and _are_same_wall(out[-1], run, origin, settings):
            larger = max(out[-1].wall, run.wall, key=lambda w: w.area_m2)
            out[-1] = Run(larger, out[-1].first, run.last)
        else:
            out.append(run)
    return out


def _collinear(a: WallCandidate, b: WallCandidate, settings: WallSettings) -> bool:
    return bool(a.normal @ b.normal > np.cos(np.deg2rad(3.0)) and abs(a.offset - b.offset) < settings.collinear_m)


def _are_same_wall(a: Run, b: Run, origin: Float[np.ndarray, "2"], settings: WallSettings) -> bool:
    """True for two on one line, or if the smaller one lies close along the larger, as noise and assumed walls do."""
    if _collinear(a.wall, b.wall, settings):
        return True
    minor, major = sorted((a, b), key=lambda run: run.wall.area_m2)
    if minor.wall.normal @ major.wall.normal < ALIKE_COSINE:
        return False
    ends = [point_at(minor.wall, h, origin, settings) for h in (minor.first, minor.last)]
    apart = [abs(float(e @ major.wall.normal) - major.wall.offset) if e is not None else np.inf for e in ends]
    return max(apart) < settings.alike_m + settings.alike_per_m * _range(minor, origin, settings)


def _fill_gaps(runs: list[Run], surface: MeasuredSurface, view: tuple[float, float]) -> list[Run]:
    """The runs with assumed walls put where no wall leads: behind what is measured there."""
    origin = surface.camera_position[:2]
    headings = heading(surface.points[:, :2], origin)
    ends = [view[0], *(h for run in runs for h in (run.first, run.last)), view[1]]
    out: list[Run] = []
    for number in range(len(runs) + 1):
        first, last = ends[2 * number], ends[2 * number + 1]
        seen = (headings >= first) & (headings <= last) & (surface.points[:, 2] > 0.1)
        if last - first > GAP_RAD and seen.sum() >= 50:
            out.append(Run(_assume_wall(surface.points[seen, :2], 0.5 * (first + last)), first, last))
        out += runs[number : number + 1]
    return out


def _assume_wall(points: Float[np.ndarray, "n 2"], toward: float) -> WallCandidate:
    """A wall square to the room axis nearest to a heading, behind nearly all of the points."""
    quarter = round(toward / (np.pi / 2)) * (np.pi / 2)
    normal = -np.round([np.sin(quarter), np.cos(quarter)])
    offset = float(np.quantile(points @ normal, 0.02))
    return WallCandidate(normal, offset, np.zeros(0, dtype=bool), 0.8, 0.0)


def meeting_point(a: WallCandidate, b: WallCandidate) -> Float[np.ndarray, "2"] | None:
    """Where two walls' lines cross; none when they are nearly parallel."""
    system = np.stack([a.normal, b.normal])
    if abs(np.linalg.det(system)) < 0.17:
        return None
    return np.linalg.solve(system, np.array([a.offset, b.offset]))


def point_at(
    wall: WallCandidate, toward: float, origin: Float[np.ndarray, "2"], settings: WallSettings
) -> Float[np.ndarray, "2"] | None:
    """The point of a wall's line in a heading; none where the line is not met in front.

    Args:
        wall: its line is taken, in the plan.
        toward: heading in radians, from +y toward +x.
        origin: where the heading is taken, x and y in the world (m).
        settings: how far a wall may be.
    """
    direction = np.array([np.sin(toward), np.cos(toward)])
    slope = float(direction @ wall.normal)
    if abs(slope) < 0.02:
        return None
    distance = (wall.offset - float(origin @ wall.normal)) / slope
    return origin + distance * direction if 0 < distance < settings.max_range_m else None


def _joint(
    a: Run, b: Run, origin: Float[np.ndarray, "2"], settings: WallSettings
) -> tuple[Float[np.ndarray, "2"], list[WallPiece], Float[np.ndarray, "2"]]:
    """How run a hands over to run b: a shared corner, or hidden pieces between the nearer and the farther wall."""
    corner = meeting_point(a.wall, b.wall)
    if corner is not None and np.linalg.norm(corner - origin) < settings.max_range_m:
        at = float(heading(corner, origin))
        between = a.last - CORNER_SLACK_RAD <= at <= b.first + CORNER_SLACK_RAD
        if between:
            return corner, [], corner
    end = point_at(a.wall, a.last, origin, settings)
    start = point_at(b.wall, b.first, origin, settings)
    if end is None or start is None:
        fallback = corner if corner is not None else _nearest_on(a.wall, origin)
        return fallback, [], fallback
    if np.linalg.norm(end - origin) < np.linalg.norm(start - origin):
        hidden = _find_hidden_path(a.wall, end, b.wall, start, origin, behind_right=False, settings=settings)
        return end, _pieces(hidden), hidden[-1]
    hidden = _find_hidden_path(b.wall, start, a.wall, end, origin, behind_right=True, settings=settings)
    return hidden[-1], _pieces(hidden[::-1]), start


def _pieces(path: list[Float[np.ndarray, "2"]]) -> list[WallPiece]:
    return [WallPiece(p, q, None) for p, q in pairwise(path)]


def _nearest_on(wall: WallCandidate, origin: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    return origin + (wall.offset - float(origin @ wall.normal)) * wall.normal


def _find_hidden_path(
    near: WallCandidate,
    edge: Float[np.ndarray, "2"],
    far: WallCandidate,
    seen: Float[np.ndarray, "2"],
    origin: Float[np.ndarray, "2"],
    *,
    behind_right: bool,
    settings: WallSettings,
) -> list[Float[np.ndarray, "2"]]:
    """From the nearer wall's edge to the farther wall, out of sight: square corners where they stay hidden.

    Args:
        near: The nearer wall and
        edge: where it ends;
        far: the farther wall and
        seen: where it comes into view.
        origin: The camera.
        behind_right: Whether the nearer wall hides what is to the right of its edge.
    """
    sight = float(heading(edge, origin))
    slope = float(-near.normal @ far.normal)
    if abs(slope) > 0.17:
        distance = (far.offset - float(edge @ far.normal)) / slope
        square = edge - distance * near.normal
        if 0 < distance < settings.max_hidden_m and _is_hidden(square, origin, sight, behind_right):
            return [edge, square]
    inward = float((seen - edge) @ -near.normal)
    corner = edge - inward * near.normal
    if inward > 0 and _is_hidden(corner, origin, sight, behind_right):
        return [edge, corner, seen]
    return [edge, seen]


def _is_hidden(point: Float[np.ndarray, "2"], origin: Float[np.ndarray, "2"], sight: float, right: bool) -> bool:
    turn = float(heading(point, origin)) - sight
    return turn > -0.01 if right else turn < 0.01


def _beyond_view(
    run: Run, side: float, origin: Float[np.ndarray, "2"], *, left: bool, settings: WallSettings
) -> Float[np.ndarray, "2"]:
    """Where the first or last wall ends: behind the camera, a little outside the picture, or where it was last seen."""
    outward = -run.wall.direction if left else run.wall.direction
    if outward[1] < -0.7:
        y = origin[1] - settings.behind_camera_m
        return np.array([(run.wall.offset - run.wall.normal[1] * y) / run.wall.normal[0], y])
    seen = run.first if left else run.last
    at_side = point_at(run.wall, side, origin, settings)
    if at_side is None or np.linalg.norm(at_side - origin) > 2.5 * _range(run, origin, settings):
        at_side = point_at(run.wall, seen, origin, settings)
    if at_side is None:
        nearest = _nearest_on(run.wall, origin)
        away = float(np.linalg.norm(nearest - origin))
        at_side = nearest + np.sqrt(max(settings.max_range_m**2 - away**2, 0.0)) * outward
    return at_side + settings.beyond_view_m * outward


def _range(run: Run, origin: Float[np.ndarray, "2"], settings: WallSettings) -> float:
    """Distance of the farther end of what is seen of a run."""
    ends = [point_at(run.wall, h, origin, settings) for h in (run.first, run.last)]
    return max((float(np.linalg.norm(e - origin)) for e in ends if e is not None), default=settings.max_range_m)
