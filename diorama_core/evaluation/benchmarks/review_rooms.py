"""What answers are worth for rendered rooms, whose truth tells places and sizes too: the review of photos alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from diorama_core.artefacts import Inputs
from diorama_core.errors import EditRefused
from diorama_core.evaluation.benchmarks.cases import Case, LeftOut, attempt, recipe
from diorama_core.evaluation.benchmarks.review import RIGHT_DEG, answers_table, likeliest_plane
from diorama_core.evaluation.benchmarks.system import without_names
from diorama_core.evaluation.benchmarks.views import photograph
from diorama_core.evaluation.metrics.pose import object_alignment, rotation_angle, symmetry_turns
from diorama_core.evaluation.metrics.scene import Matched, align_to_truth
from diorama_core.evaluation.reports.tables import Table
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.pipeline.run import build_scene
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.progress import SILENT, Progress
from diorama_core.review.answers import apply_answer
from diorama_core.review.questions import TURNS, YES, Question
from diorama_core.scene.types import Scene, SceneObject
from diorama_core.synthesis.artefacts import photo_only
from diorama_core.synthesis.splits import split_library
from diorama_core.synthesis.truth import TruthView

PHOTOS = 3
"""Pictures of a room, of which the first with enough objects is built."""
OWN_ACC = "Own Acc: objects within 20 cm, 20 degrees and 20 % of their truth"


@dataclass(frozen=True)
class RoomReview:
    """Rendered rooms, reviewed."""

    named: bool
    rooms: tuple[KnownRoom, ...]
    left_out: tuple[LeftOut, ...] = ()

    def tables(self) -> tuple[Table, ...]:
        """What answers are worth."""
        table = answers_table(self.rooms, OWN_ACC)
        boxes = "boxes with their words" if self.named else "boxes without words"
        return (replace(table, note=f"{len(self.rooms)} rooms, of each one photo and its {boxes}."),)

    def to_json(self) -> dict[str, object]:
        """The table."""
        return {"bench": "review", "rooms": len(self.rooms), "tables": [t.to_json() for t in self.tables()]}


@dataclass(frozen=True)
class KnownRoom:
    """A scene built from a rendered photo, and the room that the photo shows."""

    scene: Scene
    view: TruthView
    truth: Mapping[str, SceneObject]
    """By object of the scene what it is in truth."""
    library: ShapeLibrary
    """Searched by the build."""
    all_shapes: ShapeLibrary
    """Knows the true shapes too."""

    def knows(self, object_id: str) -> bool:
        """Whether an object is one of the room's."""
        return object_id in self.truth

    def score(self, scene: Scene) -> tuple[float, int]:
        """How many of the objects that the photo shows are where, as large and turned as in the room."""
        alignment = object_alignment(*Matched.of(self.view, scene).poses(self.all_shapes))
        return alignment.acc * alignment.count, alignment.count

    def answer(self, scene: Scene, question: Question) -> str | None:
        """What somebody who knows the room answers; None where no choice is right."""
        true = self.truth[question.object_id]
        if question.subject == "presence":
            return YES
        if question.subject == "kind":
            return record_of(self.all_shapes, true.shape_id).category
        if question.subject == "scale":
            return str(float(true.size_m[2]))
        return self._supporter(scene, question) if question.subject == "supporter" else self._turn(scene, question)

    def _turn(self, scene: Scene, question: Question) -> str | None:
        true, off = self.truth[question.object_id], {}
        turns = symmetry_turns(self.all_shapes.shape(true.shape_id).symmetry)
        for turn in TURNS:
            try:
                after = apply_answer(scene, self.library, question.id, turn)
            except EditRefused:
                continue
            R = align_to_truth(after, self.view).object(question.object_id).pose.R_world_object
            off[turn] = float(rotation_angle(true.pose.R_world_object @ turns, R).min())
        best = min(off, key=lambda turn: off[turn])
        return best if off[best] <= np.deg2rad(RIGHT_DEG) else None

    def _supporter(self, scene: Scene, question: Question) -> str | None:
        """The true supporter: of several walls the likeliest."""
        edge = self.view.scene.support_of(self.truth[question.object_id].id)
        if edge is None:
            return None
        if not self.view.scene.has_plane(edge.parent):
            return next((name for name, item in self.truth.items() if item.id == edge.parent), None)
        return likeliest_plane(scene, question, self.view.scene.plane(edge.parent).role)


def run(
    library: ShapeLibrary, scenes: int = 12, seed: int = 0, progress: Progress = SILENT, *, named: bool = True
) -> RoomReview:
    """Build one photo of every room, and review what comes of it.

    Args:
        library: rooms are furnished from its test shapes; the others are searched.
        scenes: how many rooms.
        seed: of the series of rooms.
        progress: reports, and cancels between builds.
        named: whether boxes are given with their words.

    Raises:
        Cancelled: on request.
    """
    tested, searched = split_library(library, "test"), split_library(library, "train", "validation")
    cases, left_out = recipe(scenes, 1, seed), list[LeftOut]()

    def view_of(case: Case) -> TruthView:
        progress.report(cases.index(case) / len(cases), f"reviewing {case.name}")
        return photograph(case, tested, PHOTOS)[0].truth

    rooms = []
    for _, view in attempt(cases, view_of, left_out):
        given: Inputs = photo_only(view) if named else without_names(view)
        scene = build_scene(given, searched, stages=embedded_stages(given, searched)).scene
        truth = {item.id: view.scene.object(name) for name, item in Matched.of(view, scene).counterparts.items()}
        rooms.append(KnownRoom(scene, view, truth, searched, library))
    progress.report(1.0, "done")
    return RoomReview(named, tuple(rooms), tuple(left_out))
