"""A room that was measured elsewhere, by a phone or in a point cloud: walls, openings and boxes of known kinds become
planes as they were measured and objects whose shapes fill the boxes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float
from shapely.geometry import Point, Polygon

from diorama_core.geometry.openings import STANDS_OUT_M, faces_behind, with_hole
from diorama_core.importing.measured_types import RESTS_M, MeasuredBox, MeasuredOpening, MeasuredRoom
from diorama_core.importing.opening import Names, Opened
from diorama_core.importing.storeys import (
    ceiling_planes,
    floor_planes,
    floors_below,
    inner_face,
    rooms_of_floors,
    storeys_of,
)
from diorama_core.library.kinds import is_possible
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import UNKNOWN, category
from diorama_core.retrieval.pools import RetrievalQuery, pool_for, size_cost
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Architecture, Candidate, Plane, Pose, Scene, SceneObject, Support

KEEP = 8
"""Candidates of an object."""
AT_WALL_M = 0.15
THINNEST_M = 0.005
"""Of a face of a wall: what has no thickness is no solid."""


def open_room(room: MeasuredRoom, library: ShapeLibrary) -> Opened:
    """The scene: planes exactly where they were measured, and in every box the shape that fits it best.

    A front that looks into a wall it touches is turned round. Boxes stand on the floor, on what is right below them, or
    hang on the wall that they touch.
    """
    storeys = storeys_of(room)
    walls = tuple(inner_face(w, storeys) for w in room.walls)
    walls = _half_as_thick_as_apart(walls)
    walls, unused = _with_passages(walls, room.openings)
    floors = floor_planes(storeys)
    ceilings, remarks = ceiling_planes(storeys, walls)
    planes = (*floors, *walls, *ceilings)
    below = floors_below(room.boxes, storeys)
    boxes = [
        _facing_the_room(_resting(b, storeys[k].height_m) if k is not None else b, walls)
        for b, k in zip(room.boxes, below, strict=True)
    ]
    names = Names()
    holders = [
        _holder(index, boxes, planes, floors[k] if k is not None and floors else None) for index, k in enumerate(below)
    ]
    objects = [_object(names, box, known_supports, library) for box, known_supports in zip(boxes, holders, strict=True)]
    ids = [o.id for o in objects]
    supports = [_support(ids, index, known_supports) for index, known_supports in enumerate(holders)]
    notes = [*room.notes, *remarks]
    seen: list[tuple[MeasuredOpening, Plane]] = []
    for opening in room.openings:
        wall = _wall_of(opening, walls)
        if wall is None or opening in unused:
            reason = "has no wall and was left out" if wall is None else "would leave nothing of its wall"
            notes.append(f"{opening.kind} of {opening.width_m:.2f} x {opening.height_m:.2f} m {reason}")
        if wall is None or opening.kind == "opening":
            continue
        if any(_is_other_side(opening, wall, *known, walls) for known in seen):
            continue
        seen.append((opening, wall))
        item = _hang(names, opening, wall, library)
        objects.append(item)
        supports.append(Support(item.id, wall.id, "mounted on", child_face="back"))
    known_supports = tuple(s for s in supports if s is not None)
    outlined = [s.name for s in storeys if s.outline is not None]
    names_of = dict(zip((f.id for f in floors), outlined, strict=True))
    scene = Scene(None, Architecture(planes), tuple(objects), known_supports, rooms=rooms_of_floors(floors, names_of))
    check_scene(scene)
    return Opened(scene, changes=tuple(notes))


def likeliest_kind(kinds: Mapping[str, float], size_m: Float[np.ndarray, "3"]) -> dict[str, float]:
    """How likely each kind is for a thing of this size; sums to 1."""
    log_size = np.log(np.maximum(size_m, 1e-3))
    likelihoods = {}
    for kind, share in kinds.items():
        modes = category(kind).priors
        off = [(log_size - p.log_median_xyz) / p.log_sigma_xyz for p in modes]
        fits = [float(np.exp(-0.5 * (o**2).sum()) / p.log_sigma_xyz.prod()) for o, p in zip(off, modes, strict=True)]
        likelihoods[kind] = share * max(max(fits), 1e-12)
    total = sum(likelihoods.values())
    return {kind: value / total for kind, value in likelihoods.items()}


def possible_kinds(kinds: Mapping[str, float], size_m: Float[np.ndarray, "3"]) -> dict[str, float]:
    """Those kinds that can be so large along every side."""
    return {kind: share for kind, share in kinds.items() if is_possible(kind, size_m)}


def _resting(box: MeasuredBox, floor_m: float) -> MeasuredBox:
    """A box whose bottom is about at the floor ends there."""
    gap = float(box.centre[2] - box.size_m[2] / 2) - floor_m
    if abs(gap) > RESTS_M or gap == 0.0 or gap + box.size_m[2] < RESTS_M:
        return box
    size, centre = box.size_m.copy(), box.centre.copy()
    size[2] += gap
    centre[2] -= gap / 2
    return replace(box, size_m=size, centre=centre)


def _facing_the_room(box: MeasuredBox, walls: Sequence[Plane]) -> MeasuredBox:
    """A front that looks into a wall right before it belongs on the other side, where nothing is."""
    gaps = {side: _gap(box, side * box.R_world_box[:, 0], walls) for side in (1.0, -1.0)}
    if gaps[1.0] < AT_WALL_M <= gaps[-1.0]:
        return replace(box, R_world_box=box.R_world_box @ np.diag([-1.0, -1.0, 1.0]))
    return box


def _gap(box: MeasuredBox, direction: Float[np.ndarray, "3"], walls: Sequence[Plane]) -> float:
    """From the face on that side to the wall that it is parallel to and looks at."""
    face = box.centre + direction * box.size_m[0] / 2
    gaps = [
        abs(float(w.normal @ face) - w.offset)
        for w in walls
        if w.normal @ direction < -0.94
        and _is_before_wall(w, face, box.size_m[1] / 2)
        and w.polygon[:, 2].min() < box.centre[2] < w.polygon[:, 2].max()
    ]
    return min(gaps, default=np.inf)


def _is_before_wall(wall: Plane, point: Float[np.ndarray, "3"], reach_m: float) -> bool:
    """True for a point before the wall rather than beyond its ends."""
    along = np.cross([0.0, 0.0, 1.0], wall.normal)
    span = wall.polygon @ along
    return bool(span.min() - reach_m < point @ along < span.max() + reach_m)


def _holder(index: int, boxes: Sequence[MeasuredBox], planes: Sequence[Plane], floor: Plane | None) -> str:
    """What holds a box up: the floor, the ceiling, a wall, or the number of another box."""
    box = boxes[index]
    low, high = (float(box.centre[2] + side * box.size_m[2] / 2) for side in (-1, 1))
    below = [(float(b.centre[2] + b.size_m[2] / 2), k) for k, b in enumerate(boxes) if k != index and b.is_under(box)]
    if below:
        return str(max(below)[1])
    if floor is not None and low - float(floor.centre[2]) < RESTS_M:
        return floor.id
    above = [p.id for p in planes if p.role == "ceiling" and abs(p.centre[2] - high) < RESTS_M and _covers(p, box)]
    if above:
        return above[0]
    near = [(_gap(box, -box.R_world_box[:, 0], [w]), w.id) for w in planes if w.role == "wall"]
    return min(near)[1] if near and min(near)[0] < AT_WALL_M else "nothing"


def _support(ids: Sequence[str], index: int, object_id: str) -> Support | None:
    if object_id == "nothing":
        return None
    if object_id.startswith("floor"):
        return Support(ids[index], object_id)
    if object_id.isdecimal():
        return Support(ids[index], ids[int(object_id)])
    return Support(ids[index], object_id, "mounted on", child_face="top" if object_id.startswith("ceiling") else "back")


def _mount(object_id: str) -> str:
    """Where kinds are found that are held so: a wall, the ceiling, or else the floor."""
    stands = object_id.startswith("floor") or object_id == "nothing" or object_id.isdecimal()
    return "floor" if stands else "ceiling" if object_id.startswith("ceiling") else "wall"


def _covers(plane: Plane, box: MeasuredBox) -> bool:
    return bool(Polygon(plane.polygon[:, :2]).buffer(RESTS_M).contains(Point(box.centre[:2])))


def _object(names: Names, box: MeasuredBox, object_id: str, library: ShapeLibrary) -> SceneObject:
    mount = _mount(object_id)
    held_so = ("floor", "surface") if mount == "floor" else (mount,)
    mounted = {k: v for k, v in box.kinds.items() if category(k).mount in held_so}
    possible = possible_kinds(mounted, box.size_m) or possible_kinds(box.kinds, box.size_m) or {UNKNOWN.name: 1.0}
    senses = dict(possible) if box.kinds_know_size else likeliest_kind(possible, box.size_m)
    kind = max(senses, key=lambda k: (senses[k], k))
    query = RetrievalQuery(kind, box.size_m, False, senses)
    scored = [
        (m.kind_factor * float(np.exp(-size_cost(m.shape.size_m, box.size_m))) * _fit(box, m.shape), m.shape)
        for m in pool_for(library, query).members
    ]
    ranked = sorted(scored, key=lambda row: (-row[0], row[1].id))
    item = _with_candidates(names, ranked[0][1].category, ranked, lambda shape: _filling(shape, box))
    return replace(item, label=box.label, confidence=box.confidence)


def _with_candidates(
    names: Names, category: str, ranked: Sequence[tuple[float, Shape]], pose: Callable[[Shape], Pose]
) -> SceneObject:
    """An object that the first of the shapes shows; the next ones may take its place."""
    candidates = tuple(Candidate(s.id, s.size_m, score, pose(s)) for score, s in ranked[:KEEP])
    best = candidates[0]
    return SceneObject(names.new(category), category, category, best.shape_id, best.shape_size_m, best.pose, candidates)


def _fit(box: MeasuredBox, shape: Shape) -> float:
    return box.fits.get(shape.id, min(box.fits.values(), default=1.0))


def _filling(shape: Shape, box: MeasuredBox) -> Pose:
    return Pose(box.R_world_box, box.centre, np.maximum(box.size_m, 1e-3) / np.array(shape.size_m))


def _wall_of(opening: MeasuredOpening, walls: Sequence[Plane]) -> Plane | None:
    named = next((w for w in walls if w.id == opening.wall), None)
    if named is not None or not walls:
        return named
    near = [
        (abs(float(w.normal @ opening.centre) - w.offset), w.id, w)
        for w in walls
        if _is_before_wall(w, opening.centre, 0.0)
    ]
    return min(near)[2] if near and min(near)[0] < AT_WALL_M else None


def _half_as_thick_as_apart(walls: Sequence[Plane]) -> tuple[Plane, ...]:
    """Walls of which both faces were measured: each face has the half of what is between them."""

    def halve(wall: Plane) -> Plane:
        low, high = wall.polygon.min(axis=0), wall.polygon.max(axis=0)
        points = [low + share * (high - low) for share in (0.25, 0.5, 0.75)]
        gaps = [wall.offset - float(wall.normal @ f.centre) for p in points for f in faces_behind(wall, p, walls)]
        return replace(wall, thickness=max(min(gaps) / 2, THINNEST_M)) if gaps else wall

    return tuple(halve(w) for w in walls)


def _is_other_side(
    opening: MeasuredOpening, wall: Plane, known: MeasuredOpening, known_wall: Plane, walls: Sequence[Plane]
) -> bool:
    """Whether a door or window is known from the other face of its wall."""
    apart = float(np.cross([0.0, 0.0, 1.0], wall.normal) @ (opening.centre - known.centre))
    behind = faces_behind(wall, opening.centre, walls)
    return opening.kind == known.kind and any(f is known_wall for f in behind) and abs(apart) < opening.width_m / 2


def _with_passages(
    walls: tuple[Plane, ...], openings: Sequence[MeasuredOpening]
) -> tuple[tuple[Plane, ...], list[MeasuredOpening]]:
    """The walls with the openings that have neither a door nor a window, and those for which a wall is too small."""
    cut, unused = {w.id: w for w in walls}, []
    for opening in openings:
        wall = _wall_of(opening, walls)
        if opening.kind != "opening" or wall is None:
            continue
        side = np.cross([0.0, 0.0, 1.0], wall.normal) * opening.width_m / 2
        up = np.array([0.0, 0.0, opening.height_m / 2])
        corners = opening.centre + np.array([a * side + b * up for a in (-1, 1) for b in (-1, 1)])
        if with_hole(cut[wall.id], corners) is cut[wall.id]:
            unused.append(opening)
        for face in (wall, *faces_behind(wall, opening.centre, walls)):
            cut[face.id] = with_hole(cut[face.id], corners)
    return tuple(cut.values()), unused


def _hang(names: Names, opening: MeasuredOpening, wall: Plane, library: ShapeLibrary) -> SceneObject:
    """A door or a window with its back at the wall."""
    yaw = float(np.arctan2(wall.normal[1], wall.normal[0]))
    on_wall = opening.centre - (wall.normal @ opening.centre - wall.offset) * wall.normal
    shapes = library.in_category(opening.kind)
    size = np.array([STANDS_OUT_M, opening.width_m, opening.height_m])
    ranked = [
        (float(np.exp(-size_cost(s.size_m[1:], size[1:]))), s)
        for s in sorted(shapes, key=lambda s: (size_cost(s.size_m[1:], size[1:]), s.id))
    ]
    centre = on_wall + wall.normal * STANDS_OUT_M / 2
    return _with_candidates(names, opening.kind, ranked, lambda s: Pose.upright(centre, yaw, size / np.array(s.size_m)))
