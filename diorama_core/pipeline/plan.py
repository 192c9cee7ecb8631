"""The one order of the pipeline, as data: what each step takes, and what it gives.

A full build, a build after a correction, reconstructing one object, outlining and the benchmarks all evaluate this
plan, each restricted to the artefacts it wants. An artefact that the caller gives is not computed.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from diorama_core.architecture.before_walls import drawn_before_walls
from diorama_core.architecture.mounting import snap_mounted_objects
from diorama_core.architecture.walls.passages import without_openings
from diorama_core.artefacts import Inputs
from diorama_core.errors import UnavailableError
from diorama_core.perception.graph.apply import with_graph
from diorama_core.perception.metrology.within_walls import measured_within_walls
from diorama_core.pipeline.findings import finding
from diorama_core.pipeline.network_inputs import with_network_inputs
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import ProposalStages, Stages
from diorama_core.progress import Progress
from diorama_core.retrieval.seen_kinds import with_seen_kinds
from diorama_core.retrieval.word_senses import with_word_senses

log = logging.getLogger(__name__)

Artefacts = Mapping[str, Any]
"""Artefacts by the names that `PLAN` uses."""


@dataclass(frozen=True)
class StageStep:
    """A method of one stage; its result is cached, and None where the optional stage is absent or not needed."""

    name: str
    """Field of `Stages`, name in progress reports and stem of the cached file."""
    method: str
    takes: tuple[str, ...]
    gives: str
    share: float
    """Of the time that a build takes, roughly."""
    needed: Callable[[Inputs], bool] = lambda given: True
    """Whether it runs for what the user gave."""
    dispensable: bool = False
    """Whether the others go on without its result when it is not available."""

    def evaluate(self, stages: Stages | ProposalStages, known: Artefacts, runner: Runner, progress: Progress) -> Any:
        """The stage's result for the artefacts that are known."""
        stage = getattr(stages, self.name)
        if stage is None or not self.needed(known["given"]):
            return None
        artefacts = tuple(known[name] for name in self.takes)
        try:
            return runner.run(self.name, stage, getattr(stage, self.method), artefacts, progress)
        except UnavailableError as error:
            if not self.dispensable:
                raise
            runner.lost.append(f"{self.name}: left out ({error})")
            log.warning("%s", runner.lost[-1])
            return None


@dataclass(frozen=True)
class Derivation:
    """A pure function between stages, too cheap to be cached."""

    function: Callable[..., Any]
    takes: tuple[str, ...]
    gives: str
    share: float = 0.0

    def evaluate(self, stages: Stages | ProposalStages, known: Artefacts, runner: Runner, progress: Progress) -> Any:
        """The function's value for the artefacts that are known."""
        return self.function(*(known[name] for name in self.takes))


def lacks_boxes(given: Inputs) -> bool:
    """Whether the user gave neither boxes nor masks."""
    return not given.boxes and given.instances is None


def lacks_depth(given: Inputs) -> bool:
    """Whether the user measured no depth."""
    return given.depth_m is None


PLAN: tuple[StageStep | Derivation, ...] = (
    Derivation(lambda given: given.photo, ("given",), "photo"),
    Derivation(lambda given: given.intrinsics, ("given",), "given_intrinsics"),
    StageStep("recognition", "recognise", ("photo",), "words", 0.01, lacks_boxes, dispensable=True),
    Derivation(lambda words: words or (), ("words",), "phrases"),
    StageStep("detection", "detect", ("photo", "phrases"), "detected_boxes", 0.02, lacks_boxes),
    StageStep("depth_prediction", "predict", ("photo", "given_intrinsics"), "predicted_depth", 0.02, lacks_depth),
    Derivation(with_network_inputs, ("given", "detected_boxes", "predicted_depth"), "inputs"),
    StageStep("camera", "estimate", ("inputs",), "camera", 0.05),
    # Outlines do not depend on the camera: correcting its field of view must not look for them again.
    Derivation(lambda inputs: inputs.of_any_camera, ("inputs",), "camera_free_inputs"),
    StageStep("objects", "segment", ("camera_free_inputs",), "outlined_objects", 0.15),
    StageStep("naming", "name", ("photo", "outlined_objects"), "seen_kinds", 0.01, dispensable=True),
    Derivation(with_seen_kinds, ("outlined_objects", "seen_kinds"), "seen_objects"),
    Derivation(with_word_senses, ("seen_objects", "camera"), "objects"),
    StageStep("geometry", "measure", ("inputs", "camera", "objects"), "measured_geometry", 0.13),
    StageStep("graph", "relate", ("inputs", "objects", "measured_geometry"), "graph", 0.02),
    Derivation(with_graph, ("measured_geometry", "graph"), "supported_geometry"),
    StageStep("architecture", "reconstruct", ("inputs", "objects", "supported_geometry"), "architecture", 0.1),
    Derivation(measured_within_walls, ("supported_geometry", "architecture", "objects", "inputs"), "placed_geometry"),
    Derivation(with_graph, ("placed_geometry", "graph"), "housed_geometry"),
    Derivation(drawn_before_walls, ("housed_geometry", "architecture"), "standing_geometry"),
    Derivation(snap_mounted_objects, ("standing_geometry", "architecture"), "mounted_geometry"),
    Derivation(without_openings, ("objects", "mounted_geometry", "architecture"), "furniture"),
    Derivation(lambda furniture: furniture[0], ("furniture",), "furniture_objects"),
    Derivation(lambda furniture: furniture[1], ("furniture",), "geometry"),
    StageStep("depth", "depth", ("inputs", "furniture_objects", "geometry", "architecture"), "depth", 0.05),
    StageStep("retrieval", "retrieve", ("inputs", "furniture_objects", "geometry"), "shapes", 0.1),
    StageStep("pose", "pose", ("inputs", "furniture_objects", "geometry", "depth", "shapes"), "posed", 0.2),
)


def evaluate(
    stages: Stages | ProposalStages,
    given: Artefacts,
    wanted: Iterable[str],
    runner: Runner,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """The wanted artefacts, everything given, and what had to be computed between them.

    Args:
        stages: implementations; `ProposalStages` are enough for `detected_boxes`.
        given: artefacts that are known already; at least `given`, what the user gave.
        wanted: names of artefacts.
        runner: caches stages' results and records what they took.
        progress: reports and cancellation.

    Raises:
        Cancelled: on request; finished stages stay in the cache.
        DioramaError: with the reason, when a stage cannot do its work.
        KeyError: an artefact is wanted that no step gives.
    """
    progress = progress or Progress()
    steps = _steps_for(set(wanted), given)
    whole = sum(step.share for step in steps) or 1.0
    known, done = dict(given), 0.0
    for step in steps:
        part = progress.part(done / whole, (done + step.share) / whole)
        known[step.gives] = step.evaluate(stages, known, runner, part)
        part.found(finding(step.gives, known[step.gives]))
        done += step.share
    return known


def _steps_for(wanted: set[str], given: Artefacts) -> list[StageStep | Derivation]:
    """The steps that lead to the wanted artefacts, in the plan's order."""
    missing = wanted - given.keys()
    steps: list[StageStep | Derivation] = []
    for step in reversed(PLAN):
        if step.gives in missing:
            missing = (missing - {step.gives}) | (set(step.takes) - given.keys())
            steps.append(step)
    if missing:
        raise KeyError(f"no step gives {', '.join(sorted(missing))}")
    return steps[::-1]
