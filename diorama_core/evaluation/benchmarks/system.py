"""The whole system on rendered rooms: from a picture with true masks and depth, and from the picture alone.

As in the paper, the shapes that stand in the rooms are not in the library that is searched, unless asked for.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.errors import InputError
from diorama_core.evaluation.benchmarks.cases import Case, LeftOut, attempt_one, make_views, recipe
from diorama_core.evaluation.benchmarks.photo_perturbations import jitter_box
from diorama_core.evaluation.benchmarks.substitution import substitute
from diorama_core.evaluation.benchmarks.system_tables import (
    CaseResult,
    scene_table,
    series_table,
    substitution_table,
    system_table,
)
from diorama_core.evaluation.metrics.scene import SceneScores, scene_scores
from diorama_core.evaluation.reports.tables import Table
from diorama_core.library.labels import MEANINGS
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import UNKNOWN, resolve
from diorama_core.pipeline.published import acdc_stages, published_acdc_stages, published_stages
from diorama_core.pipeline.run import Built, build_scene
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.progress import SILENT, Progress
from diorama_core.synthesis.artefacts import photo_only
from diorama_core.synthesis.splits import split_library
from diorama_core.synthesis.truth import TruthView

TRUE_INPUTS = "true masks and depth"
PHOTO_ALONE = "embedded perception"
BOX_JITTER = 0.04
"""Standard deviation of a detector's edges, as a share of the box."""
PLAIN_WORDS = (
    *("chair", "table", "cabinet", "lamp", "shelf", "sofa", "bed", "stool", "picture", "mirror", "clock", "tv", "bag"),
    "light",
)
"""What people call things in passing, and which kinds they say it of most readily first."""
_SAID_OFTEN = 0.025
"""Share of what a word means from which on a kind is called so."""
Show = Callable[[str, TruthView, tuple[Built | None, ...]], None]


@dataclass(frozen=True)
class Way:
    """What a build is given: a row of the tables."""

    name: str
    inputs: Callable[[TruthView], Inputs]
    truth: frozenset[str] = frozenset()
    """Names of `substitution.SUBSTITUTES` that take the place of the stages' results."""
    stages: Callable[[Inputs, ShapeLibrary], Stages] | None = None
    """Other stages than the embedded ones, for a system to compare with."""


def masks_only(view: TruthView) -> Inputs:
    """The picture with true masks and classes; depth and intrinsics are left to the photo, as in the paper."""
    return replace(view.inputs, depth_m=None, intrinsics=None)


def without_names(view: TruthView) -> Inputs:
    """The photo with boxes without category names."""
    given = photo_only(view)
    return replace(given, boxes=tuple(replace(b, category=UNKNOWN.name, label=UNKNOWN.name) for b in given.boxes))


def loosely_said(view: TruthView) -> Inputs:
    """The photo with boxes called as people call them in passing: "table" of desks, "cabinet" of chests of drawers."""
    given = photo_only(view)
    return replace(given, boxes=tuple(loosen_name(b) for b in given.boxes))


def loosen_name(box: LabelledBox) -> LabelledBox:
    """A box with the first of `PLAIN_WORDS` that is used often enough for its kind; as it was where none is."""
    shares = ((word, MEANINGS[word].get(box.category, 0.0) / sum(MEANINGS[word].values())) for word in PLAIN_WORDS)
    word = next((word for word, share in shares if share >= _SAID_OFTEN), None)
    return box if word is None else replace(box, category=resolve(word).category.name, label=word)


def jitter(view: TruthView) -> Inputs:
    """The picture with every edge of every box off by 4 % of the box (standard deviation), as detectors' are."""
    given, k = photo_only(view), view.camera.intrinsics
    rng = np.random.default_rng(len(view.indices))
    moved = (replace(b, box=jitter_box(b.box, (k.width, k.height), BOX_JITTER, rng)) for b in given.boxes)
    return replace(given, boxes=tuple(moved))


def _acdc(inputs: Inputs, library: ShapeLibrary) -> Stages:
    """ACDC without networks: the embedded stages stand in for them."""
    return acdc_stages(embedded_stages(inputs, library), inputs.depth_m is not None, library)


WAYS: Mapping[str, Way] = {
    "depth": Way(TRUE_INPUTS, lambda view: view.inputs),
    "masks": Way("true masks, the photo's own depth", masks_only),
    "photo": Way(PHOTO_ALONE, photo_only),
    "unnamed": Way(f"{PHOTO_ALONE}, without classes", without_names),
    "loose": Way(f"{PHOTO_ALONE}, loose words", loosely_said),
    "jittered": Way(f"{PHOTO_ALONE}, boxes off by 4 %", jitter),
    "acdc": Way(f"ACDC, {TRUE_INPUTS}", lambda view: view.inputs, stages=_acdc),
    "published": Way("the paper's system, true masks, networks", masks_only, stages=published_stages),
    "published-acdc": Way("ACDC, true masks, networks", masks_only, stages=published_acdc_stages),
}
"""What may be given, by the name that `--given` takes."""
USUAL_WAYS = ("depth", "photo")


def ways_of(given: Sequence[str], substitutes: Sequence[frozenset[str]] = ()) -> tuple[Way, ...]:
    """The rows of a run: what is given, then one row for every substitution on the picture and boxes.

    Raises:
        InputError: for a name that is not in `WAYS`.
    """
    for name in given:
        if name not in WAYS:
            raise InputError(f"--given {name}: give one or more of {', '.join(WAYS)}")
    photo = WAYS["photo"]
    rows = tuple(replace(photo, name="true " + ", ".join(sorted(truth)), truth=truth) for truth in substitutes)
    return (*(WAYS[name] for name in given), *rows)


@dataclass(frozen=True)
class SystemBench:
    """Results of every way."""

    seeds: tuple[int, ...]
    offered: bool
    """Whether the rooms' own shapes were among those searched."""
    results: tuple[tuple[str, tuple[CaseResult, ...]], ...]
    """(what was given, one result per case)."""
    left_out: tuple[LeftOut, ...] = ()
    substituted: tuple[str, ...] = ()
    """The ways in which the truth took the place of something."""

    def tables(self) -> tuple[Table, ...]:
        """The paper's system table, what it does not measure, and what was asked for besides."""
        plain = [(n, r) for n, r in self.results if n not in self.substituted]
        tables = [system_table(plain, offered=self.offered), scene_table(plain)]
        if self.substituted:
            shown = [(n, r) for n, r in self.results if n in self.substituted or n == PHOTO_ALONE]
            tables.append(substitution_table(shown))
        if len(self.seeds) > 1:
            tables.append(series_table(plain))
        if self.left_out:
            omissions = f"Left out because they could not be made: {'; '.join(map(str, self.left_out))}."
            tables[0] = replace(tables[0], note=f"{tables[0].note} {omissions}")
        return tuple(tables)

    def to_json(self) -> dict[str, object]:
        """Tables and every case."""
        return {
            "bench": "system",
            "seeds": list(self.seeds),
            "offered": self.offered,
            "tables": [t.to_json() for t in self.tables()],
            "cases": {name: [asdict(r) for r in rows] for name, rows in self.results},
            "left_out": [asdict(r) for r in self.left_out],
        }


def run(
    library: ShapeLibrary,
    scenes: int = 20,
    seeds: Sequence[int] = (0,),
    progress: Progress = SILENT,
    *,
    ways: Sequence[Way] = (),
    offered: bool = False,
    physics: bool = False,
    show: Show | None = None,
    after_room: Callable[[SystemBench], None] | None = None,
) -> SystemBench:
    """Build every room every way. A build that fails counts as a scene in which everything is wrong.

    Args:
        library: rooms are furnished from its test shapes; the others are searched.
        scenes: rooms of every seed, one picture each.
        seeds: of the series of rooms.
        progress: reports, and cancels between builds.
        ways: what the builds are given; `USUAL_WAYS` by default.
        offered: search the whole library, the rooms' own shapes among it.
        physics: whether to measure drift under gravity as well.
        show: called with every case's name, photo, and the results of all ways (None where one failed).
        after_room: called with the results so far after every room, so that an interrupted run has some.
    """
    ways = tuple(ways) or ways_of(USUAL_WAYS)
    tested = split_library(library, "test")
    searched = library if offered else split_library(library, "train", "validation")
    cases = [(seed, case) for seed in seeds for case in recipe(scenes, 1, seed)]
    results: dict[str, list[CaseResult]] = {way.name: [] for way in ways}
    left_out: list[LeftOut] = []

    def so_far() -> SystemBench:
        rows = tuple((name, tuple(cases)) for name, cases in results.items())
        return SystemBench(tuple(seeds), offered, rows, tuple(left_out), tuple(w.name for w in ways if w.truth))

    for k, (seed, case) in enumerate(cases):
        for _, view in make_views((case,), tested, left_out):
            shown: list[Built | None] = []
            for turn, way in enumerate(ways):
                progress.report((k + turn / len(ways)) / len(cases), f"{case.name}: {way.name}")
                built, result = build_case(case, view, way, library, searched, progress, physics=physics)
                results[way.name].append(replace(result, seed=seed))
                shown.append(built)
            if show is not None:
                show(case.name, view, tuple(shown))
        if after_room is not None:
            after_room(so_far())
    progress.report(1.0, "done")
    return so_far()


def build_case(
    case: Case,
    view: TruthView,
    way: Way,
    library: ShapeLibrary,
    searched: ShapeLibrary,
    progress: Progress,
    *,
    physics: bool = False,
) -> tuple[Built | None, CaseResult]:
    """Build one scene from what is searched and score it with the library that knows the truth's shapes too.

    Args:
        case: the room.
        view: its picture and truth.
        way: what is given and which stages build.
        library: knows the truth's shapes.
        searched: what shapes are taken from.
        progress: reports and cancellation.
        physics: whether it is dropped in a simulator.
    """
    begun, wall = time.process_time(), time.perf_counter()

    def score() -> tuple[Built, CaseResult]:
        inputs = way.inputs(view)
        if "masks" in way.truth:
            inputs = replace(inputs, instances=view.inputs.instances, instance_boxes=view.inputs.instance_boxes)
        stages = (way.stages or embedded_stages)(inputs, searched)
        if "shape" in way.truth:  # the true shapes are not among those searched
            everything = embedded_stages(inputs, library)
            stages = replace(stages, pose=everything.pose, layout=everything.layout, refinement=everything.refinement)
        known = library if "shape" in way.truth else searched
        stages = substitute(stages, view, way.truth, known)
        made = build_scene(inputs, known, stages=stages, progress=Progress(token=progress.token))
        spent, waited = time.process_time() - begun, time.perf_counter() - wall
        before = scene_scores(view, made.observed, library)
        scores = scene_scores(view, made.scene, library, physics=physics)
        failure = "" if made.scene.objects else "no object came out"
        return made, CaseResult(case.name, scores, spent, waited, failure, before)

    result, failure = attempt_one(case.name, score)
    if result is not None:
        return result
    spent, waited = time.process_time() - begun, time.perf_counter() - wall
    return None, CaseResult(case.name, SceneScores.failure(len(view.indices)), spent, waited, failure)
