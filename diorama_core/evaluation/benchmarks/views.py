"""Several photos of a rendered room with given cameras: how much each further photo tells of the first one's objects.

A room is photographed from eight places. The scene is built from the first photo alone, with nothing known of its
camera, then from the first one, two, four and eight photos with their cameras, and from one 360 degree photo taken in
the middle, with nothing known of its camera. Boxes and classes are given, the room's own shapes are not in the library
that is searched, and always the same objects are counted: those of the first photo.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace

import manifold3d
import numpy as np

from diorama_core.artefacts import Inputs, Photo
from diorama_core.evaluation.benchmarks.cases import (
    MIN_ASKED,
    SIZE,
    Case,
    LeftOut,
    attempt,
    attempt_one,
    furnish,
    recipe,
)
from diorama_core.evaluation.metrics.pose import Alignment, nothing_right, object_alignment, pool
from diorama_core.evaluation.metrics.scene import Matched
from diorama_core.evaluation.reports.tables import Column, Figure, Table, bootstrap_interval, figures_table, mean
from diorama_core.layout.recipes import recipe as layout_recipe
from diorama_core.library.record import ShapeLibrary
from diorama_core.multiview.rooms import PosedInputs, build_room
from diorama_core.multiview.sphere_scene import build_sphere
from diorama_core.pipeline.run import build_scene
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import LayoutStage
from diorama_core.scene.room_edits import ceiling_height
from diorama_core.scene.types import Camera, Scene
from diorama_core.synthesis import sample_cameras
from diorama_core.synthesis.artefacts import photo_only
from diorama_core.synthesis.sphere import sphere_photo, sphere_place
from diorama_core.synthesis.splits import split_library
from diorama_core.synthesis.truth import Studio, TruthView, transform

COUNTS = (1, 2, 4, 8)
"""Photos that a scene is built from."""
ALONE = "one photo, nothing known of its camera"
SPHERE = "one 360 degree photo, nothing known of its camera"


@dataclass(frozen=True)
class ViewsResult:
    """One scene."""

    case: str
    way: str
    own: Alignment
    """Each object of the first photo against its own truth."""
    seconds: float
    """Processor time of the build."""
    failure: str = ""
    room: float = 0.0
    """Intersection over union of the floors in plan."""
    height: float = 0.0
    """Found over true height of the room; 0 where none was found."""


FIGURES = (
    Figure(
        Column("own Acc", better="↑"),
        lambda results: pool([r.own for r in results]).acc,
        lambda results: bootstrap_interval([r.own.acc for r in results], [r.own.count for r in results]),
    ),
    Figure(Column("rotation", better="↑"), lambda results: pool([r.own for r in results]).r_acc),
    Figure(Column("place", better="↑"), lambda results: pool([r.own for r in results]).t_acc),
    Figure(Column("size", better="↑"), lambda results: pool([r.own for r in results]).s_acc),
    Figure(Column("objects", "d"), lambda results: sum(r.own.count for r in results)),
    Figure(Column("time s", ".1f", "↓"), lambda results: mean(r.seconds for r in results)),
    Figure(
        Column("room IoU", better="↑"),
        lambda results: mean(r.room for r in results),
        lambda results: bootstrap_interval([r.room for r in results]),
    ),
    Figure(Column("height", ".1%", "↓"), lambda results: float(np.median([abs(r.height - 1.0) for r in results]))),
)


@dataclass(frozen=True)
class ViewsBench:
    """Results of all rooms, room by room."""

    results: tuple[ViewsResult, ...]
    left_out: tuple[LeftOut, ...] = ()

    def tables(self) -> tuple[Table, ...]:
        """One row for each number of photos."""
        by_way = {r.way: [other for other in self.results if other.way == r.way] for r in self.results}
        rooms = len({r.case for r in self.results})
        failed = sum(bool(r.failure) for r in self.results)
        note = (
            f"{rooms} rooms, {failed} builds failed. own Acc: each object of the first photo within 20 cm, 20 degrees "
            "and 20 % (mean over the axes) of its truth; rotation, place and size are the three by themselves. "
            "In brackets the 90 % interval of the mean (bootstrap over rooms). Time: processor seconds a scene. "
            "room IoU: of the floors in "
            "plan, mean; height: of the room, median of the deviations."
        )
        if self.left_out:
            note += f" Left out because they could not be made: {'; '.join(map(str, self.left_out))}."
        return (figures_table("Several photos of one room", by_way.items(), FIGURES, note),)

    def to_json(self) -> dict[str, object]:
        """Tables and every scene."""
        return {
            "bench": "views",
            "tables": [t.to_json() for t in self.tables()],
            "scenes": [asdict(r) for r in self.results],
            "left_out": [asdict(r) for r in self.left_out],
        }


def run(
    library: ShapeLibrary,
    scenes: int = 6,
    seed: int = 0,
    progress: Progress = SILENT,
    *,
    counts: Sequence[int] = COUNTS,
) -> ViewsBench:
    """Build every room from each number of photos.

    Args:
        library: rooms are furnished from its test shapes; the others are searched.
        scenes: rooms.
        seed: of the series of rooms.
        progress: reports, and cancels between builds.
        counts: numbers of photos.
    """
    tested, searched = split_library(library, "test"), split_library(library, "train", "validation")
    results: list[ViewsResult] = []
    left_out: list[LeftOut] = []
    cases = recipe(scenes, 1, seed)

    def photos_of(case: Case) -> tuple[RoomView, ...]:
        progress.report(cases.index(case) / len(cases), f"photographing {case.name}")
        return photograph(case, tested, max(counts))

    for case, views in attempt(cases, photos_of, left_out):
        k = cases.index(case)
        part = progress.part(k / len(cases), (k + 1) / len(cases))
        room = _Room(case, library, tested, searched, progress)
        results.append(room.score(ALONE, views[:1], room.from_one_photo))
        for turn, n in enumerate(counts):
            part.report(0.2 + 0.8 * turn / len(counts), f"{case.name}: {n} photos")
            name = "one photo with its camera" if n == 1 else f"{n} photos with their cameras"
            results.append(room.score(name, views[:n], room.from_photos))
        results.append(room.score(SPHERE, views[:1], room.from_sphere))
    progress.report(1.0, "done")
    return ViewsBench(tuple(results), tuple(left_out))


@dataclass(frozen=True, eq=False)
class RoomView:
    """A picture of a room, and its camera in the room's own frame."""

    truth: TruthView
    camera: Camera


def photograph(case: Case, library: ShapeLibrary, count: int, size: tuple[int, int] = SIZE) -> tuple[RoomView, ...]:
    """Pictures of a case's room from different places: first one with enough objects, then those that share most of
    its objects.

    Args:
        case: the room.
        library: where shapes come from.
        count: of pictures.
        size: width and height in pixels.

    Raises:
        SceneError: there is no room for so many cameras.
    """
    scene = furnish(case, library)
    studio = Studio(scene, library)
    cameras = sample_cameras(scene, library, case.seed, count, size)
    views = [RoomView(studio.view(c, size, with_empty_room=False), c) for c in cameras]
    first = next((v for v in views if len(v.truth.indices) >= MIN_ASKED), views[0])
    rest = [v for v in views if v is not first]
    rest.sort(key=lambda v: -len(set(v.truth.indices) & set(first.truth.indices)))
    return (first, *rest)


@dataclass(frozen=True, eq=False)
class _Room:
    """A case and what its scenes are built with."""

    case: Case
    library: ShapeLibrary
    """Knows the true shapes too."""
    tested: ShapeLibrary
    """Furnishes the room."""
    searched: ShapeLibrary
    progress: Progress

    def from_one_photo(self, views: Sequence[RoomView]) -> Scene:
        """The scene of a photo and its boxes."""
        given = photo_only(views[0].truth)
        return build_scene(given, self.searched, stages=self._choose(given), progress=self._quiet()).scene

    def from_photos(self, views: Sequence[RoomView]) -> Scene:
        """The scene of photos with their cameras and boxes."""
        photos = [PosedInputs(photo_only(v.truth), v.camera) for v in views]
        return build_room(photos, self.searched, self._choose, self._layout(), self._quiet()).scene

    def _choose(self, inputs: Inputs) -> Stages:
        return embedded_stages(inputs, self.searched)

    def _layout(self) -> LayoutStage:
        return layout_recipe("feasible", self.searched, depth_measured=True)

    def _quiet(self) -> Progress:
        return Progress(token=self.progress.token)

    def from_sphere(self, views: Sequence[RoomView]) -> Scene:
        """The scene of a 360 degree photo and its boxes, seen by the first photo's camera, with the boxes there."""
        room, first = furnish(self.case, self.tested), views[0]
        seen = sphere_photo(Studio(room, self.tested), sphere_place(room, self.case.seed))
        marked = seen.boxes(room.objects)
        photo = Photo(seen.rgb, "sphere.png", (seen.rgb.shape[1], seen.rgb.shape[0]))
        boxes = tuple(marked.values())
        built = build_sphere(photo, boxes, self.searched, self._choose, self._layout(), self._quiet())
        T = seen.T_world_sphere.copy()
        T[:3, :3] = T[:3, :3] @ built.R_room_sphere.T
        T[:3, 3] -= T[:3, 2] * built.views[0].camera.position[2]
        scene = transform(built.room.scene, T)
        known = {thing.labelled.box: name for thing, name in built.things}
        named = {known[b.box]: first.truth.scene.objects[k].box_px for k, b in marked.items() if b.box in known}
        objects = tuple(replace(o, box_px=named.get(o.id)) for o in scene.objects)
        return replace(scene, objects=objects, camera=first.camera)

    def score(self, way: str, views: Sequence[RoomView], build: Callable[[Sequence[RoomView]], Scene]) -> ViewsResult:
        """The own alignment of the first photo's objects; a build that fails has none right."""
        begun, truth = time.process_time(), views[0].truth
        scene, failure = attempt_one(f"{self.case.name}, {way}", build, views)
        seconds = time.process_time() - begun
        if scene is None:
            return ViewsResult(self.case.name, way, nothing_right(len(truth.indices))[2], seconds, failure)
        matched = Matched.of(truth, scene)
        alignment = object_alignment(*matched.poses(self.library))
        return ViewsResult(self.case.name, way, alignment, seconds, "", *_room_agreement(matched.scene, truth.scene))


def _room_agreement(scene: Scene, truth: Scene) -> tuple[float, float]:
    """Intersection over union of two rooms' floors in plan, and the first one's height over the second one's."""
    one, two = scene.architecture.floor, truth.architecture.floor
    if one is None or two is None:
        return 0.0, 0.0
    a, b = (manifold3d.CrossSection([p.polygon[:, :2]], manifold3d.FillRule.EvenOdd) for p in (one, two))
    both = (a ^ b).area()
    found_m, true_m = ceiling_height(scene), ceiling_height(truth)
    return float(both / (a.area() + b.area() - both)), 0.0 if not found_m or not true_m else found_m / true_m
