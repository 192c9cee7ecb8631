"""What a speed run measures: stages against picture size and objects, layout, optimiser steps, libraries."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from jaxtyping import Float32

from diorama_core.artefacts import Inputs
from diorama_core.evaluation.speed.eager import WAYS, step_seconds
from diorama_core.evaluation.speed.meter import Cost, StageClock, cost_of, growth_exponent
from diorama_core.export.gltf import glb_bytes
from diorama_core.layout.recipes import recipe as layout_recipe
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.search import TextIndex, find_in
from diorama_core.library.store.features import FeatureMatrix
from diorama_core.pipeline.run import build_scene
from diorama_core.progress import Progress
from diorama_core.scene.types import Camera, Intrinsics, Pose, Scene, SceneObject, Support, yaw_rotation
from diorama_core.synthesis import furnish_room
from diorama_core.synthesis.cameras import level_pose, sample_cameras
from diorama_core.synthesis.layout_rooms import box_library, generate_room, room_box
from diorama_core.synthesis.truth import Studio

KINDS = ("armchair", "chair", "stool", "plant", "night stand", "chest")
SHAPES_PER_KIND = 4
CELL_M = 1.3
MIN_SIZE_M = 0.45
PICTURE = (960, 720)


def large_scene(library: ShapeLibrary, count: int, seed: int) -> tuple[Scene, Camera]:
    """Objects in rows on the floor of a room as large as necessary, and a camera high on a wall that sees them all."""
    rng = np.random.default_rng((seed, count))
    across = int(np.ceil(np.sqrt(count)))
    side = CELL_M * across + 1.5
    shapes = _shapes(library)
    objects = []
    for k in range(count):
        shape = shapes[int(rng.integers(len(shapes)))]
        cell = np.array([k % across + 0.5, k // across + 0.5]) * CELL_M - CELL_M * across / 2
        position = np.array([*(cell + rng.uniform(-0.1, 0.1, 2)), shape.size_m[2] / 2])
        pose = Pose(yaw_rotation(float(rng.uniform(0, 2 * np.pi))), position, np.ones(3))
        name = f"{shape.category}_{k}"
        objects.append(SceneObject(name, shape.category, shape.category, shape.id, shape.size_m, pose))
    supports = tuple(Support(o.id, "floor", "placed on") for o in objects)
    scene = Scene(objects=tuple(objects), architecture=room_box(side, side, max(2.6, 0.7 * side)), supports=supports)
    eye = np.array([0.0, 0.15 - side / 2, max(1.6, 0.6 * side)])
    pitch = float(np.arctan2(eye[2] - 0.3, side / 2))
    return scene, Camera(Intrinsics.from_fov(*PICTURE, 1.25), level_pose(eye, np.pi / 2, pitch))


def _shapes(library: ShapeLibrary) -> list[Shape]:
    chosen: list[Shape] = []
    for kind in KINDS:
        large = [s for s in library.in_category(kind) if max(s.size_m) >= MIN_SIZE_M]
        chosen += large[:: max(1, len(large) // SHAPES_PER_KIND)][:SHAPES_PER_KIND]
    return chosen


STAGES = (
    "camera",
    "objects",
    "geometry",
    "graph",
    "architecture",
    "depth",
    "retrieval",
    "pose",
    "layout",
    "refinement",
)
MEGAPIXELS, OBJECTS, SHAPES = "megapixels", "objects", "shapes"
FEATURES = 512
"""Numbers in a shape's feature, as the picture networks give."""
BLOCK = 10_000
NEAREST = 50


@dataclass(frozen=True)
class Series:
    """Costs against one quantity."""

    what: str
    against: str
    points: tuple[tuple[float, float], ...]
    """(quantity, processor seconds)."""
    peaks_mb: tuple[float | None, ...] = ()
    """Memory at each point, above the memory in use before; empty where it was not measured."""
    missing: str = ""
    """Why there are no points."""

    @property
    def exponent(self) -> float:
        """Growth: the slope of log time over log quantity."""
        return growth_exponent(list(self.points))


class Collected:
    """Costs as they come in, by what was done."""

    def __init__(self, against: str) -> None:
        self._against = against
        self._costs: dict[str, list[tuple[float, Cost]]] = {}

    def add(self, what: str, quantity: float, cost: Cost) -> None:
        """One more point: what was timed, and of how much."""
        self._costs.setdefault(what, []).append((quantity, cost))

    def series(self) -> list[Series]:
        """All of them, in the order in which they came first."""
        return [
            Series(what, self._against, tuple((q, c.seconds) for q, c in costs), tuple(c.peak_mb for _, c in costs))
            for what, costs in self._costs.items()
        ]


def stages_by_size(
    library: ShapeLibrary, seed: int, sizes: Sequence[tuple[int, int]], progress: Progress
) -> list[Series]:
    """The renderer, and every stage of a build with true masks and depth, for one room at several picture sizes.

    Args:
        library: where shapes come from.
        seed: of the series of rooms.
        sizes: width and height in pixels.
        progress: reports and cancellation.
    """
    collected = Collected(MEGAPIXELS)
    scene = furnish_room(seed, "living", library, split="test")
    camera = sample_cameras(scene, library, seed, 1)[0]
    studio = Studio(scene, library)
    build_scene(studio.view(camera, sizes[0]).inputs, library)  # makes ready the shapes that later builds find ready
    for k, size in enumerate(sizes):
        progress.report(k / len(sizes), f"{size[0]} x {size[1]} pixels")
        pixels = size[0] * size[1] / 1e6
        collected.add("render with truth", pixels, cost_of(partial(studio.view, camera, size)))
        _build(studio.view(camera, size, with_empty_room=False).inputs, library, pixels, collected, progress)
    return collected.series()


def stages_by_objects(library: ShapeLibrary, seed: int, counts: Sequence[int], progress: Progress) -> list[Series]:
    """The renderer, every stage of a build, and export, for scenes of more and more objects; pictures of one size.

    Args:
        library: where shapes come from.
        seed: of the series of rooms.
        counts: of objects.
        progress: reports and cancellation.
    """
    collected = Collected(OBJECTS)
    weights = np.cumsum([5.0, *(float(c) for c in counts)]) / (5.0 + sum(counts))
    _build(_large_scene_inputs(library, 12, seed), library, 0.0, Collected(OBJECTS), progress)  # makes ready the shapes
    for count, done in zip(counts, weights, strict=False):
        progress.report(float(done), f"a large scene of {count} objects")
        scene, camera = large_scene(library, count, seed)
        studio = Studio(scene, library)
        render = partial(studio.view, camera, PICTURE, with_empty_room=False)
        collected.add("render with truth", count, cost_of(render))
        built = _build(render().inputs, library, count, collected, progress)
        collected.add("export GLB", count, cost_of(partial(glb_bytes, built, library)))
    return collected.series()


def _large_scene_inputs(library: ShapeLibrary, count: int, seed: int) -> Inputs:
    scene, camera = large_scene(library, count, seed)
    return Studio(scene, library).view(camera, PICTURE, with_empty_room=False).inputs


def _build(inputs: Inputs, library: ShapeLibrary, quantity: float, collected: Collected, progress: Progress) -> Scene:
    """Build once and note what each stage took, and the whole."""
    clock = StageClock(STAGES)
    scenes: list[Scene] = []
    whole = cost_of(lambda: scenes.append(build_scene(inputs, library, progress=clock.watch(progress)).scene))
    for stage in STAGES:
        if stage in clock.costs:
            collected.add(stage, quantity, clock.costs[stage])
    collected.add("whole build", quantity, replace(whole, peak_mb=max(c.peak_mb or 0 for c in clock.costs.values())))
    return scenes[0]


def layout_by_objects(seed: int, counts: Sequence[int], progress: Progress) -> list[Series]:
    """The default and the paper's recipe on generated rooms."""
    collected = Collected(OBJECTS)
    library = box_library()
    for name in ("feasible", "paper"):
        stage = layout_recipe(name, library)
        for k, count in enumerate(counts):
            progress.report(k / len(counts), f"layout '{name}', {count} objects")
            observed = generate_room(seed + 500, count).observed
            collected.add(f"layout '{name}'", count, cost_of(partial(stage.optimise, observed, Progress()), 2))
    return collected.series()


def steps_by_objects(seed: int, counts: Sequence[int], progress: Progress) -> list[Series]:
    """One step of the optimiser's last stage, ours and others (`speed_eager`)."""
    rows = []
    for n, way in enumerate(WAYS):
        points = []
        for k, count in enumerate(counts):
            progress.report((n + k / len(counts)) / len(WAYS), f"a step {way}, {count} objects")
            seconds = step_seconds(way, count, seed)
            if seconds is not None:
                points.append((float(count), seconds))
        rows.append(Series(way, OBJECTS, tuple(points), missing="" if points else "no GPU here"))
    return rows


def features_by_library(seed: int, counts: Sequence[int], progress: Progress) -> list[Series]:
    """Opening a feature store on disk, and the nearest 50 of all its rows; features are synthetic."""
    collected = Collected(SHAPES)
    block, signs = _block_of_features(seed), np.random.default_rng(seed + 1)
    with tempfile.TemporaryDirectory(prefix="diorama-speed-") as folder:
        store = FeatureMatrix(Path(folder), FEATURES)
        for k, count in enumerate(counts):
            progress.report(k / len(counts), f"features of {count:,} shapes")
            while len(store) < count:
                rows = min(BLOCK, count - len(store))
                flipped = block[:rows] * signs.choice(np.array([-1, 1], np.float32), FEATURES)
                store.append([f"shape_{len(store) + r:07d}" for r in range(rows)], flipped[:, None])
                progress.check()
            collected.add("open the features", count, cost_of(partial(FeatureMatrix, Path(folder), FEATURES), 2))
            collected.add(f"nearest {NEAREST} by features", count, cost_of(partial(store.top, block[0], NEAREST), 5))
    return collected.series()


def _block_of_features(seed: int) -> Float32[np.ndarray, "n d"]:
    """Unit rows; other blocks are the same with signs of columns changed, which is cheaper than drawing them."""
    rows = np.random.default_rng(seed).standard_normal((BLOCK, FEATURES), dtype=np.float32)
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def words_by_library(library: ShapeLibrary, counts: Sequence[int], progress: Progress) -> list[Series]:
    """Indexing the words of a library, and a search in them; records are those of the library under more names."""
    collected = Collected(SHAPES)
    records = library.shapes()
    for k, count in enumerate(counts):
        progress.report(k / len(counts), f"words of {count:,} shapes")
        renamed = (replace(records[i % len(records)], id=f"shape_{i:07d}") for i in range(count))
        shapes = tuple(renamed)
        collected.add("index the words", count, cost_of(partial(TextIndex, shapes)))
        search = partial(find_in, TextIndex(shapes), "a small oak bookcase", NEAREST)
        search()
        collected.add("find by words", count, cost_of(search, 3))
    return collected.series()
