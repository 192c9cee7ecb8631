"""How often the support graph names what holds an object up, on rendered rooms whose supports are known: from geometry,
and by a language model where one is named.

A language model is asked the two questions that a photo is worth (paper, section 3.1), and what they take is measured.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from diorama_core.artefacts import (
    CameraEstimate,
    CameraHypothesis,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    Photo,
)
from diorama_core.evaluation.benchmarks.cases import LeftOut, make_views, recipe
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import Column, Row, Table, paper_rows
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.language.client import LmmSettings
from diorama_core.perception.language.stages import LanguageGraph, LanguageRecognition
from diorama_core.perception.masks import EmbeddedMasks
from diorama_core.perception.measured import MeasuredGeometry
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.progress import SILENT, Progress
from diorama_core.provenance import CameraSource
from diorama_core.scene.types import Scene, Support
from diorama_core.synthesis import TruthView


@dataclass(frozen=True)
class RelationCount:
    """Supporters that were named rightly, of those that could be."""

    right: int = 0
    total: int = 0
    mistakes: tuple[tuple[str, str, str], ...] = ()
    """(child's category, true supporter, named supporter)."""

    def __add__(self, other: RelationCount) -> RelationCount:
        return RelationCount(self.right + other.right, self.total + other.total, self.mistakes + other.mistakes)

    @property
    def accuracy(self) -> float:
        """Share of correct relations; 1 where there are none."""
        return self.right / self.total if self.total else 1.0


def _judge(supports: tuple[Support, ...], names: dict[str, str], truth: Scene) -> RelationCount:
    """Edges beside the truth's, whose objects `names` has by their ids in the photo.

    Only objects whose true supporter is itself visible, or a part of the room, count.
    """
    roles: dict[str, str] = {p.id: p.role for p in truth.architecture.planes}
    visible = set(names.values())
    right, total, mistakes = 0, 0, []
    for edge in supports:
        true_edge = truth.support_of(names[edge.child])
        if true_edge is None:
            continue
        wanted = roles.get(true_edge.parent, true_edge.parent)
        if wanted not in visible and wanted not in ("floor", "wall", "ceiling"):
            continue
        named = names.get(edge.parent, edge.parent)
        total += 1
        right += named == wanted
        if named != wanted:
            kind = truth.object(names[edge.child]).category
            mistakes.append((kind, wanted.rsplit("_", 1)[0], named.rsplit("_", 1)[0]))
    return RelationCount(right, total, tuple(mistakes))


Reader = Callable[[Inputs, tuple[DetectedObject, ...], ObjectGeometry], tuple[Support, ...]]
"""Tells the supports of what was found in a picture."""


def relations_of(view: TruthView, *, with_depth: bool, reader: Reader | None = None) -> RelationCount:
    """The supports of one picture, from masks and classes with depth or without, by geometry unless a reader is given;
    the camera's orientation is known.
    """
    inputs = view.inputs if with_depth else replace(view.inputs, depth_m=None)
    camera = view.camera
    reading = CameraHypothesis(camera.intrinsics, camera.T_world_camera[:3, :3], 1.0)
    height = float(camera.position[2]) if with_depth else None
    estimate = CameraEstimate((reading,), 1.0, CameraSource.exact(), height)
    quiet = Progress()
    objects = EmbeddedMasks().segment(inputs, quiet)
    stage = MeasuredGeometry() if with_depth else SingleViewMetrology()
    geometry = stage.measure(inputs, estimate, objects, quiet)
    supports = geometry.supports if reader is None else reader(inputs, objects, geometry)
    by_mask = {o.mask_id: o.id for o in view.scene.objects if o.mask_id is not None}
    return _judge(supports, {o.id: by_mask[o.mask_id] for o in objects}, view.scene)


WITH_DEPTH, PHOTO_ALONE = "masks and depth", "masks and the photo alone"
BY_MODEL = "a language model, masks and depth"
WHAT_IS_THERE, WHAT_HOLDS_WHAT = "what is in the photo", "what holds up what"
MISTAKES_SHOWN = 5


@dataclass(frozen=True)
class AskedSupport:
    """One question about one picture, however many calls it took."""

    question: str
    calls: int
    tokens: int
    """Read and written."""
    seconds: float
    """By the clock: waiting for a network."""
    cost: float | None
    """In units of the user's prices; None without prices."""
    unusable: int
    """Calls whose reply could not be used."""


@dataclass(frozen=True)
class RelationsBench:
    """What was counted over some rooms."""

    seed: int
    rooms: int
    counts: tuple[tuple[str, RelationCount], ...]
    model: str = ""
    """The language model that was asked; empty where none was."""
    asked: tuple[AskedSupport, ...] = ()

    def tables(self) -> tuple[Table, ...]:
        """One row per kind of input; what the questions took, where a language model was asked."""
        columns = (Column("accuracy", ".3f", "↑"), Column("objects", "d"), Column("usual mistakes"))
        rows = tuple(Row(name, (c.accuracy, c.total, _mistakes(c))) for name, c in self.counts)
        note = (
            f"{self.rooms} rooms from seed {self.seed}; orientation of the camera and masks given. Objects count whose "
            "true supporter is a part of the room or is itself in the picture. The publication reports about 0.62 with "
            "GPT-4o and its own poses, on another dataset."
        )
        accuracy = Table("Support graph", columns, rows, note)
        return (accuracy, costs_table(self.model, self.asked)) if self.asked else (accuracy,)

    def to_json(self) -> dict[str, object]:
        """Plain values."""
        return {"seed": self.seed, "rooms": self.rooms, "tables": [t.to_json() for t in self.tables()]}


def _meter(settings: LmmSettings, asked: list[AskedSupport]) -> Reader:
    """Asks a language model for the supports, and notes what that took."""

    def supports(inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry) -> tuple[Support, ...]:
        began = time.perf_counter()
        graph = LanguageGraph(settings).relate(inputs, objects, geometry, Progress())
        if (use := graph.source.asked) is not None:
            took = time.perf_counter() - began
            unusable = use.calls - use.replies
            asked.append(AskedSupport(WHAT_HOLDS_WHAT, use.calls, use.tokens, took, use.cost, unusable))
        return graph.supports

    return supports


def run(
    library: ShapeLibrary,
    scenes: int = 18,
    seed: int = 0,
    progress: Progress = SILENT,
    language_model: LmmSettings | None = None,
) -> RelationsBench:
    """Judge the graph of every room's first picture, with depth and without.

    Args:
        library: furnishes the rooms.
        scenes: rooms.
        seed: of the rooms.
        progress: reports and cancellation.
        language_model: is asked about every picture, too; cached replies do not count.

    Raises:
        UnavailableError: when the language model is asked wrongly (key, model), or never answers usably.
    """
    counts = {WITH_DEPTH: RelationCount(), PHOTO_ALONE: RelationCount()}
    settings = None if language_model is None else replace(language_model, cache=None)
    asked: list[AskedSupport] = []
    cases = recipe(scenes, 1, seed)
    left_out: list[LeftOut] = []
    for k, (case, view) in enumerate(make_views(cases, library, left_out)):
        progress.report(k / len(cases), case.name)
        counts[WITH_DEPTH] += relations_of(view, with_depth=True)
        counts[PHOTO_ALONE] += relations_of(view, with_depth=False)
        if settings is not None:
            asked.append(_recognise(view.inputs.photo, settings))
            result = relations_of(view, with_depth=True, reader=_meter(settings, asked))
            counts[BY_MODEL] = counts.get(BY_MODEL, RelationCount()) + result
    model = "" if settings is None else settings.model
    return RelationsBench(seed, scenes - len(left_out), tuple(counts.items()), model, tuple(asked))


def costs_table(model: str, asked: Sequence[AskedSupport]) -> Table:
    """Means over pictures of what the questions took, beside the paper's."""
    columns = (
        Column("calls", ".1f", "↓"),
        Column("tokens", ".0f", "↓"),
        Column("seconds", ".1f", "↓"),
        Column("cost", ".4f", "↓"),
        Column("unusable replies", ".2f", "↓"),
    )
    by_question = {q: [a for a in asked if a.question == q] for q in (WHAT_IS_THERE, WHAT_HOLDS_WHAT)}
    means = {q: _means(of_one) for q, of_one in by_question.items() if of_one}
    whole = tuple(None if None in column else float(sum(column)) for column in zip(*means.values(), strict=True))
    note = (
        f"{model}; a picture, {len(by_question[WHAT_HOLDS_WHAT])} pictures. Seconds by the clock, with pauses after "
        "refusals; tokens as the endpoint counts them. Cost in units of the prices that DIORAMA_LMM_PRICE states; in "
        "the paper's row US dollars."
    )
    rows = (*(Row(q, values) for q, values in means.items()), Row("both", whole), *paper_rows(paper.LANGUAGE_MODEL))
    return Table("Language model: times and costs", columns, rows, note)


def _recognise(photo: Photo, settings: LmmSettings) -> AskedSupport:
    began = time.perf_counter()
    usage = LanguageRecognition(settings).ask(photo, Progress()).usage
    seconds = time.perf_counter() - began
    return AskedSupport(WHAT_IS_THERE, usage.calls, usage.tokens, seconds, usage.cost(settings), usage.calls - 1)


def _means(asked: Sequence[AskedSupport]) -> tuple[float | None, ...]:
    """Calls, tokens, seconds, cost and unusable replies."""
    columns = zip(*((a.calls, a.tokens, a.seconds, a.cost, a.unusable) for a in asked), strict=True)
    return tuple(None if None in column else float(np.mean(column)) for column in columns)


def _mistakes(count: RelationCount) -> str:
    kinds = Counter(f"{child} on {wanted}, not {named}" for child, wanted, named in count.mistakes)
    return "; ".join(kind for kind, _ in kinds.most_common(MISTAKES_SHOWN)) or "none"
