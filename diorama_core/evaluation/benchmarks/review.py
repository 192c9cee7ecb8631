"""What answers are worth: scenes of annotated photos and rendered rooms, reviewed by somebody who knows the truth.

The same scenes are reviewed in the order of the review, the most doubtful thing first, and at random; and how sure a
build is of its decisions is compared with how often they are right.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol, runtime_checkable

import numpy as np

from diorama_core.errors import EditRefused
from diorama_core.evaluation.adapters.photo_annotations import AnnotatedObject
from diorama_core.evaluation.benchmarks.photo_build import PhotoTask, read_annotated_inputs
from diorama_core.evaluation.metrics.annotated import carrier_of, front_error_of
from diorama_core.evaluation.reports.tables import Column, Row, Table
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.pipeline.run import build_scene
from diorama_core.progress import SILENT, Progress
from diorama_core.review.answers import apply_answer
from diorama_core.review.questions import TURNS, YES, Question, Subject, questions
from diorama_core.scene.types import PlaneRole, Scene

COUNTS = (0, 1, 3, 5, 10)
"""Answers after which scenes are compared with the truth."""
RIGHT_DEG = 45.0
RIGHT_IN_ALL = "Objects right in kind, front and supporter"
BINS = (0.0, 0.5, 0.7, 0.85, 0.95, 1.0)
"""Edges of the probabilities that are told apart."""
ROUNDS = 5
"""How often questions are asked at random."""

Order = Callable[[Sequence[Question]], Question]


@runtime_checkable
class KnownScene(Protocol):
    """A built scene of which somebody knows the truth."""

    @property
    def scene(self) -> Scene:
        """As it was built."""

    @property
    def library(self) -> ShapeLibrary:
        """Where its shapes come from."""

    def knows(self, object_id: str) -> bool:
        """Whether the truth of an object is known."""

    def answer(self, scene: Scene, question: Question) -> str | None:
        """What somebody who knows the truth answers; None where the truth does not say."""

    def score(self, scene: Scene) -> tuple[float, int]:
        """How many objects of a reviewed scene are right, of how many."""


@dataclass(frozen=True)
class ReviewBench:
    """Results of all scenes."""

    scenes: tuple[Reviewed, ...]

    def tables(self) -> tuple[Table, ...]:
        """What answers are worth, and how sure builds are."""
        return answers_table(self.scenes), calibration_table(self.scenes)

    def to_json(self) -> dict[str, object]:
        """The tables."""
        return {"bench": "review", "photos": len(self.scenes), "tables": [t.to_json() for t in self.tables()]}


@dataclass(frozen=True)
class Reviewed:
    """A built scene and what is true of it."""

    scene: Scene
    truth: Mapping[str, AnnotatedObject]
    """By object what was annotated."""
    index_of: Mapping[str, int]
    """Places of the objects in the annotation, which supporters are named by."""
    library: ShapeLibrary

    def knows(self, object_id: str) -> bool:
        """Whether an object was annotated."""
        return object_id in self.truth

    def score(self, scene: Scene) -> tuple[float, int]:
        """How many objects are right in everything annotated, of all annotated ones."""
        right = [all(self.right(scene, name).values()) for name in self.truth if scene.has_object(name)]
        return float(sum(right)), len(self.truth)

    def right(self, scene: Scene, object_id: str) -> dict[Subject, bool]:
        """What is right of an object, of all that was annotated."""
        item, truth, answers = scene.object(object_id), self.truth[object_id], dict[Subject, bool]()
        shape = record_of(self.library, item.shape_id)
        if truth.nameable:
            answers["kind"] = shape.category == truth.kind
        error = front_error_of(truth, item, scene.camera, shape.symmetry)
        if error is not None:
            answers["front"] = error <= RIGHT_DEG
        if truth.on is not None:
            answers["supporter"] = carrier_of(scene, object_id, self.index_of) == truth.on
        return answers

    def answer(self, scene: Scene, question: Question) -> str | None:
        """What somebody who knows the truth answers; None where the annotation does not say."""
        truth = self.truth[question.object_id]
        if question.subject == "presence":
            return YES
        if question.subject == "kind":
            return truth.kind if truth.nameable else None
        if question.subject == "supporter":
            return self._supporter(scene, question)
        if question.subject == "scale":
            return None
        turned = ((t, apply_answer(scene, self.library, question.id, t)) for t in TURNS)
        return next((t for t, after in turned if self.right(after, question.object_id).get("front")), None)

    def _supporter(self, scene: Scene, question: Question) -> str | None:
        """The annotated supporter: of several walls the likeliest."""
        on = self.truth[question.object_id].on
        if isinstance(on, int):
            return next((name for name, index in self.index_of.items() if index == on and scene.has_object(name)), None)
        return None if on is None else likeliest_plane(scene, question, on)


def likeliest_plane(scene: Scene, question: Question, role: PlaneRole) -> str | None:
    """The plane of a role that a question names first; else any with that role."""
    planes = [p.id for p in scene.architecture.by_role(role)]
    return next((c.value for c in question.choices if c.value in planes), next(iter(planes), None))


def build(task: PhotoTask, library: ShapeLibrary, progress: Progress = SILENT) -> Reviewed:
    """The scene of an annotated photo, with the truth of its objects.

    Raises:
        DioramaError: the photo cannot be built.
        Cancelled: on request.
    """
    case = read_annotated_inputs(task)
    scene = build_scene(case.inputs, library, cache=task.cache, progress=progress).scene
    known = {o.id: o.mask_id - 1 for o in scene.objects if o.mask_id is not None}
    return Reviewed(scene, {name: case.annotation.objects[k] for name, k in known.items()}, known, library)


def run(tasks: Sequence[PhotoTask], library: ShapeLibrary, progress: Progress = SILENT) -> ReviewBench:
    """Build and review annotated photos.

    Raises:
        DioramaError: a photo cannot be built.
        Cancelled: on request.
    """
    scenes = []
    for k, task in enumerate(tasks):
        scenes.append(build(task, library, progress.part(k / len(tasks), (k + 1) / len(tasks))))
    return ReviewBench(tuple(scenes))


def answers_table(scenes: Sequence[KnownScene], what: str = RIGHT_IN_ALL) -> Table:
    """What answers are worth in each order, and what is counted."""
    rng = np.random.default_rng(0)
    orders: dict[str, tuple[int, Order]] = {
        "the review": (1, lambda asked: asked[0]),
        "most doubtful first": (1, lambda asked: min(asked, key=lambda q: (q.choices[0].probability, q.id))),
        "at random": (ROUNDS, lambda asked: asked[int(rng.integers(len(asked)))]),
    }
    rows = []
    for name, (rounds, order) in orders.items():
        counted = np.array([shares_right(s, order) for _ in range(rounds) for s in scenes])
        rows.append(Row(name, tuple((counted[..., 0].sum(axis=0) / counted[..., 1].sum(axis=0)).tolist())))
    columns = tuple(Column(f"{count} answers", ".3f", "↑") for count in COUNTS)
    return Table(what, columns, tuple(rows))


def shares_right(reviewed: KnownScene, order: Order) -> list[tuple[float, int]]:
    """Objects that are right, and all that should be, after each of `COUNTS` answers."""
    scene, done, over = reviewed.scene, 0, set[str]()
    shares = []
    for count in COUNTS:
        while done < count and (
            asked := [q for q in questions(scene) if q.id not in over and reviewed.knows(q.object_id)]
        ):
            question = order(asked)
            over.add(question.id)
            value = reviewed.answer(scene, question)
            if value is not None:
                scene, done = _apply_answer(scene, question, value, reviewed.library), done + 1
        shares.append(reviewed.score(scene))
    return shares


def _apply_answer(scene: Scene, question: Question, value: str, library: ShapeLibrary) -> Scene:
    try:
        return apply_answer(scene, library, question.id, value)
    except EditRefused:  # the library has no such kind
        return scene


def calibration_table(scenes: Sequence[Reviewed]) -> Table:
    """How often decisions are right, by how sure the build was; fronts and supporters of what is of the right kind."""
    pairs: dict[Subject, list[tuple[float, bool]]] = {"kind": [], "front": [], "supporter": []}
    for reviewed in scenes:
        for name in reviewed.truth:
            belief = reviewed.scene.object(name).belief
            if belief is None:
                continue
            first_choices = {"kind": belief.kinds[:1], "supporter": belief.supporters[:1]}
            sure = {subject: of_one[0][1] for subject, of_one in first_choices.items() if of_one}
            sure |= {"front": belief.fronts[0]} if belief.fronts else {}
            answers = reviewed.right(reviewed.scene, name)
            for subject, right in answers.items():
                if subject in sure and (subject == "kind" or answers.get("kind", True)):
                    pairs[subject].append((sure[subject], right))
    rows = []
    for subject, sure_and_right in pairs.items():
        for low, high in pairwise(BINS):
            within = np.array([pair for pair in sure_and_right if low < pair[0] <= high], dtype=float)
            if len(within):
                said_share, right_share = within.mean(axis=0).tolist()
                rows.append(Row(f"{subject}, {low:.2f} to {high:.2f}", (len(within), said_share, right_share)))
    columns = (Column("decisions", "d"), Column("said", ".2f"), Column("right", ".2f"))
    return Table("How sure a build is, and how often it is right", columns, tuple(rows))
