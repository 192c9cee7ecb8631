"""How far a scene is what a text asked for, and a sound room: the measures of SceneEval (Tam et al. 2025).

Fidelity: counts, attributes, relations between objects and to the room. Plausibility: support, collision, navigability,
accessibility, out of bounds. Shares of 0 to 1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.arrangement.surfaces import overhang_m
from diorama_core.editing.collisions import WALKED_ON_M, Collisions
from diorama_core.editing.footprints import footprint_of, footprints, lie_within
from diorama_core.editing.placing import places_of
from diorama_core.editing.relations import OF_ROOM, Relation, RelationKind, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.library.taxonomy import broad, category, with_kin
from diorama_core.scene.types import Scene, SceneObject
from diorama_core.text.looks import has_look, look_of

CELL_M = 0.05
PERSON_M = 0.2
"""Half of a person's width."""
BEFORE_M = 0.5
"""Floor before an object that people need to use it."""
CONTACT_M = 0.015
OUTSIDE_M = 0.05
ROW_OFF_M, ROW_GAP_M, ROW_TURNED_RAD = 0.08, 1.0, 0.1
"""Limits for objects in a row: how far from its line, how far apart, how far turned from one another at most."""


@dataclass(frozen=True)
class Asked:
    """What a person wrote down that a prompt asks for."""

    prompt: str
    counts: Mapping[str, int]
    looks: Mapping[str, tuple[str, ...]]
    relations: tuple[tuple[str, RelationKind, tuple[str, ...]], ...]
    """Category, relation, categories of its targets (none for relations to the room)."""
    rows: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    """By category in how many rows of how many they stand."""


@dataclass(frozen=True)
class TextScene:
    """The measures of one scene; counts of what is met of what was asked."""

    counts: tuple[int, int]
    looks: tuple[int, int]
    object_relations: tuple[int, int]
    room_relations: tuple[int, int]
    supported: tuple[int, int]
    colliding: tuple[int, int]
    outside: tuple[int, int]
    navigable: float
    accessible: float
    failures: tuple[str, ...] = ()
    """What is not met, in words."""

    @property
    def all_met(self) -> bool:
        """Whether everything that was asked for is there as asked."""
        pairs = (self.counts, self.looks, self.object_relations, self.room_relations)
        return all(met == asked for met, asked in pairs)


def measure(asked: Asked, scene: Scene, library: ShapeLibrary) -> TextScene:
    """Compare a scene with what was asked for."""
    frame = RoomFrame.of(scene)
    failures: list[str] = []
    present = {name: len(_members(scene, name)) for name in asked.counts}
    missed = {name: number for name, number in asked.counts.items() if present[name] != number}
    failures += [f"{present[name]} of {number} {name}" for name, number in missed.items()]
    looks = _looks(asked, scene, library, failures)
    objects, room = _relations(asked, scene, frame, failures)
    standing = [o for o in scene.objects if o.category not in OPENING_CATEGORIES]
    supported = sum(_is_supported(scene, library, o) for o in standing)
    hit = {i for pair in Collisions(library).pairs(scene, [o.id for o in standing]) for i in pair}
    beyond = [o for o in standing if not lie_within(footprint_of(o)[None], frame.outline, OUTSIDE_M)[0]]
    failures += [f"{o.label} collides" for o in standing if o.id in hit]
    failures += [f"{o.label} is outside" for o in beyond]
    access = list(access_shares(scene, frame).values())
    return TextScene(
        counts=(len(present) - len(missed), len(present)),
        looks=looks,
        object_relations=objects,
        room_relations=room,
        supported=(supported, len(standing)),
        colliding=(sum(o.id in hit for o in standing), len(standing)),
        outside=(len(beyond), len(standing)),
        navigable=_navigable(_free_floor(scene, frame)),
        accessible=float(np.mean(access)) if access else 1.0,
        failures=tuple(failures),
    )


def _members(scene: Scene, name: str) -> list[SceneObject]:
    """Objects of a category; special kinds of it count where there is none of itself."""
    of_category = [o for o in scene.objects if o.category == name]
    return of_category or [o for o in scene.objects if o.category in with_kin(name)]


def _looks(asked: Asked, scene: Scene, library: ShapeLibrary, failures: list[str]) -> tuple[int, int]:
    def good(name: str, word: str) -> bool:
        named, look = _members(scene, name), look_of(word)
        return bool(named) and all(
            has_look(record_of(library, o.shape_id), word) or (look is not None and o.colour == look.colour)
            for o in named
        )

    pairs = [(name, word) for name, words in asked.looks.items() for word in words]
    wrong = [f"{name} is not {word}" for name, word in pairs if not good(name, word)]
    failures += wrong
    return len(pairs) - len(wrong), len(pairs)


def _relations(
    asked: Asked, scene: Scene, frame: RoomFrame, failures: list[str]
) -> tuple[tuple[int, int], tuple[int, int]]:
    """Relations met of those asked for, between objects and to the room with its windows and doors."""
    between, to_room = [0, 0], [0, 0]
    for name, kind, targets in asked.relations:
        number = asked.counts.get(name, 1)
        met = sum(_holds(scene, o, kind, targets, frame) for o in _members(scene, name))
        good = met >= number
        tally = to_room if kind in OF_ROOM or set(targets) <= set(OPENING_CATEGORIES) else between
        tally[0] += good
        tally[1] += 1
        if not good:
            failures.append(f"{name} {kind} {' and '.join(targets)}: {met} of {number}")
    for name, (rows, each) in asked.rows.items():
        good = are_in_rows(_members(scene, name), rows, each)
        between[0] += good
        between[1] += 1
        if not good:
            failures.append(f"{name} not in {rows} x {each}")
    return (between[0], between[1]), (to_room[0], to_room[1])


def are_in_rows(items: Sequence[SceneObject], rows: int, each: int) -> bool:
    """Whether objects stand in rows: parallel, as many in each, evenly side by side, the rows clear of one another."""
    if len(items) != rows * each:
        return False
    first = items[0].pose
    turned = np.array([item.pose.yaw_rad - first.yaw_rad for item in items])
    if np.abs(np.sin(turned)).max() > np.sin(ROW_TURNED_RAD):
        return False
    local = np.array([(item.pose.position - first.position) @ first.R_world_object for item in items])
    order = np.argsort(local[:, 0], kind="stable")
    depths, asides = local[order, 0].reshape(rows, each), np.sort(local[order, 1].reshape(rows, each), axis=1)
    straight = np.ptp(depths, axis=1).max() <= ROW_OFF_M
    apart = rows == 1 or np.diff(depths.mean(axis=1)).min() >= float(items[0].size_m[0])
    pitch = np.diff(asides, axis=1)
    even = each == 1 or (np.ptp(pitch) <= 2 * ROW_OFF_M and pitch.max() <= float(items[0].size_m[1]) + ROW_GAP_M)
    return bool(straight and apart and even)


def _holds(scene: Scene, item: SceneObject, kind: RelationKind, targets: Sequence[str], frame: RoomFrame) -> bool:
    if kind in OF_ROOM:
        return is_met(scene, item.id, Relation(kind), frame)
    options = [[o.id for o in _members(scene, t) if o.id != item.id] for t in targets]
    if kind == "between":
        firsts, seconds = options[0], options[-1]
        return any(is_met(scene, item.id, Relation(kind, (a, b)), frame) for a in firsts for b in seconds if a != b)
    return any(is_met(scene, item.id, Relation(kind, (t,)), frame) for t in options[0])


def _is_supported(scene: Scene, library: ShapeLibrary, item: SceneObject) -> bool:
    """Whether an object touches what is said to hold it up."""
    edge = scene.support_of(item.id)
    if edge is None:
        return False
    corners = item.corners_world
    for place in places_of(scene, library, (item.id,)):
        if place.parent != edge.parent:
            continue
        surface = place.surface
        reach = corners @ surface.normal - surface.level
        touches = abs(float(reach.min())) < CONTACT_M
        foot = item.pose.position - (float(surface.normal @ item.pose.position) - surface.level) * surface.normal
        if touches and overhang_m(surface, foot) <= 0.02:
            return True
    return False


def _stands(item: SceneObject) -> bool:
    return bool(category(item.category).mount in ("floor", "surface") and item.size_m[2] >= WALKED_ON_M)


def _free_floor(scene: Scene, frame: RoomFrame) -> Bool[np.ndarray, "h w"]:
    """Cells of the floor where nothing stands that a person would run into."""
    grid = _raster(frame, [frame.outline])
    low = [o for o in scene.objects if _stands(o) and float(o.corners_world[:, 2].min()) < 1.0]
    return np.asarray((grid > 0) & (_raster(frame, [footprint_of(o) for o in low]) == 0))


def _raster(frame: RoomFrame, outlines: Sequence[np.ndarray]) -> UInt8[np.ndarray, "h w"]:
    origin = frame.outline.min(axis=0)
    width, height = (int(np.ceil(e / CELL_M)) + 1 for e in np.ptp(frame.outline, axis=0))
    grid = np.zeros((height, width), np.uint8)
    for outline in outlines:
        cv2.fillPoly(grid, [np.round((outline - origin) / CELL_M).astype(np.int32)], 1)
    return grid


def _navigable(free: Bool[np.ndarray, "h w"]) -> float:
    """Share of the free floor, narrowed by a person's width, that is one connected whole."""
    size = 2 * round(PERSON_M / CELL_M) + 1
    walkable = cv2.erode(free.astype(np.uint8), cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size)))
    count, labels = cv2.connectedComponents(walkable)
    if count < 2:
        return 0.0
    sizes = np.bincount(labels.ravel())[1:]
    return float(sizes.max() / sizes.sum())


def access_shares(scene: Scene, frame: RoomFrame) -> Mapping[str, float]:
    """Share of free floor before the front of each piece of furniture; of round things, before their freest side."""
    shares: dict[str, float] = {}
    floor = [o for o in scene.objects if _stands(o) and category(o.category).mount == "floor"]
    for item in floor:
        edge = scene.support_of(item.id)
        if edge is None or (scene.has_object(edge.parent) and broad(scene.object(edge.parent).category) != "rug"):
            continue
        others = _raster(frame, [footprint_of(o) for o in floor if o.id != item.id and not _is_tucked(o, item)])
        free = (_raster(frame, [frame.outline]) > 0) & (others == 0)
        sides = (0.0,) if broad(item.category) not in ("plant", "floor lamp", "table", "coffee table", "bed") else (
            0.0, np.pi / 2, np.pi, -np.pi / 2
        )  # fmt: skip
        shares[item.id] = max(_free_share(frame, item, turn, free) for turn in sides)
    return shares


def _is_tucked(seat: SceneObject, host: SceneObject) -> bool:
    """Whether a seat belongs at a table: it does not bar the way to it, nor the table to the seat."""
    seats, tables = ("chair", "office chair", "stool", "bench"), ("table", "desk", "kitchen counter", "piano")
    pair = {broad(seat.category), broad(host.category)}
    return bool(pair & set(seats)) and bool(pair & set(tables))


def _free_share(frame: RoomFrame, item: SceneObject, turn: float, free: Bool[np.ndarray, "h w"]) -> float:
    yaw = item.pose.yaw_rad + turn
    depth, width = (item.size_m[0], item.size_m[1]) if abs(np.cos(turn)) > 0.5 else (item.size_m[1], item.size_m[0])
    place = item.pose.position[:2] + np.array([np.cos(yaw), np.sin(yaw)]) * (depth + BEFORE_M) / 2
    strip = footprints(np.array([BEFORE_M, width]), place[None], np.array([yaw]))[0]
    area = float(BEFORE_M * width) / CELL_M**2
    return float(min(1.0, (free & (_raster(frame, [strip]) > 0)).sum() / max(area, 1.0)))
