"""Pose solvers side by side: the same pictures, masks, depth and shapes for every one of them.

Perception runs once for each picture and kind of depth; retrieval once for each picture. What differs between the rows
of a table is the solver alone.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from diorama_core.artefacts import (
    DepthMap,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    PosedCandidates,
    RankedShapes,
)
from diorama_core.evaluation.metrics.pose import Alignment, nothing_right, object_alignment, scene_alignment
from diorama_core.evaluation.metrics.scene import Matched, relation_accuracy, structure_of
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.pipeline.steps import Artefacts
from diorama_core.pose import RenderAndCompare
from diorama_core.pose.correspondence.solvers import HALF_GRID, CorrespondencePose, Kind
from diorama_core.progress import Progress
from diorama_core.protocols import PoseStage
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.scene.types import Scene
from diorama_core.synthesis.artefacts import TrueShapes
from diorama_core.synthesis.truth import TruthView

OURS = "render and compare"
BASELINES: dict[str, Kind] = {
    "correspondence": "correspondence",
    "GigaPose-like": "gigapose-like",
    "ZSP": "zsp",
    "best match": "best-match",
}
"""Names in the tables."""
TRUE_DEPTH, ESTIMATED_DEPTH, NOISY_DEPTH = "true depth", "estimated depth", "depth with 5 % noise"
GIVEN, IN_LIBRARY, REMOVED = "true shape given", "true shape in the library", "true shape removed"
CONDITIONS = (
    (TRUE_DEPTH, GIVEN),
    (ESTIMATED_DEPTH, GIVEN),
    (NOISY_DEPTH, GIVEN),
    (TRUE_DEPTH, IN_LIBRARY),
    (TRUE_DEPTH, REMOVED),
    (NOISY_DEPTH, IN_LIBRARY),
)
"""(depth, shapes) of every comparison."""
COMPARED_SHAPES = 4
"""Retrieved shapes that every solver chooses from."""
NOISE = 0.05


@dataclass(frozen=True)
class PoseScores:
    """One picture's poses against the truth, before any layout; figures as in `scene_metrics.SceneScores`."""

    asked: int
    pairs: Alignment
    every: Alignment
    own: Alignment
    relation: float
    orientation: float
    placement: float
    structure: float
    box_overlap_cm: float | None
    """None where nothing came out: what is not there does not collide, and is not free of collisions either."""

    @classmethod
    def failure(cls, asked: int) -> PoseScores:
        """The prediction failed."""
        return cls(asked, *nothing_right(asked), 0.0, 0.0, 0.0, 0.0, None)


def pose_scores(view: TruthView, scene: Scene | None, library: ShapeLibrary) -> PoseScores:
    """Alignment, relations and overlap of a predicted scene; everything wrong where there is none."""
    if scene is None:
        return PoseScores.failure(len(view.indices))
    matched = Matched.of(view, scene)
    true, placed = matched.poses(library)
    pairs, every = scene_alignment(true, placed)
    layout = structure_of(matched.scene, library)
    return PoseScores(
        asked=len(true),
        pairs=pairs,
        every=every,
        own=object_alignment(true, placed),
        relation=relation_accuracy(view, matched),
        orientation=layout["orientation"],
        placement=layout["placement"],
        structure=layout["structure"],
        box_overlap_cm=100 * layout["box_overlap_m"],
    )


@dataclass(frozen=True, eq=False)
class SeenInput:
    """What a pose stage is given of one picture, with the room that its poses are put into."""

    stages: Stages
    known: Artefacts
    """What was found so far, by the names of the pipeline's plan."""

    @property
    def inputs(self) -> Inputs:
        """What was given."""
        return cast(Inputs, self.known["inputs"])

    @property
    def objects(self) -> tuple[DetectedObject, ...]:
        """What was outlined."""
        return cast(tuple[DetectedObject, ...], self.known["furniture_objects"])

    @property
    def geometry(self) -> ObjectGeometry:
        """The objects' cuboids, and the camera."""
        return cast(ObjectGeometry, self.known["geometry"])

    @property
    def depth(self) -> DepthMap:
        """Depth of the photo."""
        return cast(DepthMap, self.known["depth"])

    def scene(self, posed: tuple[PosedCandidates, ...], library: ShapeLibrary) -> Scene:
        """The scene before any layout, without colours."""
        uncoloured = {"white_room": self.known["architecture"], "colours": {}}
        return cast(Scene, self.evaluate(("posed_scene",), posed=posed, library=library, **uncoloured)["posed_scene"])

    def evaluate(self, wanted: Iterable[str], **given: Any) -> Artefacts:
        """What follows from this and what is given besides, by the pipeline's plan."""
        return evaluate(self.stages, {**self.known, **given}, wanted, Runner(None))


def predict(inputs: Inputs, library: ShapeLibrary) -> SeenInput:
    """Run the embedded stages up to depth.

    Raises:
        DioramaError: with the reason, when a stage cannot do its work.
    """
    stages = embedded_stages(inputs, library)
    return SeenInput(stages, evaluate(stages, {"given": inputs}, ("depth",), Runner(None)))


def inputs_with(view: TruthView, depth: str) -> Inputs:
    """The picture with true masks, and with this kind of depth."""
    given = view.inputs
    if depth == ESTIMATED_DEPTH:
        return replace(given, depth_m=None)
    if depth == TRUE_DEPTH or given.depth_m is None:
        return given
    digest = hashlib.sha256(given.depth_m.tobytes()).digest()
    rng = np.random.default_rng(int.from_bytes(digest[:4], "little"))
    noisy = given.depth_m * (1 + NOISE * rng.standard_normal(given.depth_m.shape))
    return replace(given, depth_m=noisy.astype(np.float32))


def shapes_of(
    given: tuple[RankedShapes, ...], retrieved: tuple[RankedShapes, ...], shapes: str, keep: int
) -> tuple[RankedShapes, ...]:
    """The shapes to choose from: the true one alone, the best retrieved, or the best retrieved without the true one.

    Args:
        given: The true shape of every object.
        retrieved: Ranked shapes of every object, at least one more than are kept.
        shapes: `GIVEN`, `IN_LIBRARY` or `REMOVED`.
        keep: Most shapes of an object.
    """
    if shapes == GIVEN:
        return given
    gone = {r.object_id: r.ranked[0][0] for r in given} if shapes == REMOVED else {}
    return tuple(
        replace(r, ranked=tuple(s for s in r.ranked if s[0] != gone.get(r.object_id))[:keep]) for r in retrieved
    )


@dataclass(frozen=True)
class SideBySide:
    """Our solver and the baselines over one library; features of shapes are shared between them."""

    library: ShapeLibrary
    ours: PoseStage
    baselines: CorrespondencePose = field(repr=False)

    @classmethod
    def create_embedded(cls, library: ShapeLibrary) -> SideBySide:
        """Create the solvers that need no networks."""
        return cls(library, RenderAndCompare(library), CorrespondencePose(library, grid=HALF_GRID))

    def retrieve(self, seen: SeenInput, keep: int) -> tuple[RankedShapes, ...]:
        """Ranked shapes of every object."""
        stage = HierarchicalRetrieval(self.library, keep=keep)
        return stage.retrieve(seen.inputs, seen.objects, seen.geometry, Progress())

    def true_shapes(self, view: TruthView, seen: SeenInput) -> tuple[RankedShapes, ...]:
        """The true shape of every object."""
        return TrueShapes.of(view).retrieve(seen.inputs, seen.objects, seen.geometry, Progress())

    def our_scene(self, seen: SeenInput, shapes: tuple[RankedShapes, ...]) -> Scene:
        """Our solver's scene."""
        posed = self.ours.pose(seen.inputs, seen.objects, seen.geometry, seen.depth, shapes, Progress())
        return seen.scene(posed, self.library)

    def scenes(self, seen: SeenInput, shapes: tuple[RankedShapes, ...]) -> dict[str, Scene]:
        """The scene of every solver, by name."""
        given = (seen.inputs, seen.objects, seen.geometry, seen.depth, shapes, Progress())
        posed = {OURS: self.ours.pose(*given)}
        by_kind = self.baselines.pose_by(tuple(BASELINES.values()), *given)
        posed |= {name: by_kind[kind] for name, kind in BASELINES.items()}
        return {name: seen.scene(candidates, self.library) for name, candidates in posed.items()}
