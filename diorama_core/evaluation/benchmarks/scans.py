"""Rooms from scans of a phone: which furniture is found, whether its kind is right, and which doors and windows are.

A furnished room is scanned with depth and pictures (`synthesis.scan`), written as 3D Scanner App writes it, and opened
as a scene. The room's own shapes are not in the library that is searched.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from diorama_core.evaluation.benchmarks.cases import Case, LeftOut, attempt, furnish, recipe
from diorama_core.evaluation.reports.tables import Column, Row, Table, bootstrap_interval
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.importing.measured_cloud import measure_cloud
from diorama_core.importing.measured_room import open_room
from diorama_core.importing.point_files import read_points
from diorama_core.importing.scanned_kinds import with_scanned_kinds
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import broad, category
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.types import Scene, SceneObject, yaw_rotation
from diorama_core.synthesis.scan import scan, write_scan
from diorama_core.synthesis.splits import split_library

MIN_SHARED = 0.3
"""Intersection over union of the volumes of a thing and its box, from which the thing is found."""
MIN_SIZE_M = 0.3
"""Smaller things are not asked for."""
MAX_OFF_M = 0.3
"""From an opening's middle to its truth's."""
NOT_ASKED = (*OPENING_CATEGORIES, "curtain", "rug", "blinds")
WAYS = ("size alone", "size, shape and what stands around", "size, shape, what stands around, and photos")


@dataclass(frozen=True)
class ScanResult:
    """One room, opened in one way."""

    case: str
    way: str
    things: int
    """That stand or hang in the room and are not small."""
    found: int
    """Things found, by place and size."""
    right: int
    """Found things with the right kind."""
    openings: int
    openings_found: int
    openings_false: int
    seconds: float
    """Processor time."""


@dataclass(frozen=True)
class ScansBench:
    """Results of all rooms, room by room."""

    results: tuple[ScanResult, ...]
    left_out: tuple[LeftOut, ...] = ()

    def tables(self) -> tuple[Table, ...]:
        """One row for each way of telling kinds."""
        columns = (
            Column("right kinds", better="↑"), Column("found", better="↑"), Column("objects", "d"),
            Column("doors and windows found", better="↑"), Column("of", "d"), Column("false", "d", "↓"),
            Column("time s", ".1f", "↓"),
        )  # fmt: skip
        rows = []
        for way in dict.fromkeys(r.way for r in self.results):
            of_way = [r for r in self.results if r.way == way]
            hits, asked, openings = (sum(getattr(r, n) for r in of_way) for n in ("found", "things", "openings"))
            shares = [r.right / max(r.found, 1) for r in of_way]
            span = bootstrap_interval(shares, [r.found for r in of_way])
            right = sum(r.right for r in of_way) / max(hits, 1)
            seen = sum(r.openings_found for r in of_way) / max(openings, 1)
            wrong, seconds = sum(r.openings_false for r in of_way), sum(r.seconds for r in of_way) / len(of_way)
            values = (right, hits / max(asked, 1), asked, seen, openings, wrong, seconds)
            rows.append(Row(way, values, intervals=(span, *(None,) * 6)))
        rooms = len({r.case for r in self.results})
        note = (
            f"{rooms} rooms. Right kinds: of the objects that were found (a box shares 0.3 of its volume with them), "
            "special kinds counting as their broad one. In brackets the 90 % interval (bootstrap over rooms). Doors "
            f"and windows within {MAX_OFF_M} m. Time: processor seconds a room, reading included."
        )
        if self.left_out:
            note += f" Left out: {'; '.join(map(str, self.left_out))}."
        return (Table("Rooms from scans", columns, tuple(rows), note),)

    def to_json(self) -> dict[str, object]:
        """Tables and every room."""
        return {
            "bench": "scans",
            "tables": [t.to_json() for t in self.tables()],
            "scenes": [asdict(r) for r in self.results],
            "left_out": [asdict(r) for r in self.left_out],
        }


def run(library: ShapeLibrary, scenes: int = 6, seed: int = 0, progress: Progress = SILENT) -> ScansBench:
    """Scan rooms and open the scans.

    Args:
        library: rooms are furnished from its test shapes; the others are searched.
        scenes: rooms.
        seed: of the series of rooms.
        progress: reports, and cancels between rooms.
    """
    tested, searched = split_library(library, "test"), split_library(library, "train", "validation")
    cases, left_out = recipe(scenes, 1, seed), list[LeftOut]()
    results: list[ScanResult] = []

    def results_of(case: Case) -> tuple[ScanResult, ...]:
        progress.report(cases.index(case) / len(cases), f"scanning {case.name}")
        truth = furnish(case, tested)
        with tempfile.TemporaryDirectory() as folder:
            write_scan(Path(folder), scan(truth, tested, case.seed))
            return open_all_ways(case.name, truth, Path(folder), searched)

    for _, result in attempt(cases, results_of, left_out):
        results += result
    progress.report(1.0, "done")
    return ScansBench(tuple(results), tuple(left_out))


def open_all_ways(name: str, truth: Scene, scan: Path, library: ShapeLibrary) -> tuple[ScanResult, ...]:
    """A scan opened with and without what its points' shapes and its photos tell, and compared with the room.

    Args:
        name: of the room.
        truth: the room.
        scan: file of the scan.
        library: where shapes come from.
    """
    begun = time.process_time()
    measured = measure_cloud(read_points(scan))
    reading = time.process_time() - begun
    results = []
    for way in WAYS:
        begun = time.process_time()
        room = measured if way == WAYS[0] else with_scanned_kinds(measured, library, look=way == WAYS[2])
        scene = open_room(room, library).scene
        seconds = reading + time.process_time() - begun
        results.append(score(name, way, truth, scene, seconds))
    return tuple(results)


def score(name: str, way: str, truth: Scene, scene: Scene, seconds: float) -> ScanResult:
    """An opened scan against the room that was scanned, whichever way round it lies.

    Args:
        name: of the room.
        way: how it was opened.
        truth: the room.
        scene: as it was opened.
        seconds: that it took.
    """
    asked = [o for o in truth.objects if _is_asked(o)]
    turned = ([_rotate(o, yaw_rotation(k * np.pi / 2)) for o in scene.objects] for k in range(4))
    pairs, best = max(((_pairs(asked, objects), objects) for objects in turned), key=lambda row: len(row[0]))
    right = sum(broad(a.category) == broad(b.category) for a, b in pairs)
    openings = [o for o in truth.objects if o.category in OPENING_CATEGORIES]
    cut = [o for o in best if o.category in OPENING_CATEGORIES]
    met = sum(any(_same_opening(o, c) for c in cut) for o in openings)
    false = sum(not any(_same_opening(o, c) for o in openings) for c in cut)
    return ScanResult(name, way, len(asked), len(pairs), right, len(openings), met, false, seconds)


def _is_asked(item: SceneObject) -> bool:
    large = float(np.sort(item.size_m)[1]) >= MIN_SIZE_M
    return large and category(item.category).mount in ("floor", "wall") and item.category not in NOT_ASKED


def _rotate(item: SceneObject, R: Float[np.ndarray, "3 3"]) -> SceneObject:
    pose = replace(item.pose, R_world_object=R @ item.pose.R_world_object, position=R @ item.pose.position)
    return replace(item, pose=pose)


def _pairs(truths: Sequence[SceneObject], objects: Sequence[SceneObject]) -> list[tuple[SceneObject, SceneObject]]:
    """Things with what was found in their place, each once, the best first."""
    rows = [(_iou(a, b), i, j) for i, a in enumerate(truths) for j, b in enumerate(objects)]
    pairs, used_things, used_found = [], set[int](), set[int]()
    for share, i, j in sorted(rows, key=lambda row: (-row[0], row[1:])):
        if share >= MIN_SHARED and i not in used_things and j not in used_found:
            used_things.add(i)
            used_found.add(j)
            pairs.append((truths[i], objects[j]))
    return pairs


def _iou(a: SceneObject, b: SceneObject) -> float:
    """Intersection over union of the boxes along the room's axes."""
    (low_a, high_a), (low_b, high_b) = ((c.min(axis=0), c.max(axis=0)) for c in (a.corners_world, b.corners_world))
    common = float(np.prod(np.maximum(np.minimum(high_a, high_b) - np.maximum(low_a, low_b), 0.0)))
    return common / float(np.prod(high_a - low_a) + np.prod(high_b - low_b) - common)


def _same_opening(a: SceneObject, b: SceneObject) -> bool:
    return a.category == b.category and float(np.linalg.norm(a.pose.position - b.pose.position)) <= MAX_OFF_M
