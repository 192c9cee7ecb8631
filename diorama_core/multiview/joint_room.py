"""One room from what several photos say of its walls.

Walls that several photos see become one line, where they agree. The lines divide the plan into cells; a cell is in the
room when photos look into it rather than find it behind a wall (labelling of an arrangement of walls, as Ochmann et al.
2016 do for point clouds). The outline of those cells is the floor; its edges are walls as far as photos saw one there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import manifold3d
import numpy as np
from jaxtyping import Bool, Float

from diorama_core.architecture.texture.colours import visible_planes
from diorama_core.architecture.walls.closed_room import GUESS_CONFIDENCE
from diorama_core.architecture.walls.openings import WallOpening, with_openings
from diorama_core.architecture.walls.passages import with_passages
from diorama_core.architecture.walls.wall_sequence import WallPiece
from diorama_core.artefacts import DetectedObject
from diorama_core.geometry.planes import clip_polygon, is_in_polygon, signed_area
from diorama_core.scene.types import Architecture, Camera, Plane

SAME_COSINE = float(np.cos(np.radians(8.0)))


@dataclass(frozen=True)
class JointRoomSettings:
    """When walls of several photos are one wall."""

    same_m: float = 0.25
    same_share: float = 0.08
    """Walls nearer to one another than this, plus this share of their distance from the farther camera, are one."""
    grid_m: float = 0.1
    range_m: float = 2.5
    """Over about this distance a photo says less and less of where its floor ends."""
    shadow: float = 1.0
    """What a photo says against places that a wall hides from it, beside what it says for those that it looks into."""
    behind: float = 0.35
    """Weight of what the wall says against all places behind its line."""
    beside_view: float = 0.15
    """Weight of the floor that a photo only assumes, beside what it looks into."""
    unknown: float = -0.02
    standing: float = 4.0
    """Where objects stand and cameras are is the room."""
    around_m: float = 0.2
    min_edge_m: float = 0.05
    view_step: int = 8
    """Every so many pixels it is looked whether a photo shows the ceiling."""
    min_covered: float = 0.25
    """Share of an edge along which photos see a wall, for it to be a wall that was seen."""


SETTINGS = JointRoomSettings()


@dataclass(frozen=True, eq=False)
class SeenRoom:
    """What one photo says of the room, in the room's frame."""

    architecture: Architecture
    camera: Camera
    objects: tuple[DetectedObject, ...] = ()


@dataclass(frozen=True, eq=False)
class _Line:
    """A wall's line in plan: `normal . p = offset`, the room before it."""

    normal: Float[np.ndarray, "2"]
    offset: float
    walls: tuple[Plane, ...]


def joint_room(photos: Sequence[SeenRoom], standing: Sequence[Float[np.ndarray, "_ 2"]]) -> Architecture:
    """Floor, walls and ceiling of all photos; the first photo's where no photo sees a wall.

    Args:
        photos: at least one.
        standing: footprints of the objects on the floor.
    """
    lines, floor = _lines(photos), photos[0].architecture.floor
    outline = None if not lines or floor is None else _outline(photos, lines, standing)
    if outline is None or floor is None:
        return photos[0].architecture
    top_m = _top(photos)
    level = float(floor.polygon[:, 2].mean())
    base = np.column_stack([outline, np.full(len(outline), level)])
    planes = [replace(floor, polygon=base)]
    for start, end in pairwise([*outline, outline[0]]):
        wall = _wall(start, end, lines, level, top_m)
        if wall is not None:
            planes.append(replace(wall, id=f"wall_{len(planes)}"))
    ceilings = (c for p in photos for c in p.architecture.by_role("ceiling"))
    ceiling = max(ceilings, key=lambda c: c.confidence, default=None)
    if ceiling is not None:
        lid = np.column_stack([outline[::-1], np.full(len(outline), top_m)])
        planes.append(replace(ceiling, id="ceiling", polygon=lid))
    return Architecture(tuple(planes))


def with_open_doorways(
    room: Architecture, photos: Sequence[SeenRoom]
) -> tuple[Architecture, tuple[tuple[str, ...], ...]]:
    """The room with the open doorways that any photo points at, and for each photo the ids of its marks of them.

    Args:
        room: walls whose polygons begin with their feet, from left to right.
        photos: with what is marked in them.
    """
    walls = room.by_role("wall")
    pieces = tuple(WallPiece(w.polygon[0, :2], w.polygon[1, :2], None) for w in walls)
    top_m = max((float(w.polygon[:, 2].max()) for w in walls), default=0.0)
    openings: tuple[tuple[WallOpening, ...], ...] = ((),) * len(walls)
    marks = []
    for photo in photos:
        openings, ids = with_passages(openings, photo.objects, pieces, photo.camera, top_m)
        marks.append(ids)
    cut = {w.id: replace(w, polygon=with_openings(w.polygon, o)) for w, o in zip(walls, openings, strict=True) if o}
    return Architecture(tuple(cut.get(p.id, p) for p in room.planes)), tuple(marks)


def _top(photos: Sequence[SeenRoom]) -> float:
    """Height of the room: as the photos say that see much of a ceiling, else the middle of all walls' tops."""
    levels, weights = [], []
    for photo in photos:
        planes = photo.architecture.planes
        seen = visible_planes(planes, photo.camera, SETTINGS.view_step)
        for index, plane in enumerate(planes):
            if plane.role == "ceiling":
                levels.append(float(plane.polygon[:, 2].mean()))
                weights.append(float((seen == index).mean()))
    if sum(weights) > 0:
        return _weighted_median(np.array(levels), np.array(weights))
    return float(np.median([w.polygon[:, 2].max() for p in photos for w in p.architecture.by_role("wall")]))


def _lines(photos: Sequence[SeenRoom]) -> tuple[_Line, ...]:
    """The seen walls of all photos, those that agree as one line, the surest first."""
    weighted: list[tuple[Plane, float, float]] = []
    for photo in photos:
        for wall in photo.architecture.by_role("wall"):
            if wall.is_seen:
                away = abs(float(photo.camera.position @ wall.normal) - wall.offset)
                weight = wall.confidence * _length(wall) / max(away, 0.5)
                weighted.append((wall, weight, away))
    left = sorted(weighted, key=lambda row: -row[1])
    lines = []
    while left:
        wall, _, away = left[0]
        same = [r for r in left if _agree(wall, r[0], max(away, r[2]))]
        left = [r for r in left if not any(r is s for s in same)]
        weights = np.array([w for _, w, _ in same])
        normal = (weights[:, None] * [r[0].normal[:2] for r in same]).sum(axis=0)
        normal /= np.linalg.norm(normal)
        offsets = np.array([float(normal @ r[0].centre[:2]) for r in same])
        lines.append(_Line(normal, _weighted_median(offsets, weights), tuple(r[0] for r in same)))
    return tuple(lines)


def _agree(a: Plane, b: Plane, away_m: float) -> bool:
    """Whether two walls are pieces of one: in one line, and side by side no farther apart than a door."""
    if float(a.normal @ b.normal) < SAME_COSINE:
        return False
    apart = abs(float(a.normal @ b.centre) - a.offset)
    return apart < SETTINGS.same_m + SETTINGS.same_share * away_m


def _weighted_median(values: Float[np.ndarray, "n"], weights: Float[np.ndarray, "n"]) -> float:
    order = np.argsort(values)
    share = np.cumsum(weights[order]) / weights.sum()
    return float(values[order][np.searchsorted(share, 0.5)])


def _length(wall: Plane) -> float:
    return float(np.ptp(wall.polygon @ np.cross([0.0, 0.0, 1.0], wall.normal)))


def _outline(
    photos: Sequence[SeenRoom], lines: Sequence[_Line], standing: Sequence[Float[np.ndarray, "_ 2"]]
) -> Float[np.ndarray, "n 2"] | None:
    """The outline of the cells in the room, counter-clockwise."""
    floors = [f.polygon[:, :2] for p in photos if (f := p.architecture.floor) is not None]
    low, high = np.min([f.min(axis=0) for f in floors], axis=0), np.max([f.max(axis=0) for f in floors], axis=0)
    corners = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
    cells = [np.column_stack([corners, np.zeros(4)])]
    for line in lines:
        normal = np.array([*line.normal, 0.0])
        halves = [clip_polygon(c, s * normal, s * line.offset) for c in cells for s in (1.0, -1.0)]
        cells = [h for h in halves if len(h) >= 3 and abs(signed_area(h[:, :2])) > SETTINGS.grid_m**2]
    xs, ys = (np.arange(low[k], high[k], SETTINGS.grid_m) + SETTINGS.grid_m / 2 for k in (0, 1))
    grid = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    says = _evidence(grid, photos, lines, standing)
    inside = [c[:, :2] for c in cells if (here := is_in_polygon(grid, c[:, :2])).any() and says[here].sum() > 0]
    if not inside:
        return None
    turned = (c if signed_area(c) > 0 else c[::-1] for c in inside)
    sections = [manifold3d.CrossSection([c], manifold3d.FillRule.NonZero).offset(1e-4) for c in turned]
    union = manifold3d.CrossSection.batch_boolean(sections, manifold3d.OpType.Add).simplify(1e-2)
    outlines = [o for o in union.to_polygons() if signed_area(o) > 0]
    eyes = np.array([p.camera.position[:2] for p in photos])
    best = max(outlines, key=lambda o: (int(is_in_polygon(eyes, o).sum()), abs(signed_area(o))))
    return np.asarray(best, dtype=np.float64)


def _evidence(
    grid: Float[np.ndarray, "n 2"],
    photos: Sequence[SeenRoom],
    lines: Sequence[_Line],
    standing: Sequence[Float[np.ndarray, "_ 2"]],
) -> Float[np.ndarray, "n"]:
    """What speaks for each place being in the room, and against it."""
    says = np.full(len(grid), SETTINGS.unknown)
    placed = {id(w): line for line in lines for w in line.walls}
    for photo in photos:
        floor = photo.architecture.floor
        if floor is None:
            continue
        within, seen = is_in_polygon(grid, floor.polygon[:, :2]), _are_in_view(grid, photo.camera)
        near = np.exp(-np.linalg.norm(grid - photo.camera.position[:2], axis=1) / SETTINGS.range_m)
        says += np.where(within, np.where(seen, near, SETTINGS.beside_view * near), 0.0)
        for wall in photo.architecture.by_role("wall"):
            if wall.is_seen:
                line = placed[id(wall)]
                behind = grid @ line.normal < line.offset
                hidden = behind & seen & _are_behind_piece(grid, photo.camera, wall)
                says -= wall.confidence * (SETTINGS.shadow * hidden + SETTINGS.behind * behind)
    for footprint in standing:
        says[is_in_polygon(grid, footprint)] += SETTINGS.standing
    for photo in photos:
        says[np.linalg.norm(grid - photo.camera.position[:2], axis=1) < SETTINGS.around_m] += SETTINGS.standing
    return says


def _are_behind_piece(grid: Float[np.ndarray, "n 2"], camera: Camera, wall: Plane) -> Bool[np.ndarray, "n"]:
    """True for places in the directions of a wall."""
    eye, along = camera.position[:2], np.cross([0.0, 0.0, 1.0], wall.normal)[:2]
    reach = wall.polygon[:, :2] @ along
    away = (grid - eye) @ wall.normal[:2]
    height = wall.offset - float(eye @ wall.normal[:2])
    met = eye @ along + ((grid - eye) @ along) * height / np.where(np.abs(away) < 1e-6, 1e-6, away)
    return np.asarray((met > reach.min()) & (met < reach.max()))


def _are_in_view(grid: Float[np.ndarray, "n 2"], camera: Camera) -> Bool[np.ndarray, "n"]:
    """True for places of the plan between the left and the right side of the picture."""
    k = camera.intrinsics
    ahead = camera.T_world_camera[:2, 2] / max(float(np.linalg.norm(camera.T_world_camera[:2, 2])), 1e-9)
    right = np.array([ahead[1], -ahead[0]])
    away = grid - camera.position[:2]
    forward, aside = away @ ahead, away @ right
    return (forward > 0) & (aside > -forward * k.cx / k.fx) & (aside < forward * (k.width - k.cx) / k.fx)


def _wall(
    start: Float[np.ndarray, "2"], end: Float[np.ndarray, "2"], lines: Sequence[_Line], level_m: float, top_m: float
) -> Plane | None:
    """The wall over an edge of the floor; None where no line of walls runs there."""
    length = float(np.linalg.norm(end - start))
    if length < SETTINGS.min_edge_m:
        return None
    along = (end - start) / length
    normal = np.array([-along[1], along[0]])  # the outline runs counter-clockwise: the room is to its left
    for line in lines:
        off_line = abs(float(line.normal @ (start + end)) / 2 - line.offset)
        if float(normal @ line.normal) < SAME_COSINE or off_line > SETTINGS.grid_m:
            continue
        # Seen from the room, a wall's foot from left to right runs against the outline.
        polygon = np.array([[*end, level_m], [*start, level_m], [*start, top_m], [*end, top_m]])
        count = max(2, round(length / SETTINGS.grid_m))
        seen, at, covering = np.zeros(count, dtype=bool), (np.arange(count) + 0.5) / count * length, []
        for wall in line.walls:
            reach = (wall.polygon[:, :2] - start) @ along
            if min(reach.max(), length) > max(reach.min(), 0.0):
                covering.append(wall)
                seen |= (at > reach.min()) & (at < reach.max())
        model = max(covering or line.walls, key=lambda w: w.confidence)
        sure = model.confidence if seen.mean() >= SETTINGS.min_covered else GUESS_CONFIDENCE
        return replace(model, polygon=polygon, confidence=sure)
    return None
